#pragma once
// The rolling resistance linear ("rrlinear") contact law, in its one place. Sphere-sphere, sphere-mesh and
// sphere-fixed ball contacts all come through here.
//
// Piece 1 is a sphere, piece 2 a sphere or a facet; the normal n points from 1 to 2, the overlap u is
// positive.
//   normal   Fn = kn u                                          no tension
//   shear    Fs <- rotated Fs + ks (tangential displacement of 2 against 1), |Fs| <= mu Fn
//   rolling  Mr <- rotated Mr + kr (rotation of 2 against 1 in the contact plane), |Mr| <= mu_r Rbar Fn
//   kn = pi r^2 E / L, ks = kn / k*, kr = ks Rbar^2
//   ball-ball:  r = min(R1, R2), L = R1 + R2, 1/Rbar = 1/R1 + 1/R2
//   ball-facet: r = R1,          L = R1,      Rbar = R1
// Source: PFC3D 5.0 documentation, linear and rolling resistance linear models; Wensrich & Katterfeld, Powder
// Technology 217 (2012).
#include <cmath>
#include <numbers>
#include <type_traits>

#include "sim/contact/lanes.h"
#include "sim/material/material.h"
#include "sim/material/vector.h"

namespace scree {

/// What of the material a contact needs, prepared once.
struct ContactLaw {
  double modulus_pi;               ///< pi E, Pa
  double inverse_stiffness_ratio;  ///< 1 / k*
  double mu, mu_r;
  double beta_n, beta_s;

  explicit ContactLaw(const Material& m)
      : modulus_pi(std::numbers::pi * m.effective_modulus),
        inverse_stiffness_ratio(1.0 / m.stiffness_ratio),
        mu(m.mu),
        mu_r(m.mu_r),
        beta_n(m.normal_damping_ratio),
        beta_s(m.shear_damping_ratio) {}
};

/// Stiffnesses of one contact, or of four side by side.
template <class Real>
struct BasicContactStiffness {
  Real kn;    ///< N/m
  Real ks;    ///< N/m
  Real kr;    ///< N m/rad
  Real rbar;  ///< effective radius, m
};
using ContactStiffness = BasicContactStiffness<double>;

template <class Real>
SCREE_INLINE BasicContactStiffness<Real> ball_ball(const ContactLaw& law, Real r1, Real r2) {
  const Real r = smaller(r1, r2), per_length = 1.0 / (r1 + r2), rbar = r1 * r2 * per_length;
  const Real kn = law.modulus_pi * r * r * per_length, ks = kn * law.inverse_stiffness_ratio;
  return {kn, ks, ks * rbar * rbar, rbar};
}

inline ContactStiffness ball_facet(const ContactLaw& law, double r1) {
  const double kn = law.modulus_pi * r1, ks = kn * law.inverse_stiffness_ratio;
  return {kn, ks, ks * r1 * r1, r1};
}

/// What a contact remembers from step to step, as acting on piece 1.
template <class Real>
struct BasicContactHistory {
  using Vector = typename VectorOf<Real>::type;
  Vector shear;    ///< N
  Vector rolling;  ///< N m
};
struct ContactHistory : BasicContactHistory<double> {
  ContactHistory() : BasicContactHistory<double>{Vec3::Zero(), Vec3::Zero()} {}
};

/// How the two pieces move against each other over one step.
template <class Real>
struct BasicContactMotion {
  using Vector = typename VectorOf<Real>::type;
  Vector normal;      ///< from 1 to 2, unit
  Real overlap;       ///< m, positive
  Vector velocity;    ///< of 2 against 1 at the contact point, m/s
  Vector spin;        ///< of 2 against 1, rad/s
  Real twist;         ///< mean spin of the two about the normal, rad/s
  Real reduced_mass;  ///< m1 m2 / (m1 + m2), kg; used by the dashpots only
  double dt;          ///< s
};
using ContactMotion = BasicContactMotion<double>;

/// Force and rolling moment on piece 1; piece 2 gets the opposite.
template <class Real>
struct BasicContactForce {
  using Vector = typename VectorOf<Real>::type;
  Vector force;    ///< N, normal and shear
  Vector rolling;  ///< N m
};
using ContactForce = BasicContactForce<double>;

/// Turns a remembered vector with the contact, its length kept: into the new contact plane, and about the
/// normal by `angle` (small; atan(angle) to be exact), that of the mean spin of the two, as in PFC3D.
template <class Vector, class Real = typename RealOf<Vector>::type>
SCREE_INLINE Vector turned_with_contact(const Vector& v, const Vector& n, std::type_identity_t<Real> angle) {
  const Vector flat = v - n * v.dot(n);
  const Real flat2 = flat.squaredNorm(), full2 = v.squaredNorm();
  // A memory that stands on the new plane, or none at all, leaves nothing.
  const auto lies = flat2 > 1e-24 * full2;
  const Real lengthened = 1.0 + angle * angle;  // squared, by the twist
  return (flat + n.cross(flat) * angle) * pick(lies, root(full2 / (flat2 * lengthened)), Real{});
}

/// One step of the law; updates the history.
template <class Real>
SCREE_INLINE BasicContactForce<Real> contact_step(const ContactLaw& law, const BasicContactStiffness<Real>& k,
                                                  const BasicContactMotion<Real>& c,
                                                  BasicContactHistory<Real>& history) {
  using Vector = typename VectorOf<Real>::type;
  const Real one = all_lanes<Real>(1.0);
  const Vector& n = c.normal;
  Real fn = k.kn * c.overlap;
  const Real vn = c.velocity.dot(n);
  const Vector slip = c.velocity - n * vn;
  if (law.beta_n > 0.0) fn = larger(fn - 2.0 * law.beta_n * root(c.reduced_mass * k.kn) * vn, Real{});
  const Real twist_angle = c.twist * c.dt;

  Vector shear = turned_with_contact(history.shear, n, twist_angle) + slip * Real(k.ks * c.dt);
  const Real shear_limit = law.mu * fn, shear2 = shear.squaredNorm();
  const auto slides = shear2 > shear_limit * shear_limit;
  shear = shear * pick(slides, shear_limit / root(shear2), one);
  history.shear = shear;
  if (law.beta_s > 0.0)
    shear = shear + slip * pick(slides, Real{}, 2.0 * law.beta_s * root(c.reduced_mass * k.ks));

  const Vector bend = c.spin - n * c.spin.dot(n);
  Vector rolling = turned_with_contact(history.rolling, n, twist_angle) + bend * Real(k.kr * c.dt);
  const Real rolling_limit = law.mu_r * k.rbar * fn, rolling2 = rolling.squaredNorm();
  const auto rolls = rolling2 > rolling_limit * rolling_limit;
  rolling = rolling * pick(rolls, rolling_limit / root(rolling2), one);
  history.rolling = rolling;

  return {shear - n * fn, rolling};
}

/// Elastic energy held by a contact (J).
inline double elastic_energy(const ContactStiffness& k, double overlap,
                             const BasicContactHistory<double>& h) {
  return 0.5 * k.kn * overlap * overlap + 0.5 * h.shear.squaredNorm() / k.ks +
         0.5 * h.rolling.squaredNorm() / k.kr;
}

/// Local (non-viscous) damping of one component: the generalised force f becomes f - alpha |f| sign(v).
/// Source: Cundall (1987); PFC3D documentation.
inline double locally_damped(double f, double v, double alpha) {
  if (v == 0.0) return f;
  return f - alpha * std::abs(f) * (v > 0.0 ? 1.0 : -1.0);
}

}  // namespace scree
