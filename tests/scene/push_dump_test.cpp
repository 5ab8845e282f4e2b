// A small load pushed over the crest of a small bench.
#include <gtest/gtest.h>

#include <algorithm>

#include "scree_version.h"
#include "sim/scene/run.h"

namespace scree {
namespace {

Scenario small_push(const std::vector<std::string>& more = {}) {
  const std::filesystem::path source = SCREE_SOURCE_DIR;
  std::vector<std::string> overrides{"experiment.payload_t=20",
                                     "experiment.dumps=1",
                                     "experiment.load_box_m=[4, 4, 3]",
                                     "experiment.bench.height_m=4",
                                     "experiment.bench.width_m=30",
                                     "experiment.bench.top_length_m=12",
                                     "experiment.bench.floor_length_m=25",
                                     "experiment.blade.velocity_m_per_s=0.6"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  const ScenarioResult loaded =
      load_scenario(source / "scenarios" / "thesis" / "d2.yaml", overrides, source / "assets");
  EXPECT_TRUE(loaded.errors.empty()) << loaded.errors.front().text();
  return loaded.scenario;
}

double mass_behind(const RunOutcome& outcome, double x) {
  double mass = 0;
  for (const Grain& grain : outcome.final_state.grains)
    if (grain.position.x() < x) mass += grain.mass;
  return mass;
}

TEST(PushDump, BladeSweepsTheLoadOverTheCrest) {
  const RunOutcome outcome = run_scenario(small_push(), 1, 1, {});
  EXPECT_TRUE(outcome.at_rest);
  EXPECT_EQ(outcome.statistics.lost_particles, 0);
  double mass = 0;
  for (const Grain& grain : outcome.original) {
    mass += grain.mass;
    EXPECT_TRUE(grain.position.x() < 0 && grain.position.x() > -4 &&
                grain.position.z() > 4.5);  // on balls of 1 m
  }
  EXPECT_NEAR(mass, 20e3, 0.005 * 20e3);
  // What is left behind lies between the balls of the bench top.
  for (const Grain& grain : outcome.final_state.grains) {
    if (grain.position.x() > -0.5) continue;
    EXPECT_LT(grain.position.z() - 0.5 * grain.diameter, 4 + 0.5);
  }
  EXPECT_LT(mass_behind(outcome, -0.5), 0.1 * mass);
}

TEST(PushDump, BladeThatStopsEarlyLeavesTheLoadOnTheBench) {
  const RunOutcome over = run_scenario(small_push(), 1, 1, {});
  const RunOutcome early =
      run_scenario(small_push({"experiment.distance_m=4", "experiment.blade.overshoot_m=-4"}), 1, 1, {});
  EXPECT_GT(mass_behind(early, -0.5), 0.3 * 20e3);
  EXPECT_GT(mass_behind(early, -0.5), 3 * mass_behind(over, -0.5));
}

TEST(PushDump, LoadsFollowOneAnotherAtTheirPoints) {
  const RunOutcome outcome =
      run_scenario(small_push({"experiment.dumps=2", "experiment.points_m=[-6, 6]"}), 1, 2, {});
  for (const Grain& grain : outcome.original) EXPECT_NEAR(grain.position.y(), grain.dump == 1 ? -6 : 6, 2);
  double left = 0, right = 0;
  for (const Grain& grain : outcome.final_state.grains)
    (grain.dump == 1 ? left : right) += grain.mass * grain.position.y();
  EXPECT_NEAR(left / 20e3, -6, 1.5);
  EXPECT_NEAR(right / 20e3, 6, 1.5);
}

}  // namespace
}  // namespace scree
