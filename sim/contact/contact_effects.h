#pragma once
// What effects (sim/effects) add to the contact law. With the defaults nothing is added, and the engine takes
// the way of the plain law.
#include <cmath>

namespace scree {

struct ContactEffects {
  /// Contacts that are closed pull with 2 pi `surface_energy` Rbar (J/m2): the work of adhesion of both
  /// faces.
  double surface_energy = 0;
  /// Twisting resistance: moment about the normal, at most mu_t Rbar Fn.
  double mu_t = 0;
  /// Sliding friction falls with the speed of slip v: mu (1 - weakening v / (v + weakening_speed)).
  double weakening = 0;        ///< share of mu that fast slip takes away, 0 to 1
  double weakening_speed = 1;  ///< m/s
  /// mu and mu_r of a contact change with size: times (sqrt(d1 d2) / reference_diameter)^exponent. Ground and
  /// tools count as of the reference diameter.
  double mu_exponent = 0, mu_r_exponent = 0;
  double reference_diameter = 1;  ///< m
  /// Factors of mu and mu_r of contacts with fixed balls.
  double fixed_mu = 1, fixed_mu_r = 1;

  bool varies_with_size() const { return mu_exponent != 0 || mu_r_exponent != 0; }
  /// Nothing is added to contacts between spheres.
  bool none() const {
    return surface_energy == 0 && mu_t == 0 && weakening == 0 && !varies_with_size() && fixed_mu == 1 &&
           fixed_mu_r == 1;
  }
};

/// What a sphere brings to the friction of its contacts: the coefficients of a contact are those of the law
/// times the factors of both.
struct FrictionFactors {
  float mu = 1, mu_r = 1;
};

inline FrictionFactors friction_factors(const ContactEffects& effects, double diameter, bool fixed) {
  if (fixed) return {static_cast<float>(effects.fixed_mu), static_cast<float>(effects.fixed_mu_r)};
  const double ratio = diameter / effects.reference_diameter;
  return {static_cast<float>(std::pow(ratio, 0.5 * effects.mu_exponent)),
          static_cast<float>(std::pow(ratio, 0.5 * effects.mu_r_exponent))};
}

}  // namespace scree
