// A ball on an incline. The plane stays level and gravity is tilted.
#include "tests/verification/scene.h"

namespace scree::verification {
namespace {

constexpr double kRadius = 0.5;
const double kTilt = 20 * kPi / 180;

// Stiff, so that the lever r - u/2 differs from r by a share of 1e-5; placed at the overlap of rest.
WorldSettings incline(double alpha) {
  WorldSettings s = undamped(2e-5);
  s.material.effective_modulus = 1e9;
  s.material.local_damping = alpha;
  s.gravity = kGravity * Vec3(std::sin(kTilt), 0, -std::cos(kTilt));
  return s;
}

NewSphere ball_at_rest(const Material& m) {
  const double overlap = ball_mass(m, kRadius) * kGravity * std::cos(kTilt) / wall_stiffness(m, kRadius);
  return ball({0, 0, kRadius - overlap}, kRadius);
}

// Acceleration along x by second differences of the place over two spans: the undamped springs of shear and
// rolling swing about the mean motion with amplitude a / w^2, which leaves 4 a / (w span)^2 in the quotient,
// and a constant velocity drops out.
double acceleration(RockWorld& world, double span) {
  double x[3];
  for (int k = 0; k < 3; ++k) {
    world.advance_to((k + 0.2) * span);
    x[k] = place_of(world, 0).x();
  }
  return (x[2] - 2 * x[1] + x[0]) / (span * span);
}

// Ai et al., Powder Technology 206 (2011): held by rolling resistance while mu_r >= tan t (and mu >= tan t).
TEST(Incline, BallStaysAtRestBelowTheRollingLimit) {
  RrlinearWorld world(incline(0.4));
  world.add_spheres({ball_at_rest(world.settings().material)});
  add_floor(world, {1.0, 1.05 * std::tan(kTilt)});
  world.advance_to(0.5);
  const Vec3 settled = place_of(world, 0);
  world.advance_to(5.0);
  EXPECT_LT((place_of(world, 0) - settled).norm(), 1e-9 * kRadius);
  // Loaded at once, springs reach twice their deflection of rest at most; slipping of the rolling spring adds
  // as much.
  const double deflection = 2 * ball_mass(world.settings().material, kRadius) * kGravity * std::sin(kTilt) *
                            world.settings().material.stiffness_ratio /
                            wall_stiffness(world.settings().material, kRadius);
  EXPECT_LT(settled.x(), 4 * deflection);
}

// Without local damping: it takes alpha |F| of forces that swing about a small mean, and would hold the ball
// by itself.
TEST(Incline, BallRollsJustAboveTheLimit) {
  RrlinearWorld world(incline(0));
  world.add_spheres({ball_at_rest(world.settings().material)});
  add_floor(world, {1.0, 0.95 * std::tan(kTilt)});
  world.advance_to(1.0);
  // Over 1 s: 5/7 g sin t (1 - 0.95); half of it is asked for.
  EXPECT_GT(velocity_of(world, 0).x(), 0.5 * 5.0 / 7 * kGravity * std::sin(kTilt) * 0.05);
}

// a = 5/7 g (sin t - mu_r cos t) without slip.
TEST(Incline, RollingAcceleration) {
  for (const double mu_r : {0.0, 0.1, 0.3}) {
    RrlinearWorld world(incline(0));
    world.add_spheres({ball_at_rest(world.settings().material)});
    add_floor(world, {0.8, mu_r});
    const double expected = 5.0 / 7 * kGravity * (std::sin(kTilt) - mu_r * std::cos(kTilt));
    EXPECT_NEAR(acceleration(world, 0.5), expected, 1e-3 * expected) << mu_r;
  }
}

// Rolling needs friction 2/7 sin t + 5/7 mu_r cos t (in m g): it slips when mu < 2/7 (tan t - mu_r) + mu_r.
TEST(Incline, SlipsBelowTheFrictionThatRollingNeeds) {
  const double mu_r = 0.1, needed = 2.0 / 7 * (std::tan(kTilt) - mu_r) + mu_r;
  {
    RrlinearWorld world(incline(0));
    world.add_spheres({ball_at_rest(world.settings().material)});
    add_floor(world, {1.05 * needed, mu_r});
    const double expected = 5.0 / 7 * kGravity * (std::sin(kTilt) - mu_r * std::cos(kTilt));
    EXPECT_NEAR(acceleration(world, 0.5), expected, 1e-3 * expected);
  }
  RrlinearWorld world(incline(0));
  world.add_spheres({ball_at_rest(world.settings().material)});
  const double mu = 0.95 * needed;
  add_floor(world, {mu, mu_r});
  world.advance_to(0.1);
  const double v0 = velocity_of(world, 0).x();
  world.advance_to(1.1);
  // Sliding friction is mu Fn in every step: no swing, a to rounding of the weight on the plane.
  EXPECT_NEAR(velocity_of(world, 0).x() - v0, kGravity * (std::sin(kTilt) - mu * std::cos(kTilt)), 1e-6);
}

}  // namespace
}  // namespace scree::verification
