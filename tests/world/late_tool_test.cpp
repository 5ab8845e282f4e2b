// A tool that begins to move long after the rock before it fell asleep.
#include <gtest/gtest.h>

#include "sim/world/rrlinear_world.h"

namespace scree {
namespace {

struct Late {
  double speed, radius;  // m/s, m
};
class LateTool : public testing::TestWithParam<Late> {};

TEST_P(LateTool, PushesSleepersBeforeIt) {
  const auto [speed, radius] = GetParam();
  WorldSettings settings;
  settings.sleep = true;
  RrlinearWorld world(settings);
  world.add_mesh(make_box({-10, -5, -1}, {20, 5, 0}), {0.44, 0.44}, Motion());
  const auto at = [&, radius = radius](double x) { return Pose{{x, 0, 0.2 * radius}, Quaternion::Identity()}; };
  world.add_mesh(make_box({-0.5, -2, 0}, {0, 2, 1}), {0.44, 0.44},
                 Motion({{0.0, at(-3)}, {10.0, at(-3)}, {10.0 + 6.0 / speed, at(3)}}));
  std::vector<NewSphere> balls;
  for (const double x : {-2.0, 0.0, 1.0, 2.0}) balls.push_back({{x, 0, radius}, 2 * radius, 1});
  world.add_spheres(balls);
  world.advance_to(9.0);
  ASSERT_EQ(world.statistics().asleep, 4);
  world.advance_to(10.0 + 6.0 / speed);
  // The face of the blade stands at x = 3: every centre is in front of it.
  for (const Grain& grain : world.snapshot().grains) EXPECT_GT(grain.position.x(), 3.0);
  EXPECT_EQ(world.statistics().squeezed_into_walls, 0);
}

INSTANTIATE_TEST_SUITE_P(Speeds, LateTool,
                         testing::Values(Late{0.3, 0.05}, Late{0.6, 0.05}, Late{2.0, 0.05}, Late{4.0, 0.05},
                                         Late{0.3, 0.004}));

}  // namespace
}  // namespace scree
