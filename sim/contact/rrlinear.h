#pragma once
// The rolling resistance linear ("rrlinear") contact law, in its one place. Sphere-sphere, sphere-mesh and
// sphere-fixed ball contacts all come through here.
//
// Piece 1 is a sphere, piece 2 a sphere or a facet; the normal n points from 1 to 2, the overlap u is
// positive.
//   normal   Fn = kn u                                          no tension
//   shear    Fs <- rotated Fs + ks (tangential displacement of 2 against 1), |Fs| <= mu Fn
//   rolling  Mr <- rotated Mr + kr (rotation of 2 against 1 in the contact plane), |Mr| <= mu_r Rbar Fn
// and, with effects (contact_effects.h) alone,
//   twisting Mt <- Mt + kr (rotation of 2 against 1 about the normal), |Mt| <= mu_t Rbar Fn
//   pull     2 pi gamma Rbar against Fn, for the time that the contact is closed (share_closed); limits stay
//            those of the spring's Fn, as they must for a contact that sticks to be as hard to shear as one
//            that is pressed together
//   kn = pi r^2 E / L, ks = kn / k*, kr = ks Rbar^2
//   ball-ball:  r = min(R1, R2), L = R1 + R2, 1/Rbar = 1/R1 + 1/R2
//   ball-facet: r = R1,          L = R1,      Rbar = R1
// Source: PFC3D 5.0 documentation, linear and rolling resistance linear models; Wensrich & Katterfeld, Powder
// Technology 217 (2012).
#include <cmath>
#include <numbers>
#include <type_traits>

#include "sim/contact/contact_effects.h"
#include "sim/contact/lanes.h"
#include "sim/material/material.h"
#include "sim/material/vector.h"

namespace scree {

/// What of material and effects a contact needs, prepared once.
struct ContactLaw {
  double modulus_pi;               ///< pi E, Pa
  double inverse_stiffness_ratio;  ///< 1 / k*
  double mu, mu_r;
  double beta_n, beta_s;
  double mu_t;                        ///< twisting resistance
  double pull;                        ///< 2 pi gamma: pull of a contact over its Rbar, N/m
  double weakening, weakening_speed;  ///< of mu with the speed of slip (m/s)

  explicit ContactLaw(const Material& m, const ContactEffects& effects = {})
      : modulus_pi(std::numbers::pi * m.effective_modulus),
        inverse_stiffness_ratio(1.0 / m.stiffness_ratio),
        mu(m.mu),
        mu_r(m.mu_r),
        beta_n(m.normal_damping_ratio),
        beta_s(m.shear_damping_ratio),
        mu_t(effects.mu_t),
        pull(pull_of(effects.surface_energy)),
        weakening(effects.weakening),
        weakening_speed(effects.weakening_speed) {}

