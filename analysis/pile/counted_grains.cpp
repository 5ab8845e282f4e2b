#include "analysis/pile/counted_grains.h"

#include <cmath>
#include <numeric>
#include <utility>

namespace scree {
namespace {

// (1 - share) of the grading of all and share of that of what is seen; grains that do not count then go.
void weigh_by_surface(CountedGrains& counted, const std::vector<double>& seen, double share) {
  const CountedGrains all = std::exchange(counted, {});
  const double whole = std::accumulate(all.masses.begin(), all.masses.end(), 0.0),
               outside = std::inner_product(all.masses.begin(), all.masses.end(), seen.begin(), 0.0);
  for (std::size_t k = 0; k < all.masses.size(); ++k) {
    const double part =
        (1 - share) * all.masses[k] / whole + (outside > 0 ? share * all.masses[k] * seen[k] / outside : 0);
    if (!(part > 0)) continue;
    counted.diameters.push_back(all.diameters[k]);
    counted.masses.push_back(part);
  }
}

}  // namespace

CountedGrains count_grains(const std::vector<const Grain*>& grains, const Measurement& measured,
                           const std::vector<double>& seen) {
  CountedGrains counted;
  counted.diameters.reserve(grains.size());
  counted.masses.reserve(grains.size());
  const bool surface = !seen.empty() && measured.surface_share > 0;
  if (measured.exact() && !surface) {
    for (const Grain* grain : grains) {
      counted.diameters.push_back(grain->diameter);
      counted.masses.push_back(grain->mass);
    }
    return counted;
  }
  double mass = 0;
  for (const Grain* grain : grains) {
    mass += grain->mass;
    const double detected = grain->mass / (1 + std::pow(measured.detection_limit / grain->diameter,
                                                        measured.detection_steepness));
    const double diameter =
        grain->diameter * std::pow(grain->diameter / measured.reference_diameter, measured.bias_exponent);
    counted.diameters.push_back(diameter);
    counted.masses.push_back(detected);
  }
  if (surface) weigh_by_surface(counted, seen, measured.surface_share);
  const double all = std::accumulate(counted.masses.begin(), counted.masses.end(), 0.0);
  for (double& part : counted.masses) part *= mass / all;
  return counted;
}

}  // namespace scree
