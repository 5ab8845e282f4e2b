// The second engine behind the same interface.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/world/rock_world.h"
#include "tests/world/ball.h"

namespace scree {
namespace {

constexpr double kGravity = 9.81, kRadius = 0.5;

void add_floor(RockWorld& world, const Surface& surface) {
  world.add_mesh(make_box({-20, -20, -2}, {20, 20, 0}), surface, Motion::fixed(Pose{}));
}

TEST(ImpulseWorld, BallFallsAndRestsOnTheFloor) {
  WorldSettings settings;
  settings.material.local_damping = 0;
  const auto world = make_impulse_world(settings);
  world->add_spheres({ball({0, 0, kRadius + 1.0}, kRadius)});
  add_floor(*world, {0.44, 0.44});
  world->advance_to(0.4);
  // Semi-implicit Euler from rest: v = g t, place late by g t dt / 2.
  EXPECT_NEAR(world->snapshot().grains[0].velocity.z(), -kGravity * 0.4, 1e-6);
  EXPECT_NEAR(world->snapshot().grains[0].position.z(), kRadius + 1 - 0.5 * kGravity * 0.16,
              kGravity * 0.4 * 1e-3);
  world->advance_to(3.0);
  // Bullet leaves spheres within its slop of the surface: 2 % of the radius is asked for.
  EXPECT_NEAR(world->snapshot().grains[0].position.z(), kRadius, 0.02 * kRadius);
  EXPECT_LT(world->snapshot().grains[0].velocity.norm(), 1e-3);
  EXPECT_EQ(world->statistics().lost_particles, 0);
}

TEST(ImpulseWorld, LocalDampingActsInFlight) {
  WorldSettings settings;
  settings.material.local_damping = 0.4;
  const auto world = make_impulse_world(settings);
  world->add_spheres({ball({0, 0, 10}, kRadius)});
  world->advance_to(0.5);
  EXPECT_NEAR(world->snapshot().grains[0].velocity.z(), -0.6 * kGravity * 0.5, 1e-3);
}

double speed_on_incline(double mu, double mu_r, double tilt) {
  WorldSettings settings;
  settings.material.local_damping = 0;
  settings.gravity = kGravity * Vec3(std::sin(tilt), 0, -std::cos(tilt));
  const auto world = make_impulse_world(settings);
  world->add_spheres({ball({0, 0, kRadius}, kRadius)});
  add_floor(*world, {mu, mu_r});
  world->advance_to(1.0);
  return world->snapshot().grains[0].velocity.x();
}

// Bullet's friction is a cone only roughly and its contact has a slop: 10 % is asked for.
TEST(ImpulseWorld, RollsOrRestsOnAnIncline) {
  const double tilt = 20 * std::numbers::pi / 180;
  EXPECT_LT(std::abs(speed_on_incline(0.8, 1.3 * std::tan(tilt), tilt)), 0.02);
  for (const double mu_r : {0.0, 0.15}) {
    const double expected = 5.0 / 7 * kGravity * (std::sin(tilt) - mu_r * std::cos(tilt));  // over 1 s
    EXPECT_NEAR(speed_on_incline(0.8, mu_r, tilt), expected, 0.1 * expected) << mu_r;
  }
  const double sliding = kGravity * (std::sin(tilt) - 0.05 * std::cos(tilt));
  EXPECT_NEAR(speed_on_incline(0.05, 0, tilt), sliding, 0.1 * sliding);
}

TEST(ImpulseWorld, LostSphereIsCounted) {
  WorldSettings settings;
  settings.domain_low = {-10, -10, -10};
  const auto world = make_impulse_world(settings);
  world->add_spheres({ball({0, 0, 0}, kRadius), ball({5, 0, 1000}, kRadius)});
  world->advance_to(3.0);
  EXPECT_EQ(world->statistics().lost_particles, 1);
  EXPECT_EQ(world->snapshot().grains.size(), 1u);
  EXPECT_EQ(world->snapshot().grains[0].id, 1);
}

TEST(ImpulseWorld, FixedBallsStayAndCarry) {
  WorldSettings settings;
  const auto world = make_impulse_world(settings);
  NewSphere base = ball({0, 0, 0}, kRadius);
  base.fixed = true;
  base.dump = 0;
  world->add_spheres({ball({0, 0, 2 * kRadius + 0.1}, kRadius), base});
  world->advance_to(1.0);
  EXPECT_EQ(world->fixed_balls().size(), 1u);
  EXPECT_EQ(world->fixed_balls()[0].position, Vec3::Zero());
  EXPECT_NEAR(world->snapshot().grains[0].position.z(), 2 * kRadius, 0.04 * kRadius);
}

// Balls of a base layer come first and stay there: rock is told from them by what it is, not by its place.
TEST(ImpulseWorld, FixedBallsAreNoRock) {
  WorldSettings settings;
  const auto world = make_impulse_world(settings);
  std::vector<NewSphere> base, rock;
  for (int k = 0; k < 10; ++k) {
    base.push_back(ball({2.0 * k, 0, 0}, kRadius));
    base.back().fixed = true;
    base.back().dump = 0;
  }
  for (int k = 0; k < 6; ++k) rock.push_back(ball({2.0 * k, 0, 2 * kRadius + 0.1}, kRadius));
  world->add_spheres(base);
  world->add_spheres(rock);
  world->advance_to(0.1);
  const double one = sphere_mass(settings.material, 2 * kRadius);
  const auto everywhere = [](const Vec3&) { return true; };
  EXPECT_NEAR(world->mass(), 6 * one, 1e-9 * one);
  EXPECT_NEAR(world->mass_of(everywhere), 6 * one, 1e-9 * one);
  EXPECT_EQ(world->moving_mass_share(0.1), 1) << "all fall";
  EXPECT_NEAR(world->take_out([](const Vec3& place) { return place.x() < 3; }), 2 * one, 1e-9 * one);
  EXPECT_NEAR(world->mass(), 4 * one, 1e-9 * one);
  EXPECT_EQ(world->fixed_balls().size(), 10u);
}

// Bullet pairs what is nearer than 5 cm unless told otherwise: each of these with hundreds.
TEST(ImpulseWorld, SmallSpheresArePairedWithTheirNeighboursAlone) {
  WorldSettings settings;
  settings.smallest_diameter = 0.008;
  const auto world = make_impulse_world(settings);
  std::vector<NewSphere> spheres;
  for (int i = 0; i < 1000; ++i)
    spheres.push_back(ball({0.009 * (i % 10), 0.009 * (i / 10 % 10), 0.005 + 0.009 * (i / 100)}, 0.004));
  world->add_spheres(spheres);
  add_floor(*world, {0.4, 0.4});
  world->advance_to(0.02);
  EXPECT_LT(world->getPairCache()->getNumOverlappingPairs(), 15 * 1000);
}

}  // namespace
}  // namespace scree
