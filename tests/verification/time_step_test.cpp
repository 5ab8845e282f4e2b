// The stable step follows the contacts that a sphere has.
#include <algorithm>

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

}  // namespace
}  // namespace scree::verification
