#include "analysis/pile/vertical_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace scree {
namespace {

void positive(double value, const char* what) {
  if (!(value > 0 && std::isfinite(value)))
    throw std::invalid_argument(fmt::format("{} {} m must be above 0", what, value));
}

}  // namespace

double BenchOutline::toe() const {
  return height / std::tan(slope_deg * std::numbers::pi / 180);
}

double BenchOutline::ground(double x) const {
  return std::clamp(height * (1 - x / toe()), 0.0, height);
}

void check(const BenchOutline& bench) {
  positive(bench.height, "bench height");
  if (!(bench.slope_deg > 0 && bench.slope_deg < 90))
    throw std::invalid_argument(
        fmt::format("slope of {} degrees must lie between 0 and 90", bench.slope_deg));
}

void check(const VerticalSection& section) {
  positive(section.half_width, "half width of the section");
  positive(section.cell, "cell size");
  if (!std::isfinite(section.y0)) throw std::invalid_argument("the section's y0 must be a number");
  if (section.bench) check(*section.bench);
}

}  // namespace scree
