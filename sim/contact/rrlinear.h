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
#include <algorithm>
#include <cmath>
#include <numbers>

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

/// Stiffnesses of one contact.
struct ContactStiffness {
  double kn;    ///< N/m
  double ks;    ///< N/m
  double kr;    ///< N m/rad
  double rbar;  ///< effective radius, m
};

inline ContactStiffness ball_ball(const ContactLaw& law, double r1, double r2) {
  const double r = std::min(r1, r2), per_length = 1.0 / (r1 + r2), rbar = r1 * r2 * per_length;
  const double kn = law.modulus_pi * r * r * per_length, ks = kn * law.inverse_stiffness_ratio;
  return {kn, ks, ks * rbar * rbar, rbar};
}

inline ContactStiffness ball_facet(const ContactLaw& law, double r1) {
  const double kn = law.modulus_pi * r1, ks = kn * law.inverse_stiffness_ratio;
  return {kn, ks, ks * r1 * r1, r1};
}

/// What a contact remembers from step to step, as acting on piece 1.
struct ContactHistory {
  Vec3 shear = Vec3::Zero();    ///< N
  Vec3 rolling = Vec3::Zero();  ///< N m
};

/// How the two pieces move against each other over one step.
struct ContactMotion {
  Vec3 normal;          ///< from 1 to 2, unit
  double overlap;       ///< m, positive
  Vec3 velocity;        ///< of 2 against 1 at the contact point, m/s
  Vec3 spin;            ///< of 2 against 1, rad/s
  double twist;         ///< mean spin of the two about the normal, rad/s
  double reduced_mass;  ///< m1 m2 / (m1 + m2), kg; used by the dashpots only
  double dt;            ///< s
};

/// Force and rolling moment on piece 1; piece 2 gets the opposite.
struct ContactForce {
  Vec3 force;    ///< N, normal and shear
  Vec3 rolling;  ///< N m
};

/// Turns a remembered vector with the contact: into the new contact plane with its length kept, and about the
/// normal by `angle` (small), the mean spin of the two, as in PFC3D.
[[gnu::always_inline]] inline Vec3 turned_with_contact(const Vec3& v, const Vec3& n, double angle) {
  const Vec3 flat = v - n * v.dot(n);
  const double flat2 = flat.squaredNorm(), full2 = v.squaredNorm();
  if (!(flat2 > 1e-24 * full2) || full2 == 0.0) return Vec3::Zero();
  const Vec3 in_plane = flat * std::sqrt(full2 / flat2);
  return in_plane + angle * n.cross(in_plane);
}

/// One step of the law; updates the history.
[[gnu::always_inline]] inline ContactForce contact_step(const ContactLaw& law, const ContactStiffness& k,
                                                        const ContactMotion& c, ContactHistory& history) {
  const Vec3& n = c.normal;
  double fn = k.kn * c.overlap;
  const double vn = c.velocity.dot(n);
  const Vec3 slip = c.velocity - n * vn;
  if (law.beta_n > 0.0) {
    fn -= 2.0 * law.beta_n * std::sqrt(c.reduced_mass * k.kn) * vn;
    fn = std::max(fn, 0.0);
  }
  const double twist_angle = c.twist * c.dt;

  Vec3 shear = turned_with_contact(history.shear, n, twist_angle) + (k.ks * c.dt) * slip;
  const double shear_limit = law.mu * fn, shear2 = shear.squaredNorm();
  bool slides = false;
  if (shear2 > shear_limit * shear_limit) {
    shear *= shear_limit / std::sqrt(shear2);
    slides = true;
  }
  history.shear = shear;
  if (law.beta_s > 0.0 && !slides) shear += (2.0 * law.beta_s * std::sqrt(c.reduced_mass * k.ks)) * slip;

  const Vec3 bend = c.spin - n * c.spin.dot(n);
  Vec3 rolling = turned_with_contact(history.rolling, n, twist_angle) + (k.kr * c.dt) * bend;
  const double rolling_limit = law.mu_r * k.rbar * fn, rolling2 = rolling.squaredNorm();
  if (rolling2 > rolling_limit * rolling_limit) rolling *= rolling_limit / std::sqrt(rolling2);
  history.rolling = rolling;

  return {shear - n * fn, rolling};
}

/// Elastic energy held by a contact (J).
inline double elastic_energy(const ContactStiffness& k, double overlap, const ContactHistory& h) {
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
