#pragma once
// What every reader of piles asks of a grain's values, whatever the format they stand in.
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace scree {

/// Where a grain stands in a file, for messages.
struct GrainPlace {
  const std::filesystem::path& file;
  int line;           ///< 0 where the file has no lines
  std::size_t index;  ///< from 0
};

/// The integer that a number is; none if it is no integer, or not one from `least` to `most`, which must be
/// within 1e18.
std::optional<std::int64_t> integer_in(double number, double least, double most);

/// A velocity as it is written; 0 for what is no number, as nothing is asked of it.
double velocity_in(std::string_view word);

/// The diameter of a grain that has a diameter, a radius, or both. Throws FileError where both are there and
/// contradict each other: a diameter that is not twice the radius to a thousandth, which is more than
/// rounding.
double diameter_of(std::optional<double> diameter, std::optional<double> radius, const GrainPlace& place);

/// Throw FileError for what is none: an id is an integer, a dump one from 1 on.
std::int64_t id_of(double number, const GrainPlace& place);
int dump_of(double number, const GrainPlace& place);

}  // namespace scree
