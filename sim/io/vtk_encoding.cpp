#include "sim/io/vtk_encoding.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace scree {
namespace {

constexpr std::size_t kMostOfZlib = 1032;  // bytes from one (zlib, technical details)

[[noreturn]] void fail(const std::string& message) {
  throw std::runtime_error(message);
}

int value_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

// The bytes of an array, header first, however they are written.
class Bytes {
 public:
  Bytes(std::string_view text, bool base64) : text_(text), base64_(base64) {}

  /// The next bytes. What they are decoded from bounds what is allocated.
  std::string next(std::size_t count) {
    if (count > text_.size() - at_ + ready_.size()) fail("the data end before the array does");
    if (!base64_) {
      at_ += count;
      return std::string(text_.substr(at_ - count, count));
    }
    while (ready_.size() < count) decode_four();
    std::string bytes = std::move(ready_);
    ready_ = bytes.substr(count);
    bytes.resize(count);
    return bytes;
  }
  std::size_t left() const { return text_.size() - at_ + ready_.size(); }

 private:
  void decode_four() {
    std::uint32_t bits = 0;
    int letters = 0;
    for (int k = 0; k < 4; ++k) {
      while (at_ < text_.size() &&
             (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\r' || text_[at_] == '\t'))
        ++at_;
      if (at_ >= text_.size() || text_[at_] == '<') fail("the data end before the array does");
      const char c = text_[at_++];
      bits <<= 6;
      if (c == '=' && k >= 2) continue;
      if (value_of(c) < 0 || letters < k) fail("the data are no base64");
      bits |= static_cast<std::uint32_t>(value_of(c));
      ++letters;
    }
    for (int k = 0; k < letters - 1; ++k) ready_ += static_cast<char>(bits >> (16 - 8 * k) & 0xFF);
  }

  std::string_view text_;
  bool base64_;
  std::size_t at_ = 0;
  std::string ready_;  // decoded and not taken
};

std::uint64_t whole_number(std::string_view bytes, std::endian order) {
  std::uint64_t number = 0;
  for (std::size_t k = 0; k < bytes.size(); ++k)
    number =
        number << 8 | static_cast<unsigned char>(bytes[order == std::endian::big ? k : bytes.size() - 1 - k]);
  return number;
}

// Header: blocks, bytes of a block, bytes of a last shorter one or 0, then the bytes that each block takes.
std::string inflated(Bytes& bytes, const VtkEncoding& encoding, std::size_t size) {
  const auto number = [&] { return whole_number(bytes.next(encoding.header_size), encoding.order); };
  const std::uint64_t blocks = number(), block = number(), last = number();
  if (blocks == 0 || block == 0 || last > block || blocks > bytes.left() / encoding.header_size ||
      (blocks - (last > 0)) > size / block || (blocks - (last > 0)) * block + last != size)
    fail(fmt::format("{} blocks of {} bytes and a last of {} are no array of {} bytes", blocks, block, last,
                     size));
  if (size / kMostOfZlib > bytes.left()) fail("the data end before the array does");
  std::vector<std::uint64_t> taken(blocks);
  for (std::uint64_t& each : taken) each = number();
  std::string out(size, '\0');
  std::size_t at = 0;
  for (std::size_t k = 0; k < blocks; ++k) {
    const std::size_t wanted = k + 1 == blocks && last > 0 ? last : block;
    const std::string packed = bytes.next(taken[k]);
    uLongf given = wanted;
    if (uncompress(reinterpret_cast<Bytef*>(out.data() + at), &given,
                   reinterpret_cast<const Bytef*>(packed.data()), packed.size()) != Z_OK ||
        given != wanted)
      fail(fmt::format("block {} of {} is damaged", k + 1, blocks));
    at += wanted;
  }
  return out;
}

}  // namespace

std::string decoded_array(std::string_view text, bool base64, const VtkEncoding& encoding, std::size_t size) {
  Bytes bytes(text, base64);
  if (encoding.compressed) return inflated(bytes, encoding, size);
  const std::uint64_t said = whole_number(bytes.next(encoding.header_size), encoding.order);
  if (said != size) fail(fmt::format("{} bytes, an array of {} is needed", said, size));
  return bytes.next(size);
}

}  // namespace scree
