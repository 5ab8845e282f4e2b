#include "analysis/pile/lateral.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "analysis/pile/mass_quantile.h"
#include "analysis/statistics/mean_std.h"

namespace scree {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double kTail = 0.025;  // of the mass, left out at either end

double width_of_bulk(const std::vector<WeighedValue>& y) {
  return mass_quantile(y, 1 - kTail) - mass_quantile(y, kTail);
}

double range_of(const std::vector<double>& values) {
  if (values.size() < 2) return nan;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

}  // namespace

Lateral analyse_lateral(const std::vector<Grain>& pile, const std::vector<Grain>& original,
                        double crest_height, int n, int points, double strip_width,
                        const Measurement& measured) {
  if (n < 1 || points < 1 || !(strip_width > 0) || !(crest_height > 0))
    throw std::invalid_argument(
        fmt::format("{} sections, {} dump points, strips of {} m, crest at {} m: all must be above 0", n,
                    points, strip_width, crest_height));
  std::vector<std::map<int, NamedGrains>> strips(static_cast<std::size_t>(n));
  std::vector<WeighedValue> first_point;
  const std::vector<NamedGrains> slices = slices_of(pile, crest_height, n, measured);
  const NamedGrains slope = all_grains_of(slices);
  for (std::size_t s = 0; s < slices.size(); ++s)
    for (std::size_t g = 0; g < slices[s].grains.size(); ++g) {
      const Grain* grain = slices[s].grains[g];
      const double y = grain->position.y();
      NamedGrains& strip = strips[s][static_cast<int>(std::lround(y / strip_width))];
      strip.grains.push_back(grain);
      if (!slices[s].seen.empty()) strip.seen.push_back(slices[s].seen[g]);
      if (s + 1 == slices.size() && (grain->dump - 1) % points == 0) first_point.push_back({y, grain->mass});
    }
  Lateral lateral;
  lateral.strip_width = strip_width;
  lateral.point1_toe_width = width_of_bulk(first_point);
  for (int k = 0; k < n; ++k) {
    LateralSection section;
    section.name = fmt::format("S{}", k + 1);
    std::vector<NamedGrains> counted;
    for (auto& [index, strip] : strips[static_cast<std::size_t>(k)]) {
      if (strip.grains.size() < kLeastStripGrains) continue;
      section.y.push_back(index * strip_width);
      counted.push_back(std::move(strip));
    }
    for (const Section& strip : tabulate(counted, original, measured, &slope).sections) {
      section.chi.push_back(strip.chi);
      section.d50_rel.push_back(strip.d50_rel);
      section.mass.push_back(strip.mass);
    }
    section.chi_std = mean_std(section.chi).std;
    section.chi_range = range_of(section.chi);
    section.d50_rel_std = mean_std(section.d50_rel).std;
    lateral.sections.push_back(std::move(section));
  }
  return lateral;
}

}  // namespace scree
