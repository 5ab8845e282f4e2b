#include "analysis/counted_grains.h"

#include <cmath>
#include <numeric>

namespace scree {
namespace {

// Gauss-Hermite rule of five points for a normal distribution of deviation 1 (Abramowitz & Stegun, 25.4.46):
// its mean and variance are exact, so that mean log d keeps its value.
struct Spread {
  double deviation, share;
};
constexpr Spread kSpread[] = {{-2.8569700138728056, 0.011257411327720693},
                              {-1.3556261799742659, 0.22207592200561264},
                              {0, 0.53333333333333333},
                              {1.3556261799742659, 0.22207592200561264},
                              {2.8569700138728056, 0.011257411327720693}};

}  // namespace

CountedGrains count_grains(const std::vector<const Grain*>& grains, const Measurement& measured) {
  CountedGrains counted;
  counted.diameters.reserve(grains.size());
  counted.masses.reserve(grains.size());
  if (measured.exact()) {
    for (const Grain* grain : grains) {
      counted.diameters.push_back(grain->diameter);
      counted.masses.push_back(grain->mass);
    }
    return counted;
  }
  double mass = 0;
  for (const Grain* grain : grains) {
    mass += grain->mass;
    const double seen = grain->mass / (1 + std::pow(measured.detection_limit / grain->diameter,
                                                    measured.detection_steepness));
    const double diameter =
        grain->diameter * std::pow(grain->diameter / measured.reference_diameter, measured.bias_exponent);
    if (measured.blur == 0) {
      counted.diameters.push_back(diameter);
      counted.masses.push_back(seen);
      continue;
    }
    for (const Spread& part : kSpread) {
      counted.diameters.push_back(diameter * std::exp(part.deviation * measured.blur));
      counted.masses.push_back(part.share * seen);
    }
  }
  const double seen = std::accumulate(counted.masses.begin(), counted.masses.end(), 0.0);
  for (double& part : counted.masses) part *= mass / seen;
  return counted;
}

}  // namespace scree
