#pragma once
// The value below which a share of the mass lies.
#include <vector>

namespace scree {

/// A value and the mass (kg, or any weight) that has it.
struct WeighedValue {
  double value = 0;
  double mass = 0;
};

/// The smallest of the values such that at least `share` (0 to 1) of the mass has it or a lower one; NaN
/// without values. The median by mass is share 0.5. Throws std::invalid_argument for a share outside 0 to 1
/// or a mass that is not above 0.
double mass_quantile(std::vector<WeighedValue> values, double share);

}  // namespace scree
