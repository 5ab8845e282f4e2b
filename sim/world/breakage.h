#pragma once
// Spheres that break. When a contact stores more energy in a sphere than this can bear, four fragments stand
// in its place: equal ones, inside it, at the corners of a tetrahedron, so that they overlap neither each
// other nor neighbours more than it did. Mass, momentum and angular momentum are kept, to rounding; the
// energy of the sphere's contacts is lost, as in fracture. Spheres inside a sphere are smaller than it in
// volume: the fragments grow, a little at a time, until their volumes add up to that of the sphere. What that
// takes is work against the weight of the pile, as when rock that breaks takes more room.
#include <array>
#include <cmath>
#include <cstdint>

#include "sim/material/vector.h"

namespace scree {

struct Breakage {
  double fragility = 0;           ///< kg/J; one over the strength of a sphere of reference_diameter; 0: none
  double exponent = 0;            ///< strength goes with (d / reference_diameter)^-exponent
  double reference_diameter = 1;  ///< m
  double smallest_diameter = 0;   ///< m; no fragment is finer

  static constexpr int kFragments = 4;
  /// Diameter of a fragment over that of the sphere it comes of: 4^(-1/3).
  static constexpr double kSize = 0.62996052494743658;
  /// Its radius at first over that of the sphere: 1 / (1 + sqrt(3/2)), the largest of four that fit.
  static constexpr double kSizeAtFirst = 0.44948974278317809;
  static constexpr double kGrowth = 1.01;      ///< of the radius, in kGrowthSteps
  static constexpr double kGrowthSteps = 3.0;  ///< free steps of the fragment, sqrt(m / k)

  /// Spin of the fragments over that of the sphere: four balls of a quarter of its mass each, rho =
  /// 1 - kSizeAtFirst off its middle, have 2/3 rho^2 + 0.4 kSizeAtFirst^2 of its mass and radius squared
  /// for moment of inertia, less than its 0.4; angular momentum is kept, here and while they grow.
  static constexpr double spin_at_first() {
    constexpr double rho = 1 - kSizeAtFirst;
    return 0.4 / (2. / 3 * rho * rho + 0.4 * kSizeAtFirst * kSizeAtFirst);
  }

  bool on() const { return fragility > 0; }
  /// Energy per mass (J/kg) that breaks a sphere; infinite for those that do not break.
  double strength(double diameter) const {
    if (diameter * kSize < smallest_diameter) return HUGE_VAL;
    return std::pow(diameter / reference_diameter, -exponent) / fragility;
  }
};

/// Middles of the fragments of a sphere, from its middle, over its radius. The tetrahedron is turned by
/// `number`, another way for each.
std::array<Vec3, Breakage::kFragments> fragment_places(std::uint64_t number);

/// A fragment that has not its full size yet.
struct GrowingSphere {
  int sphere;     ///< index
  double radius;  ///< m, when grown
};

}  // namespace scree
