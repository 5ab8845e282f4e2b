// A ball pushed along a level floor. (A sliding block, v^2 / (2 mu g), cannot be made of one sphere: a sphere
// rolls.)
#include "tests/verification/scene.h"

namespace scree::verification {
namespace {

constexpr double kRadius = 0.5;

// Density for a mass of 1 kg, and a ball at its overlap of rest.
WorldSettings light_ball(double dt) {
  WorldSettings s = undamped(dt);
  s.material.density = 1.0 / (4.0 / 3 * kPi * std::pow(kRadius, 3));
  return s;
}

NewSphere pushed(const Material& m, double speed, double spin) {
  const double overlap = kGravity / wall_stiffness(m, kRadius);  // m = 1 kg
  return ball({0, 0, kRadius - overlap}, kRadius, {speed, 0, 0}, {0, spin, 0});
}

// Ai et al., Powder Technology 206 (2011), test 1: r 0.5 m, m 1 kg, mu 0.3, mu_r 0.2, pushed at 1 m/s without
// spin: rotation has ended within 1 s. The rolling resistance is a spring, so some damping is needed to end
// it.
TEST(Rolling, PushedBallStops) {
  WorldSettings settings = light_ball(1e-4);
  settings.material.local_damping = 0.1;
  RrlinearWorld world(settings);
  world.add_spheres({pushed(settings.material, 1.0, 0)});
  add_floor(world, {0.3, 0.2});
  world.advance_to(0.2);
  EXPECT_GT(spin_of(world, 0).y(), 0.5);
  world.advance_to(1.0);
  for (int k = 0; k < 100; ++k) {
    step(world);
    EXPECT_LT(spin_of(world, 0).norm(), 1e-3);
  }
}

// Rolling without slip with the rolling slider saturated: omega' = -5 mu_r g / (7 r).
TEST(Rolling, DecayRate) {
  const double mu_r = 0.2, speed = 4.0;
  RrlinearWorld world(light_ball(2e-5));
  const Material& m = world.settings().material;
  world.add_spheres({pushed(m, speed, speed / kRadius)});
  add_floor(world, {0.3, mu_r});
  double x[3];
  for (int k = 0; k < 3; ++k) {
    world.advance_to(0.2 + 0.5 * k);
    x[k] = place_of(world, 0).x();
  }
  const double rate = (x[2] - 2 * x[1] + x[0]) / 0.25 / kRadius;
  const double expected = -5 * mu_r * kGravity / (7 * kRadius);
  // Lever r - u/2, and the swing of the shear spring (amplitude a / w^2 at 4 a / (w span)^2).
  EXPECT_NEAR(rate, expected, 2e-4 * std::abs(expected));
}

// Angular momentum about the contact is kept while friction acts there: u = 5/7 u0 whatever mu.
TEST(Rolling, SlippingEndsAtFiveSeventhsOfTheSpeed) {
  for (const double mu : {0.1, 0.5}) {
    RrlinearWorld world(light_ball(2e-5));
    world.add_spheres({pushed(world.settings().material, 1.0, 0)});
    add_floor(world, {mu, 0});
    world.advance_to(0.5);
    const double x = place_of(world, 0).x();
    world.advance_to(1.5);
    // The undamped shear spring swings on; its mean over 1 s is off by twice its amplitude, mu g k* / w^2.
    EXPECT_NEAR(place_of(world, 0).x() - x, 5.0 / 7, 1e-4);
  }
}

}  // namespace
}  // namespace scree::verification
