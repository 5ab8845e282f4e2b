// Two small buckets emptied along a wall.
#include <gtest/gtest.h>

#include <numeric>

#include "scree_version.h"
#include "sim/scene/run.h"

namespace scree {
namespace {

TEST(BucketDump, RockFallsInFrontOfTheWallAndBucketsFollowOneAnother) {
  const std::filesystem::path source = SCREE_SOURCE_DIR;
  const ScenarioResult loaded =
      load_scenario(source / "scenarios" / "thesis" / "lab_segregation.yaml",
                    {"grading=Lab0_16mm", "experiment.buckets=2", "experiment.mass_kg=6"}, source / "assets");
  ASSERT_TRUE(loaded.errors.empty()) << loaded.errors.front().text();
  const RunOutcome outcome = run_scenario(loaded.scenario, 1, 1, {});
  EXPECT_TRUE(outcome.at_rest);
  EXPECT_EQ(outcome.statistics.lost_particles, 0);
  double first = 0, second = 0;
  for (const Grain& grain : outcome.original) {
    (grain.dump == 1 ? first : second) += grain.mass;
    // In the bucket: its mouth at the edge of the wall of 1 m, its bottom 0.3 m behind at 60 degrees.
    EXPECT_GT(grain.position.z(), 0.95);
    EXPECT_LT(grain.position.z(), 1.0 + 0.3 + 0.27);
    EXPECT_LT(grain.position.x(), 0.27);
  }
  EXPECT_NEAR(first, 6, 0.03);
  EXPECT_NEAR(second, 6, 0.03);
  double mass = 0;
  for (const Grain& grain : outcome.final_state.grains) {
    mass += grain.mass;
    EXPECT_GT(grain.position.x(), 0.3 * grain.diameter);  // none in the wall, none left on it
    EXPECT_LT(grain.position.z(), 0.5);
  }
  EXPECT_NEAR(mass, 12, 0.06);
}

// Rock that is still in a bucket when all is at rest, as it sticks or as the heap holds it back, falls in
// front of the wall when the bucket is lifted, or leaves with it.
TEST(BucketDump, WhatIsLeftInABucketDoesNotFallOnTheWall) {
  const std::filesystem::path source = SCREE_SOURCE_DIR;
  const std::vector<std::string> small{"grading=Lab0_16mm", "experiment.buckets=2", "experiment.mass_kg=6"};
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"effects.sticky_tools.bond_number=3"},
        std::vector<std::string>{"experiment.floor.wall_height_m=0.1", "material.mu=0.5",
                                 "material.mu_r=0.5"}}) {
    std::vector<std::string> overrides = small;
    overrides.insert(overrides.end(), more.begin(), more.end());
    const ScenarioResult loaded =
        load_scenario(source / "scenarios" / "thesis" / "lab_segregation.yaml", overrides, source / "assets");
    ASSERT_TRUE(loaded.errors.empty()) << loaded.errors.front().text();
    const RunOutcome outcome = run_scenario(loaded.scenario, 1, 1, {});
    double on_wall = 0, mass = 0;
    for (const Grain& grain : outcome.final_state.grains) {
      mass += grain.mass;
      if (grain.position.x() < 0) on_wall += grain.mass;
    }
    // A heap as high as the wall spills over it: six seeds have 0 to 2.2 % there.
    EXPECT_LT(on_wall, 0.03 * mass) << more.front();
    EXPECT_NEAR(mass + outcome.carried_back + outcome.statistics.lost_mass, 12, 0.06) << more.front();
  }
}

}  // namespace
}  // namespace scree
