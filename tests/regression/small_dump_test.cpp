// Small dumps, run to their end: segregation has its sign, nothing is lost, the bed is empty, a tool that
// starts late moves rock that sleeps.
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/pile/segregation.h"
#include "scree_version.h"
#include "sim/scene/run.h"
#include "sim/scene/scenario.h"

namespace scree {
namespace {

const std::filesystem::path kSource = SCREE_SOURCE_DIR;

Scenario scenario_of(const char* file, std::vector<std::string> overrides) {
  for (const char* common : {"experiment.bench.width_m=40", "experiment.bench.floor_length_m=30",
                             "experiment.bench.top_length_m=15"})
    overrides.emplace_back(common);
  ScenarioResult loaded = load_scenario(kSource / "scenarios" / file, overrides, kSource / "assets");
  for (const ScenarioError& error : loaded.errors) ADD_FAILURE() << error.text();
  return loaded.scenario;
}

void expect_segregated(const Scenario& scenario) {
  const RunOutcome outcome = run_scenario(scenario, 10001, 1, {});
  const double height = std::get<EndDump>(scenario.experiment).bench.height;
  EXPECT_TRUE(outcome.at_rest);
  EXPECT_EQ(outcome.statistics.lost_particles, 0);
  EXPECT_EQ(outcome.final_state.grains.size(), outcome.original.size());
  for (const Grain& grain : outcome.final_state.grains) {
    // The bed stood with its lip 1.5 m above the crest: what is higher than the heap at the crest hangs in
    // the air.
    EXPECT_LT(grain.position.z(), height + 1.5);
    EXPECT_GT(grain.position.z(), -0.01);
  }
  const SectionTable table = analyse_sections(outcome.final_state.grains, outcome.original, height, 6);
  EXPECT_LT(table.sections.front().chi, -0.2) << "fine at the crest";
  EXPECT_GT(table.sections.back().chi, 0.2) << "coarse at the toe";
}

TEST(SmallDump, OpenedGateSegregates) {
  expect_segregated(scenario_of("quick_dump.yaml", {}));
}

TEST(SmallDump, HoistedBedSegregates) {
  expect_segregated(scenario_of("hoist_dump.yaml",
                                {"experiment.dumps=1", "experiment.payload_t=60", "output.after_dumps=[]"}));
}

TEST(SmallDump, BladePushesRockThatSleeps) {
  // The blade stands still for 20 s, while the heap at the crest falls asleep, and then moves over the crest.
  const Scenario scenario = scenario_of("user_mesh_tool.yaml", {"experiment.truck.setback_m=9"});
  const RunOutcome outcome = run_scenario(scenario, 10001, 1, {});
  EXPECT_TRUE(outcome.at_rest);
  // The blade is 8 m wide. Nothing of some size stays in its way.
  int behind = 0;
  for (const Grain& grain : outcome.final_state.grains)
    if (std::abs(grain.position.y()) < 3 && grain.position.x() > -7 && grain.position.x() < -2.0 &&
        grain.diameter > 0.5)
      ++behind;
  EXPECT_EQ(behind, 0);
}

}  // namespace
}  // namespace scree
