#pragma once
// Small scenes for the verification tests.
//
// The integrator is leapfrog: after a run to time t the places are those of t and the velocities those of t -
// dt/2; the velocity a sphere is added with is that of -dt/2. Tolerances of order dt below come from this
// shift.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "sim/material/random.h"
#include "sim/world/rrlinear_world.h"

namespace scree::verification {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kGravity = 9.81;  // m/s2

/// No damping of any kind, no friction, a step of its own.
inline WorldSettings undamped(double dt) {
  WorldSettings s;
  s.material.local_damping = 0;
  s.material.mu = 0;
  s.material.mu_r = 0;
  s.fixed_time_step = dt;
  return s;
}

inline WorldSettings weightless(double dt) {
  WorldSettings s = undamped(dt);
  s.gravity = Vec3::Zero();
  return s;
}

inline NewSphere ball(const Vec3& position, double radius, const Vec3& velocity = Vec3::Zero(),
                      const Vec3& spin = Vec3::Zero()) {
  NewSphere s;
  s.position = position;
  s.diameter = 2 * radius;
  s.dump = 1;
  s.velocity = velocity;
  s.spin = spin;
  return s;
}

inline NewSphere fixed_ball(const Vec3& position, double radius) {
  NewSphere s = ball(position, radius);
  s.dump = 0;
  s.fixed = true;
  return s;
}

inline int index_of(const RockWorld& world, std::int64_t id) {
  for (int i = 0; i < world.spheres().size(); ++i)
    if (world.spheres().id[i] == id) return i;
  ADD_FAILURE() << "no sphere " << id;
  return 0;
}
inline Vec3 place_of(const RockWorld& world, std::int64_t id) {
  return world.spheres().place[index_of(world, id)].vec();
}
inline Vec3 velocity_of(const RockWorld& world, std::int64_t id) {
  return world.spheres().velocity[index_of(world, id)].vec();
}
inline Vec3 spin_of(const RockWorld& world, std::int64_t id) {
  return world.spheres().spin[index_of(world, id)].vec();
}

/// One step of a world with a fixed step.
inline void step(RockWorld& world) {
  world.advance_to(world.time() + world.settings().fixed_time_step);
}

inline double ball_mass(const Material& m, double radius) {
  return m.density * 4.0 / 3.0 * kPi * std::pow(radius, 3);
}
/// kn of a sphere on a facet: pi r^2 E / r.
inline double wall_stiffness(const Material& m, double radius) {
  return kPi * radius * m.effective_modulus;
}
/// kn of two spheres: pi min(r)^2 E / (r1 + r2).
inline double pair_stiffness(const Material& m, double r1, double r2) {
  const double r = std::min(r1, r2);
  return kPi * r * r * m.effective_modulus / (r1 + r2);
}

/// A floor with its top at z = 0 (closed box).
inline void add_floor(RockWorld& world, const Surface& surface, double half_width = 50) {
  world.add_mesh(make_box({-half_width, -half_width, -5}, {half_width, half_width, 0}), surface,
                 Motion::fixed(Pose{}));
}

}  // namespace scree::verification
