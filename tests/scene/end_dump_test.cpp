// Truck loads: what stays in the bed, and tools that move beside them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

#include "scree_version.h"
#include "sim/io/state_stream.h"
#include "sim/scene/run.h"

namespace scree {
namespace {

RunOutcome run(const char* file, const std::vector<std::string>& overrides) {
  const std::filesystem::path source = SCREE_SOURCE_DIR;
  const ScenarioResult loaded = load_scenario(source / "scenarios" / file, overrides, source / "assets");
  for (const ScenarioError& error : loaded.errors) ADD_FAILURE() << error.text();
  return run_scenario(loaded.scenario, 10001, 1, {});
}

double mass_of(const std::vector<Grain>& grains) {
  return std::accumulate(grains.begin(), grains.end(), 0.0,
                         [](double sum, const Grain& grain) { return sum + grain.mass; });
}

TEST(EndDump, WhatSticksToTheBedIsCarriedBackAndDoesNotFallThroughIt) {
  for (const char* release : {"open_gate", "hoist"}) {
    const std::string how = std::string("experiment.truck.release=") + release;
    const RunOutcome plain = run("small_dump.yaml", {how}),
                     sticky = run("small_dump.yaml", {how, "effects.sticky_tools.bond_number=3"});
    EXPECT_LT(plain.carried_back, 0.05 * mass_of(plain.original)) << release;
    EXPECT_GT(sticky.carried_back, 0.2 * mass_of(sticky.original)) << release;
    for (const RunOutcome* each : {&plain, &sticky}) {
      const double there =
          mass_of(each->final_state.grains) + each->statistics.lost_mass + each->carried_back;
      EXPECT_NEAR(there, mass_of(each->original), 1e-9 * there) << release;
      EXPECT_TRUE(each->energy && std::abs(each->energy->relative_error()) < 0.01) << release;
    }
    // 4 m high: what the bed let fall when it was taken away lay on the bench top.
    double above = 0;
    for (const Grain& grain : sticky.final_state.grains)
      if (grain.position.z() > 4) above += grain.mass;
    EXPECT_LT(above, 0.1 * mass_of(sticky.original)) << release;
  }
}

// What contacts with the bed hold is booked once, however much it is.
TEST(EndDump, EnergyClosesWhenMuchSticks) {
  const RunOutcome sticky = run("small_dump.yaml", {"effects.sticky_tools.bond_number=30"});
  EXPECT_GT(sticky.carried_back, 0.2 * mass_of(sticky.original));
  ASSERT_TRUE(sticky.energy);
  EXPECT_LT(std::abs(sticky.energy->relative_error()), 0.01);
}

// A bed low over the bench top: the heap before its lip holds back more than half of the load, which runs out
// when the truck drives off. Nothing sticks.
TEST(EndDump, WhatTheHeapHeldBackRunsOutWhenTheTruckDrivesOff) {
  for (const char* release : {"open_gate", "hoist"}) {
    const RunOutcome low =
        run("small_dump.yaml",
            {std::string("experiment.truck.release=") + release, "experiment.truck.drop_height_m=0.5",
             "experiment.truck.setback_m=1", "experiment.bench.top_length_m=14"});
    EXPECT_LT(low.carried_back, 0.05 * mass_of(low.original)) << release;
    EXPECT_LT(low.statistics.lost_mass, 0.01 * mass_of(low.original)) << release;
    EXPECT_TRUE(low.energy && std::abs(low.energy->relative_error()) < 0.01) << release;
    // It runs out where the lip passed, 1 to 9 m behind the crest; nothing is dragged beyond.
    double dragged = 0, middle = 0;
    for (const Grain& grain : low.final_state.grains) {
      middle += grain.mass * grain.position.x() / mass_of(low.final_state.grains);
      if (grain.position.x() < -6) dragged += grain.mass;
    }
    EXPECT_LT(dragged, 0.02 * mass_of(low.original)) << release;
    EXPECT_GT(middle, -3) << release;
  }
}

// Of four loads from a bed that is hoisted as much lies behind the crest as of a gate that opens.
TEST(EndDump, TheHeapStaysWhereTheTruckLeavesIt) {
  const auto behind = [](const char* release) {
    const RunOutcome outcome =
        run("small_dump.yaml", {std::string("experiment.truck.release=") + release, "experiment.dumps=4",
                                "experiment.bench.top_length_m=20"});
    double mass = 0;
    for (const Grain& grain : outcome.final_state.grains)
      if (grain.position.x() < -3) mass += grain.mass;
    return mass / mass_of(outcome.original);
  };
  EXPECT_LT(behind("open_gate"), 0.02);
  EXPECT_LT(behind("hoist"), 0.02);
}

// Nothing but the heap before it holds back the load of a bed that is hoisted: most of a second load of 150 t
// is out when the bed is up. Behind a gate that hung from the upper edge 24 t of it would be there.
TEST(EndDump, HoistedBedIsOpenBehind) {
  const std::filesystem::path source = SCREE_SOURCE_DIR;
  const ScenarioResult loaded = load_scenario(source / "scenarios" / "small_dump.yaml",
                                              {"experiment.truck.release=hoist", "experiment.dumps=2",
                                               "experiment.payload_t=150", "experiment.bench.height_m=6"},
                                              source / "assets");
  const auto& e = std::get<EndDump>(loaded.scenario.experiment);
  ASSERT_EQ(e.truck.tilt_deg, 45);
  const Vec3 lip(-e.truck.setback, 0, e.bench.height + e.truck.drop_height);
  double in_bed = 0;
  bool up = false;
  RunHooks hooks;
  hooks.look = [&](const Snapshot& shot) {
    in_bed = 0;
    for (const Grain& grain : shot.grains)  // behind the lip, over the floor of the bed
      if (const Vec3 from = grain.position - lip; from.x() < 0 && from.z() > -from.x()) in_bed += grain.mass;
  };
  hooks.progress = [&](const RunProgress& progress) {
    up = progress.dump == 2 && std::string(progress.stage) == "dumping";
    return !up;
  };
  run_scenario(loaded.scenario, 10001, 1, hooks);
  ASSERT_TRUE(up);
  EXPECT_LT(in_bed, 0.1 * 150e3);
}

// Rock behind a gate that has just been opened is still, but not at rest.
TEST(EndDump, LoadComesToRestAfterItHasMoved) {
  const auto above = [](const char* least) {
    const RunOutcome outcome =
        run("small_dump.yaml", {"experiment.truck.settle_s=10", std::string("stop.min_time_s=") + least});
    double mass = 0;
    for (const Grain& grain : outcome.final_state.grains)
      if (grain.position.z() > 4) mass += grain.mass;
    return mass / mass_of(outcome.original);
  };
  const double usual = above("1");
  EXPECT_NEAR(above("0"), usual, 0.01);
  EXPECT_NEAR(above("0.3"), usual, 0.01);
}

// A run that is saved while a truck leaves with rock in its bed, and taken up again, ends with the same bits.
TEST(EndDump, IsTakenUpWhileATruckLeaves) {
  const std::filesystem::path source = SCREE_SOURCE_DIR;
  const ScenarioResult loaded =
      load_scenario(source / "scenarios" / "small_dump.yaml",
                    {"effects.sticky_tools.bond_number=2", "experiment.dumps=2"}, source / "assets");
  std::vector<std::string> saved;  // states
  std::string stage;
  RunHooks hooks;
  hooks.progress = [&](const RunProgress& progress) {
    stage = progress.stage;
    return true;
  };
  hooks.save_due = [&] { return stage == "leaving" || stage == "truck leaves"; };
  hooks.save = [&](double, const std::function<void(StateWriter&)>& write) {
    std::string& state = saved.emplace_back();
    StateWriter writer(
        [&](const void* data, std::size_t size) { state.append(static_cast<const char*>(data), size); });
    write(writer);
  };
  const RunOutcome whole = run_scenario(loaded.scenario, 10001, 1, hooks);
  ASSERT_GT(whole.carried_back, 0);
  ASSERT_GT(saved.size(), 20u);
  for (std::size_t k = 0; k < saved.size(); k += saved.size() / 8) {
    std::size_t at = 0;
    StateReader reader(
        [&](void* data, std::size_t size) {
          std::memcpy(data, saved[k].data() + at, size);
          at += size;
        },
        saved[k].size());
    RunHooks again;
    again.resume = &reader;
    const RunOutcome resumed = run_scenario(loaded.scenario, 10001, 1, again);
    EXPECT_EQ(resumed.carried_back, whole.carried_back) << k;
    ASSERT_EQ(resumed.final_state.grains.size(), whole.final_state.grains.size()) << k;
    for (std::size_t i = 0; i < whole.final_state.grains.size(); ++i)
      ASSERT_EQ(resumed.final_state.grains[i].position, whole.final_state.grains[i].position) << k;
  }
}

TEST(EndDump, ClumpsAreCarriedBackWhole) {
  const RunOutcome clumps =
      run("small_dump.yaml", {"effects.sticky_tools.bond_number=3", "effects.clumps.elongation=0.4"});
  EXPECT_GT(clumps.carried_back, 0);
  const double there = mass_of(clumps.final_state.grains) + clumps.statistics.lost_mass + clumps.carried_back;
  EXPECT_NEAR(there, mass_of(clumps.original), 1e-9 * there);
}

// A run lasts until its tools stand still, and the blade takes the rock on the bench top over the crest.
TEST(EndDump, ToolsGoToTheEndOfTheirWay) {
  const auto on_top = [](const RunOutcome& outcome) {
    double mass = 0;
    for (const Grain& grain : outcome.final_state.grains)
      if (grain.position.x() < 0) mass += grain.mass;
    return mass;
  };
  const RunOutcome without = run("quick_dump.yaml", {}), with = run("user_mesh_tool.yaml", {});
  EXPECT_GT(with.simulated_seconds, 34);
  EXPECT_TRUE(with.at_rest);
  EXPECT_LT(with.statistics.lost_mass, 0.01 * mass_of(with.original));
  EXPECT_LT(on_top(with), 0.3 * on_top(without));
}

}  // namespace
}  // namespace scree
