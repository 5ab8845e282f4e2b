// The stable step follows the contacts that a sphere has.
#include <algorithm>
#include <cmath>

#include "tests/verification/scene.h"

namespace scree::verification {
namespace {

// Between six equal spheres on its axes a sphere has, along each, two springs kn and four ks; about each,
// four contacts turn it with ks R^2 + kr, kr = ks (R / 2)^2. The step is 0.8 of the smaller of sqrt(m / k)
// and sqrt(I / k_rot), below that of a sphere in flight, which expects one contact.
TEST(TimeStep, IsThatOfTheContactsOfASphere) {
  WorldSettings settings;
  settings.sleep = false;
  const Material& m = settings.material;
  const double radius = 0.5, overlap = 0.02 * radius, apart = 2 * radius - overlap;
  RrlinearWorld world(settings);
  std::vector<NewSphere> spheres{ball(Vec3::Zero(), radius)};
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-apart, apart}) {
      Vec3 at = Vec3::Zero();
      at[axis] = side;
      spheres.push_back(fixed_ball(at, radius));
    }
  world.add_spheres(spheres);
  const double kn = pair_stiffness(m, radius, radius), ks = kn / m.stiffness_ratio;
  const double mass = ball_mass(m, radius), inertia = 0.4 * mass * radius * radius;
  const double turning = ks * radius * radius + ks * radius * radius / 4;
  const double expected =
      settings.time_step_safety * std::sqrt(std::min(mass / (2 * kn + 4 * ks), inertia / (4 * turning)));
  world.advance_to(20 * expected);
  EXPECT_NEAR(world.statistics().time_step_max, expected, 1e-3 * expected);
}

// A small sphere that blocks press from all sides: the contact halves an overlap u, so that forces act on it
// at a lever of u / 2 - r, longer than its radius from u = 4 r on.
TEST(TimeStep, IsThatOfTheLeversOfDeepOverlaps) {
  const double radius = 0.05, block = 1;
  for (const double depth : {3.0, 6.0, 8.0, 10.0}) {  // overlap over the small radius
    WorldSettings settings = weightless(0);
    settings.fixed_time_step = 0;
    settings.material = {};
    settings.sleep = false;
    RrlinearWorld world(settings);
    std::vector<NewSphere> spheres{ball(Vec3::Zero(), radius, Vec3::Zero(), {1e-3, 2e-3, 3e-3})};
    const double apart = block + radius - depth * radius, golden = std::numbers::phi;
    for (int axis = 0; axis < 3; ++axis)  // an icosahedron
      for (const double first : {-1.0, 1.0})
        for (const double second : {-golden, golden}) {
          Vec3 at = Vec3::Zero();
          at[axis] = first, at[(axis + 1) % 3] = second;
          spheres.push_back(fixed_ball(apart * at.normalized(), block));
        }
    world.add_spheres(spheres);
    ASSERT_NO_THROW(world.advance_to(2)) << depth;
    EXPECT_LT(std::abs(world.energy_balance()->relative_error()), 0.01) << depth;
  }
}

// Restitution of a dashpot that never pulls (Schwager & Poeschel 2007, eq. 21), b its share of critical
// damping.
double restitution(double b) {
  if (b < 1) {
    const double root = std::sqrt(1 - b * b);
    return std::exp(-b / root * std::atan2(2 * b * root, 2 * b * b - 1));
  }
  if (b == 1) return std::exp(-2.0);
  const double root = std::sqrt(b * b - 1);
  return std::exp(-b / root * std::log((b + root) / (b - root)));
}

// What two equal spheres leave of the speed at which they meet, at the step that the engine takes: mean over
// places between two steps where they first touch.
double simulated_restitution(double b) {
  constexpr int kPlaces = 20;
  constexpr double kRadius = 0.1, kSpeed = 0.5;
  double sum = 0;
  for (int k = 0; k < kPlaces; ++k) {
    WorldSettings settings = weightless(0);
    settings.material.normal_damping_ratio = b;
    settings.sleep = false;
    RrlinearWorld world(settings);
    const double apart = 1.5 * kRadius + 0.01 * kRadius * k;
    world.add_spheres(
        {ball({-apart, 0, 0}, kRadius, {kSpeed, 0, 0}), ball({apart, 0, 0}, kRadius, {-kSpeed, 0, 0})});
    world.advance_to(1);
    sum += velocity_of(world, 1).x() / kSpeed / kPlaces;
  }
  return sum;
}

// The dashpot sees the velocity half a step late. The engine shortens its step, so that what it says of any
// damping is within a twentieth of the speed of theory, and more damping is more.
TEST(TimeStep, DashpotsShortenIt) {
  double before = 1;
  for (const double b : {0.1, 0.3, 0.5, 0.8, 1.0, 1.5, 2.0}) {
    const double e = simulated_restitution(b);
    EXPECT_NEAR(e, restitution(b), 0.05) << b;
    EXPECT_LT(e, before) << b;
    before = e;
  }
}

}  // namespace
}  // namespace scree::verification
