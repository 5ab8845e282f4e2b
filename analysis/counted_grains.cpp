#include "analysis/counted_grains.h"

#include <cmath>
#include <numeric>

namespace scree {

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
    counted.diameters.push_back(diameter);
    counted.masses.push_back(seen);
  }
  const double seen = std::accumulate(counted.masses.begin(), counted.masses.end(), 0.0);
  for (double& part : counted.masses) part *= mass / seen;
  return counted;
}

}  // namespace scree
