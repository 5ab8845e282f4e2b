#include "analysis/pile/mass_quantile.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace scree {

double mass_quantile(std::vector<WeighedValue> values, double share) {
  if (!(share >= 0 && share <= 1))
    throw std::invalid_argument(fmt::format("share {} of the mass must lie between 0 and 1", share));
  double mass = 0;
  for (const WeighedValue& each : values) {
    if (!(each.mass > 0)) throw std::invalid_argument(fmt::format("mass {} must be above 0", each.mass));
    mass += each.mass;
  }
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::stable_sort(values.begin(), values.end(),
                   [](const WeighedValue& a, const WeighedValue& b) { return a.value < b.value; });
  double below = 0;
  for (const WeighedValue& each : values) {
    below += each.mass;
    // The sum of all parts may miss the whole by rounding.
    if (below >= share * mass * (1 - 1e-12)) return each.value;
  }
  return values.back().value;
}

}  // namespace scree
