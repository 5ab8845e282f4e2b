#pragma once
// The one table of a scenario file's keys. Reading, checking, the JSON schema and the resolved YAML are all
// loops over it, so a key's name, unit, range and meaning are said once (in scenario_keys.cpp) and its
// default once (in the struct).
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sim/scene/scenario.h"

namespace scree {

/// Allowed values; an open end is not allowed itself.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;
  bool holds(double x) const { return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high); }
};

/// Allowed number of entries of a list.
struct Count {
  std::size_t least = 0, most = 1000;
};

struct Field;
using Fields = std::vector<Field>;

// What a key's value is and where it goes. The pointers point into one Scenario, whose table this is.

struct Number {
  double* value;
  std::string_view unit;
  Range range;
  double factor = 1;  ///< value in the struct = factor * value in the file
};
/// A number, or a word for none: `rock`, the rock's own value.
struct NumberOr {
  std::optional<double>* value;
  Range range;
  std::string_view word;
};
struct Integer {
  int* value;
  Range range;
};
struct Boolean {
  bool* value;
};
struct Text {
  std::string* value;
  Count length;
};
struct Choice {
  std::vector<std::string_view> names;
  std::function<int()> get;
  std::function<void(int)> set;
};
/// A mesh file: path relative to the scenario file or to the assets.
struct MeshFile {
  std::filesystem::path* value;
  std::string_view standard;  ///< asset taken when the key is left out; empty: the key is required
  const double* scale;        ///< metres per unit of the file
};
/// A grading: name in assets/gradings, or path of a CSV.
struct GradingFile {
  std::filesystem::path* value;
};
struct Vector {
  Vec3* value;
  std::string_view unit;
  Range range;
};
struct Numbers {
  std::vector<double>* value;
  std::string_view unit;
  Range range;
  Count count;
};
struct Integers {
  std::vector<int>* value;
  Range range;
  Count count;
};
/// Distinct integers from 0 to 2^63 - 1.
struct Seeds {
  std::vector<std::uint64_t>* value;
  Count count;
};
struct Texts {
  std::vector<std::string>* value;
  Count count;
};
struct Group {
  std::function<Fields()> fields;
};
/// A list of maps of the same keys.
struct GroupList {
  std::function<void(std::size_t)> resize;
  std::function<std::size_t()> size;
  std::function<Fields(std::size_t)> fields;
  Count count;
};
/// A map whose key `type` says which other keys it has.
struct OneOf {
  std::vector<std::string_view> names;
  std::string_view doc;  ///< of the key `type`
  std::function<int()> get;
  std::function<void(int)> select;  ///< sets all keys to the defaults of that type
  std::function<Fields()> fields;   ///< keys of the type that is set
};
/// Groups by name, each of which may be there or not. Those that are not are not written either.
struct Optionals {
  std::vector<std::string_view> names, docs;
  std::function<std::vector<bool>()> there;
  std::function<void(const std::vector<bool>&)> select;  ///< those that are there, with their defaults
  std::function<Fields(std::size_t)> fields;             ///< of one that is there
};
/// `extends`: resolved before the table is used, kept here for the list of keys and the schema.
struct Extends {};

using Target = std::variant<Number, NumberOr, Integer, Boolean, Text, Choice, MeshFile, GradingFile, Vector,
                            Numbers, Integers, Seeds, Texts, Group, GroupList, OneOf, Optionals, Extends>;

struct Field {
  std::string_view name;
  Target target;
  std::string_view doc;
  bool required = false;
};

/// The table of all keys, bound to a scenario; valid as long as the scenario stays where it is.
Fields scenario_keys(Scenario& scenario);

/// Of a scenario: 2^63 - 1.
inline constexpr std::uint64_t kLargestSeed = 9223372036854775807;

/// Visitor of a variant made of lambdas.
template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace scree
