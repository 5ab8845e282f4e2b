// What makes a run one that does not count.
#include "sim/scene/watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "scree_version.h"

namespace scree {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

RunOutcome small_dump() {
  const std::string source = SCREE_SOURCE_DIR;
  ScenarioResult loaded =
      load_scenario(source + "/scenarios/quick_dump.yaml",
                    {"experiment.payload_t=5", "experiment.bench.height_m=3", "experiment.bench.width_m=30",
                     "experiment.bench.top_length_m=10", "experiment.bench.floor_length_m=15"},
                    source + "/assets");
  return run_scenario(loaded.scenario, 10001, 1, {});
}

TEST(Watch, DumpCountsAndEachTermOfItsBalanceIsNeeded) {
  const RunOutcome good = small_dump();
  EXPECT_THAT(watch_failures(good), IsEmpty());

  for (double EnergyLosses::*term :
       {&EnergyLosses::sliding, &EnergyLosses::rolling, &EnergyLosses::local_damping}) {
    RunOutcome tampered = good;
    tampered.energy->account.losses.*term = 0;
    EXPECT_THAT(watch_failures(tampered), ElementsAre(HasSubstr("energy balance is open")));
  }
  RunOutcome tampered = good;
  tampered.energy->account.came_potential *= 0.98;
  EXPECT_THAT(watch_failures(tampered), ElementsAre(HasSubstr("energy balance is open")));
  tampered.energy->account.came_potential = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(watch_failures(tampered), ElementsAre(HasSubstr("energy balance is open")));
}

TEST(Watch, NoNumberIsAFailure) {
  RunOutcome outcome;
  outcome.final_state.grains.emplace_back();
  outcome.final_state.grains.back().mass = 1;
  EXPECT_THAT(watch_failures(outcome), IsEmpty());
  outcome.final_state.grains.back().velocity.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(watch_failures(outcome), ElementsAre(HasSubstr("no finite place")));
}

TEST(Watch, LostRockIsAFailureAboveItsShare) {
  RunOutcome outcome;
  outcome.final_state.grains.emplace_back();
  outcome.final_state.grains.back().mass = 1000;
  outcome.statistics.lost_mass = 9;
  EXPECT_THAT(watch_failures(outcome), IsEmpty());
  outcome.statistics.lost_mass = 11;
  EXPECT_THAT(watch_failures(outcome), ElementsAre(HasSubstr("1.09 % of the mass left")));
}

// Rock that leaves takes energy along: what is missing then says nothing of the time step, what came out of
// nothing does.
TEST(Watch, LostRockExplainsMissingEnergyAlone) {
  RunOutcome outcome;
  outcome.final_state.grains.emplace_back();
  outcome.final_state.grains.back().mass = 1000;
  outcome.energy.emplace();
  outcome.energy->account.came_potential = 100;  // J put in, and none of it there: 100 % are missing
  outcome.statistics.lost_mass = 9;
  EXPECT_THAT(watch_failures(outcome), ElementsAre(HasSubstr("open by -100.00 %")));
  outcome.statistics.lost_mass = 500;
  EXPECT_THAT(watch_failures(outcome), ElementsAre(HasSubstr("of the mass left the model")));
  outcome.energy->held.kinetic = 150;
  EXPECT_THAT(watch_failures(outcome),
              ElementsAre(HasSubstr("open by +50.00 %"), HasSubstr("of the mass left the model")));
}

}  // namespace
}  // namespace scree
