#pragma once
// The state of a run as bytes, written and read by the same lines of code: a class that has state gives it to
// either stream with `stream(a, b, c)`, so that nothing can be written that is not read.
//
// Numbers go as they lie in memory (the file says in which byte order), so what is read has the same bits.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "sim/material/vector.h"

namespace scree {

/// A state that cannot be read: of another layout, or of another scene.
struct StateError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Types whose bytes are their value: without pointers and without padding, which has no value of its own.
template <class T>
inline constexpr bool kPlainState = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <>
inline constexpr bool kPlainState<Vec3> = true;
static_assert(sizeof(Vec3) == 3 * sizeof(double));

/// What both streams do with types that are made of others. A type of its own has a member
/// `template <class Stream> void state(Stream&)`, or a function state(Stream&, T&) beside it.
template <class Self>
class StateStream {
 public:
  template <class... T>
  void operator()(T&... values) {
    (one(values), ...);
  }

 private:
  Self& self() { return static_cast<Self&>(*this); }

  template <class T>
  void one(T& value) {
    if constexpr (kPlainState<std::remove_const_t<T>>)
      self().bytes(&value, sizeof(T));
    else if constexpr (requires { value.state(self()); })
      value.state(self());
    else
      state(self(), value);
  }
  void one(Quaternion& q) { self().bytes(q.coeffs().data(), 4 * sizeof(double)); }
  void one(Pose& pose) { (*this)(pose.position, pose.rotation); }
  void one(std::string& text) {
    self().resize(text, 1);
    self().bytes(text.data(), text.size());
  }
  template <class T>
  void one(std::vector<T>& values) {
    self().resize(values, kPlainState<T> ? sizeof(T) : 1);
    if constexpr (kPlainState<T>)
      self().bytes(values.data(), values.size() * sizeof(T));
    else
      for (T& value : values) one(value);
  }
  template <class T, std::size_t N>
  void one(std::array<T, N>& values) {
    for (T& value : values) one(value);
  }
  template <class T>
  void one(std::optional<T>& value) {
    std::uint8_t known = value ? 1 : 0;
    one(known);
    if (Self::kReads && known != 0) value.emplace();
    if (Self::kReads && known == 0) value.reset();
    if (value) one(*value);
  }
};

class StateWriter : public StateStream<StateWriter> {
 public:
  static constexpr bool kReads = false;
  using Sink = std::function<void(const void* data, std::size_t size)>;
  explicit StateWriter(Sink sink) : sink_(std::move(sink)) {}

  /// What follows is `name`, laid out as `version` of it says.
  void section(const std::string& name, std::uint32_t version);
  void bytes(const void* data, std::size_t size) {
    if (size > 0) sink_(data, size);
  }
  template <class Container>
  void resize(Container& values, std::size_t) {
    const std::uint64_t count = values.size();
    bytes(&count, sizeof count);
  }

 private:
  Sink sink_;
};

class StateReader : public StateStream<StateReader> {
 public:
  static constexpr bool kReads = true;
  using Source = std::function<void(void* data, std::size_t size)>;
  /// `size`: bytes that the source has. It throws when it cannot give what is asked.
  StateReader(Source source, std::uint64_t size) : source_(std::move(source)), left_(size) {}

  /// Throws StateError if what follows is something else, or another version of it.
  void section(const std::string& name, std::uint32_t version);
  void bytes(void* data, std::size_t size) {
    take(size);
    if (size > 0) source_(data, size);
  }
  template <class Container>
  void resize(Container& values, std::size_t bytes_each) {
    std::uint64_t count = 0;
    bytes(&count, sizeof count);
    if (count > left_ / bytes_each) end_too_early();
    values.resize(static_cast<std::size_t>(count));
  }

 private:
  void take(std::uint64_t size) {
    if (size > left_) end_too_early();
    left_ -= size;
  }
  [[noreturn]] static void end_too_early();

  Source source_;
  std::uint64_t left_;
};

}  // namespace scree
