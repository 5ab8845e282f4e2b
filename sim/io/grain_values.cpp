#include "sim/io/grain_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/material/input_bytes.h"
#include "sim/material/input_text.h"

namespace scree {
namespace {

constexpr double kMostId = 9007199254740991.0;  // 2^53 - 1: a larger one may be another that was rounded
constexpr double kMostDumps = 1e6;
constexpr double kRounding = 1e-3;  // of a diameter and a radius written to three or four digits

[[noreturn]] void fail(const GrainPlace& place, const std::string& message) {
  throw FileError(place.file, place.line,
                  place.line > 0 ? message : fmt::format("grain {}: {}", place.index + 1, message));
}

}  // namespace

std::optional<std::int64_t> integer_in(double number, double least, double most) {
  if (!(number >= least && number <= most && number == std::floor(number))) return std::nullopt;
  return static_cast<std::int64_t>(number);
}

double diameter_of(std::optional<double> diameter, std::optional<double> radius, const GrainPlace& place) {
  if (!diameter) return 2 * radius.value();
  if (radius && std::isfinite(*diameter)) {
    const double twice = 2 * *radius;
    if (!(std::isfinite(twice) &&
          std::abs(*diameter - twice) <= kRounding * std::max(std::abs(*diameter), std::abs(twice))))
      fail(place, fmt::format("diameter {:g} is not twice the radius {:g}; leave out the one that is wrong",
                              *diameter, *radius));
  }
  return *diameter;
}

std::int64_t id_of(double number, const GrainPlace& place) {
  const auto id = integer_in(number, -kMostId, kMostId);
  if (!id) fail(place, fmt::format("id must be an integer between -2^53 and 2^53, found {}", number));
  return *id;
}

int dump_of(double number, const GrainPlace& place) {
  const auto dump = integer_in(number, 1, kMostDumps);
  if (!dump)
    fail(place, fmt::format("dump must be an integer from 1 to {:.0f}, found {}", kMostDumps, number));
  return static_cast<int>(*dump);
}

double velocity_in(std::string_view word) {
  return number_in(word).value_or(0);
}

}  // namespace scree