  bool has_dashpots() const { return beta_n > 0 || beta_s > 0; }
  static double pull_of(double surface_energy) { return 2 * std::numbers::pi * surface_energy; }
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
struct ContactHistory {
  Vec3 shear = Vec3::Zero();    ///< N
  Vec3 rolling = Vec3::Zero();  ///< N m
  double twisting = 0;          ///< N m about the normal; effects alone
  double dashpot_power = 0;     ///< W, that dashpots took in the last step
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
  double pulls = 1;     ///< share of the pull that acts (share_closed)
};

/// Energy that one step of a contact takes from the motion for good, J (world/energy_balance.h).
template <class Real>
struct BasicContactLoss {
  Real sliding, rolling, twisting, dashpots;
};

/// Force and rolling moment on piece 1; piece 2 gets the opposite.
template <class Real>
struct BasicContactForce {
  using Vector = typename VectorOf<Real>::type;
  Vector force;    ///< N, normal and shear
  Vector rolling;  ///< N m
  BasicContactLoss<Real> loss;
};
using ContactForce = BasicContactForce<double>;

/// Share of the upright part of a memory, squared, below which its part in the contact plane is rounding.
template <class Real>
constexpr auto kRounding = 1e-12f;
template <>
inline constexpr auto kRounding<double> = 1e-24;

/// Turns a remembered vector with the contact, its length kept: into the new contact plane, and about the
/// normal by `angle` (small; atan(angle) to be exact), that of the mean spin of the two, as in PFC3D. What is
/// small is added to `v` as such, so that a length does not drift in single precision either, however slowly
/// the contact turns.
template <class Vector, class Real = typename RealOf<Vector>::type>
SCREE_INLINE Vector turned_with_contact(const Vector& v, const Vector& n, std::type_identity_t<Real> angle) {
  const Real one = Real{} + 1, up = v.dot(n), up2 = up * up, angle2 = angle * angle;
  const Vector flat = v - n * up, twist = n.cross(flat) * angle;
  const Real flat2 = flat.squaredNorm();
  // |v| / |flat + twist| = sqrt(1 + excess) = 1 + stretch, as a series: good to 4e-6 for a turn of 18 degrees
  // in one step. A memory that stands on the new plane, or none at all, leaves nothing.
  const Real excess = smaller((up2 - flat2 * angle2) / (flat2 * (one + angle2)), one);
  const Real series = excess * (0.5f - excess * (0.125f - excess * 0.0625f));
  const Real stretch = pick(flat2 > up2 * kRounding<Real>, series, -one);
  return v + ((flat + twist) * stretch + (twist - n * up));
}

/// One step of a memory: turned with the contact, what the pieces have moved against each other in the
/// contact plane added, cut off at the limit. `slips`: it was cut off. `lost`: work of the slip, times the
/// stiffness.
template <class Vector, class Real, class Mask>
SCREE_INLINE Vector carried_on(const Vector& memory, const Vector& normal, Real angle, const Vector& added,
                               Real limit, Mask& slips, Real& lost) {
  const Vector turned = turned_with_contact(memory, normal, angle), whole = turned + added;
  const Real one = Real{} + 1, size2 = whole.squaredNorm();
  slips = size2 > limit * limit;
  const Real kept = pick(slips, limit / root(size2), one);
  lost = (one - kept) * (whole.dot(turned) + kept * size2) * 0.5f;
  return whole * kept;
}

/// Force of the normal dashpot over the speed of closing, N s/m.
template <class Real>
SCREE_INLINE Real normal_dashpot(const ContactLaw& law, const BasicContactStiffness<Real>& k,
                                 Real reduced_mass) {
  return 2.0 * law.beta_n * root(reduced_mass * k.kn);
}

/// Normal force, with its dashpot; `opening`: speed of 2 against 1 along the normal, m/s.
template <class Real>
SCREE_INLINE Real normal_force(const ContactLaw& law, const BasicContactStiffness<Real>& k, Real overlap,
                               Real reduced_mass, Real opening) {
  const Real spring = k.kn * overlap;
  if (law.beta_n <= 0.0) return spring;
  return larger(spring - normal_dashpot(law, k, reduced_mass) * opening, Real{});
}

/// Force of the shear dashpot over the slip velocity, N s/m; it acts while the contact sticks.
template <class Real>
SCREE_INLINE Real shear_dashpot(const ContactLaw& law, const BasicContactStiffness<Real>& k,
                                Real reduced_mass) {
  return 2.0 * law.beta_s * root(reduced_mass * k.ks);
}

/// Sliding friction at a speed of slip (m/s).
template <class Real>
SCREE_INLINE Real weakened(const ContactLaw& law, Real mu, Real speed) {
  return mu * (1.0 - law.weakening * speed / (speed + law.weakening_speed));
}

/// One step of a twisting moment, cut off at the limit. `lost`: work of the slip, times the stiffness.
template <class Real>
SCREE_INLINE Real twisted_on(Real moment, Real added, Real limit, Real& lost) {
  const Real whole = moment + added, kept = larger(smaller(whole, limit), -limit);
  lost = (whole - kept) * (moment + kept) * 0.5;
  return kept;
}

/// Share of the pull P that acts at a place, for steps of one length. On the way that led here the pull does
/// the work P (max(u, 0) - max(before, 0)). The place before gave half of the way if it was closed; this one
/// gives the rest, and half of the way ahead if it is closed: 1 while a contact stays closed, from 1/2 to 3/2
/// where it closes, from -1/2 to 1/2 where it has opened. So neither makes energy to the first order of dt,
/// as a pull that came with the first overlap, whole, would. `opening`: m/s.
template <class Real>
SCREE_INLINE Real share_closed(Real overlap, Real opening, double dt) {
  const Real none{}, one = none + 1.0, half = none + 0.5;
  const Real before = overlap + opening * dt, moved = overlap - before;
  const Real closed = pick(overlap > none, one, none),
             of_way =
                 pick(moved * moved > none, (larger(overlap, none) - larger(before, none)) / moved, closed);
  return of_way - pick(before > none, half, none) + 0.5 * closed;
}

/// Work (J) of dashpots that take `power` now and took `before` in the step before.
template <class Real>
SCREE_INLINE Real dashpot_work(Real power, Real before, double dt) {
  return (power + root(power * before)) * (0.5 * dt);
}

/// One step of the law; updates the history.
inline ContactForce contact_step(const ContactLaw& law, const ContactStiffness& k, const ContactMotion& c,
                                 ContactHistory& history) {
  const Vec3& n = c.normal;
  const double opening = c.velocity.dot(n), angle = c.twist * c.dt;
  const Vec3 slip = c.velocity - n * opening, bend = c.spin - n * c.spin.dot(n);
  const double fn = normal_force(law, k, c.overlap, c.reduced_mass, opening);

  const double mu = law.weakening == 0 ? law.mu : weakened(law, law.mu, slip.norm());
  bool slides, rolls;
  ContactForce f;
  f.loss = {};
  history.shear =
      carried_on<Vec3>(history.shear, n, angle, slip * (k.ks * c.dt), mu * fn, slides, f.loss.sliding);
  history.rolling = carried_on<Vec3>(history.rolling, n, angle, bend * (k.kr * c.dt), law.mu_r * k.rbar * fn,
                                     rolls, f.loss.rolling);
  if (slides) f.loss.sliding /= k.ks;
  if (rolls) f.loss.rolling /= k.kr;

  Vec3 shear = history.shear;
  if (law.has_dashpots()) {
    const double shear_viscosity = slides ? 0.0 : shear_dashpot(law, k, c.reduced_mass);
    if (law.beta_s > 0.0 && !slides) shear += slip * shear_viscosity;
    const double power =
        std::max((k.kn * c.overlap - fn) * opening, 0.0) + shear_viscosity * slip.squaredNorm();
    f.loss.dashpots = dashpot_work(power, history.dashpot_power, c.dt);
    history.dashpot_power = power;
  }
  f.rolling = history.rolling;
  if (law.mu_t > 0) {
    history.twisting =
        twisted_on(history.twisting, k.kr * c.dt * c.spin.dot(n), law.mu_t * k.rbar * fn, f.loss.twisting);
    f.loss.twisting /= k.kr;
    f.rolling += history.twisting * n;
  }
  f.force = shear - n * (fn - c.pulls * law.pull * k.rbar);
  return f;
}

// The same for four contacts side by side. Overlap, the spring's normal force and the sums stay in double
// precision. What is remembered is kept in single precision (ContactMemory), and so is what is added to it
// and what dashpots see: motion in the contact plane, shear in one half of a register beside rolling in the
// other.

/// Motion of four contacts.
struct LaneContactMotion {
  LaneVec3 normal;
  LaneVector<LaneFloats> rounded_normal;
  Lanes overlap;
  LaneVector<TwinFloats> velocity_and_spin;  ///< of 2 against 1
  LaneFloats twist;
  Lanes reduced_mass;
  double dt;
};
/// What four contacts remember.
struct LaneContactHistory {
  LaneVector<TwinFloats> springs;  ///< shear forces beside rolling moments
  TwinFloats further;              ///< twisting moments (N m, effects alone) beside the power of dashpots (W)
};

/// Keeps the slip of a step without duration, in which nothing slips, from being 0 / 0.
inline constexpr float kNoStep = 1e-30f;

/// Friction of four contacts under the plain law, and with what effects make of it.
struct PlainFriction {
  static constexpr bool kEffects = false;
  double mu, mu_r;
};
struct EffectFriction {
  static constexpr bool kEffects = true;
  Lanes mu, mu_r;
};

template <class Friction>
SCREE_INLINE BasicContactForce<Lanes> contact_step(const ContactLaw& law, const Friction& friction,
                                                   const BasicContactStiffness<Lanes>& k,
                                                   const LaneContactMotion& c, LaneContactHistory& history) {
  const LaneVector<LaneFloats>& n = c.rounded_normal;
  const LaneVector<TwinFloats> nn = {twin(n.x_, n.x_), twin(n.y_, n.y_), twin(n.z_, n.z_)};
  const LaneFloats angle = c.twist * static_cast<float>(c.dt);
  const TwinFloats along = c.velocity_and_spin.dot(nn);
  const LaneVector<TwinFloats> slip_and_bend = c.velocity_and_spin - nn * along;
  const Lanes fn = normal_force(law, k, c.overlap, c.reduced_mass, wide(first_half(along)));

  auto mu = friction.mu;
  if constexpr (Friction::kEffects)
    mu = weakened(law, mu, wide(first_half(root(slip_and_bend.squaredNorm()))));
  // A contact that opens slips by all that it holds; of its force at most a pull is used.
  const LaneMask closed = c.overlap > Lanes{};
  const Lanes pressed = pick(closed, fn, Lanes{});
  const TwinFloats stiffness = twin(narrow(k.ks * c.dt), narrow(k.kr * c.dt)),
                   limit = twin(narrow(mu * pressed), narrow(friction.mu_r * k.rbar * pressed));
  TwinMask slips;
  TwinFloats lost;
  history.springs =
      carried_on(history.springs, nn, twin(angle, angle), slip_and_bend * stiffness, limit, slips, lost);
  lost *= static_cast<float>(c.dt) / (stiffness + kNoStep);

  BasicContactForce<Lanes> f;
  f.loss.sliding = wide(first_half(lost)), f.loss.rolling = wide(second_half(lost));
  f.loss.twisting = f.loss.dashpots = Lanes{};
  LaneVec3 shear = wide_first(history.springs);
  if (law.has_dashpots()) {
    const Lanes sticks = wide(first_half(pick(slips, TwinFloats{}, TwinFloats{} + 1))),
                shear_viscosity = sticks * shear_dashpot(law, k, c.reduced_mass);
    const LaneVec3 slip = wide_first(slip_and_bend);
    if (law.beta_s > 0.0) shear = shear + slip * shear_viscosity;
    const Lanes power = pick(closed,
                             larger((k.kn * c.overlap - fn) * wide(first_half(along)), Lanes{}) +
                                 shear_viscosity * slip.squaredNorm(),
                             Lanes{});
    f.loss.dashpots = dashpot_work(power, wide(second_half(history.further)), c.dt);
    history.further = twin(first_half(history.further), narrow(power));
  }
  f.rolling = wide_second(history.springs);
  Lanes along_normal = pressed;
  if constexpr (Friction::kEffects) {
    const Lanes twisting =
        twisted_on(wide(first_half(history.further)), k.kr * c.dt * wide(second_half(along)),
                   law.mu_t * k.rbar * pressed, f.loss.twisting);
    f.loss.twisting /= k.kr;
    const LaneFloats rounded = narrow(twisting);
    history.further = twin(rounded, second_half(history.further));
    f.rolling = f.rolling + c.normal * wide(rounded);
    if (law.pull > 0)
      along_normal -= law.pull * k.rbar * share_closed(c.overlap, wide(first_half(along)), c.dt);
  }
  f.force = shear - c.normal * along_normal;
  return f;
}

/// Elastic energy held by the springs of a contact (J).
inline double elastic_energy(const ContactStiffness& k, double overlap, const ContactHistory& h) {
  return 0.5 * k.kn * overlap * overlap + 0.5 * h.shear.squaredNorm() / k.ks +
         0.5 * (h.rolling.squaredNorm() + h.twisting * h.twisting) / k.kr;
}

/// Local (non-viscous) damping of one component: the generalised force f becomes f - alpha |f| sign(v).
/// Source: Cundall (1987); PFC3D documentation.
inline double locally_damped(double f, double v, double alpha) {
  if (v == 0.0) return f;
  return f - alpha * std::abs(f) * (v > 0.0 ? 1.0 : -1.0);
}

}  // namespace scree
