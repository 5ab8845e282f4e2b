// A platform that shakes, seen from itself.
#include "sim/effects/effect.h"
#include "tests/verification/scene.h"

namespace scree::verification {
namespace {

constexpr double kRadius = 0.05;

WorldSettings shaken(double amplitude, double frequency, double dt) {
  const EffectUse use{find_effect("vibration"), {amplitude, frequency}};
  WorldSettings settings = undamped(dt);
  settings.vibration = modifications(std::span(&use, 1), {}).vibration;
  return settings;
}

// In flight v = -g t - a g (1 - cos wt) / w, z = -g t^2 / 2 - a g (t / w - sin wt / w^2).
TEST(Vibration, FlightIsThatOfASwingingGravity) {
  const double a = 0.7, f = 3, w = 2 * kPi * f, t = 0.9;
  RrlinearWorld world(shaken(a, f, 1e-4));
  world.add_spheres({ball({0, 0, 0}, kRadius)});
  world.advance_to(t);
  EXPECT_NEAR(velocity_of(world, 0).z(), -kGravity * t - a * kGravity * (1 - std::cos(w * t)) / w, 2e-3);
  EXPECT_NEAR(place_of(world, 0).z(),
              -kGravity * t * t / 2 - a * kGravity * (t / w - std::sin(w * t) / (w * w)), 2e-3);
}

// A sphere on the platform leaves it when the acceleration passes gravity, and not before. At a = 1.5 it
// takes off when sin wt = -1 / a; up to then it lies still.
TEST(Vibration, RockLeavesThePlatformAboveGravity) {
  const double f = 2, w = 2 * kPi * f;
  for (const double a : {0.9, 1.5}) {
    WorldSettings settings = shaken(a, f, 2e-5);
    settings.material.local_damping = 0.2;
    settings.sleep = true;  // must not hide it
    RrlinearWorld world(settings);
    add_floor(world, {0.3, 0.3});
    const double overlap =
        ball_mass(settings.material, kRadius) * kGravity / wall_stiffness(settings.material, kRadius);
    world.add_spheres({ball({0, 0, kRadius - overlap}, kRadius)});
    const double takes_off = (kPi + std::asin(1 / a)) / w;
    double highest = -1, left = 0;
    for (double t = 0; t < 1 / f; t += 1e-3) {
      world.advance_to(t);
      highest = std::max(highest, place_of(world, 0).z() - kRadius);
      if (left == 0 && highest > 0) left = t;
    }
    if (a < 1) {
      EXPECT_LT(highest, 0);
    } else {
      EXPECT_NEAR(left, takes_off, 5e-3);
      EXPECT_GT(highest, 0.01 * kRadius);
    }
  }
}

// What lies still presses with m g (1 + a sin wt): slow swings move the overlap with it.
TEST(Vibration, LoadOnTheFloorSwings) {
  const double a = 0.5, f = 0.5;
  WorldSettings settings = shaken(a, f, 2e-5);
  settings.material.local_damping = 0.4;
  RrlinearWorld world(settings);
  add_floor(world, {0.3, 0.3});
  const double overlap =
      ball_mass(settings.material, kRadius) * kGravity / wall_stiffness(settings.material, kRadius);
  world.add_spheres({ball({0, 0, kRadius - overlap}, kRadius)});
  for (const double t : {0.5, 1.5}) {
    world.advance_to(t);
    const double expected = overlap * (1 + a * std::sin(2 * kPi * f * t));
    EXPECT_NEAR(kRadius - place_of(world, 0).z(), expected, 0.02 * overlap) << t;
  }
}

// The scheme follows the swing whatever the stable step: free spheres have none.
TEST(Vibration, StepFollowsTheSwing) {
  WorldSettings settings = shaken(1, 50, 0);
  RrlinearWorld world(settings);
  world.add_spheres({ball({0, 0, 0}, 5)});
  world.advance_to(0.1);
  EXPECT_LE(world.statistics().time_step_max, 0.02 / 50 * (1 + 1e-9));
}

}  // namespace
}  // namespace scree::verification
