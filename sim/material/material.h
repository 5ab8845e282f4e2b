#pragma once
// Material parameters of the contact law, and those of a surface that rock touches.
#include <cmath>
#include <numbers>

namespace scree {

/// Where local damping acts. `always` is the thesis's model (PFC3D): in flight too. `contacts` leaves free
/// flight undamped.
enum class DampingReach { always, contacts };

/// Parameters of the rolling resistance linear ("rrlinear") law. Defaults: thesis, Table 5.1.
struct Material {
  double density = 2760.0;           ///< Density of the solid rock, kg/m3.
  double density_exponent = 0;       ///< Density is times (d / density_diameter)^this; effects alone.
  double density_diameter = 1;       ///< m.
  double mu = 0.44;                  ///< Sliding friction coefficient, -.
  double mu_r = 0.44;                ///< Rolling resistance coefficient, -.
  double effective_modulus = 1.0e6;  ///< Effective modulus E of the contacts, Pa.
  double stiffness_ratio = 2.5;      ///< k* = normal over shear stiffness, -.
  double local_damping = 0.4;        ///< alpha of local damping, 0 to 1, -.
  DampingReach damping_reach = DampingReach::always;
  double normal_damping_ratio = 0.0;  ///< beta_n, share of critical damping of the normal dashpot, -.
  double shear_damping_ratio = 0.0;   ///< beta_s, the same of the shear dashpot, -.
};

/// Density of rock: `value` (kg/m3) times (d / diameter)^exponent.
struct RockDensity {
  double value, exponent = 0, diameter = 1;
};

inline RockDensity density_of(const Material& rock) {
  return {rock.density, rock.density_exponent, rock.density_diameter};
}

/// Mass of a sphere of rock (kg) of this diameter (m).
inline double sphere_mass(const Material& rock, double diameter) {
  const double mass = rock.density * std::numbers::pi / 6.0 * std::pow(diameter, 3);
  if (rock.density_exponent == 0) return mass;
  return mass * std::pow(diameter / rock.density_diameter, rock.density_exponent);
}

/// Friction of a surface (truck bed, bench, bucket) against rock; it replaces the rock's own in that contact.
struct Surface {
  double mu = 0.44;           ///< Sliding friction coefficient, -.
  double mu_r = 0.44;         ///< Rolling resistance coefficient, -.
  double surface_energy = 0;  ///< Contacts with it pull with 2 pi times this times the radius, J/m2.
};

}  // namespace scree
