// Sweeps, calibrations and predictions as a user meets them: killed at any moment, two at once, wrong files.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <set>
#include <vector>

#include "scree_version.h"
#include "sim/io/results_store.h"
#include "tests/cli/background.h"
#include "tests/cli/call.h"

namespace fs = std::filesystem;
using testing::HasSubstr;

namespace {

class SweepCli : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("scree_sweep_cli_" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    // A bucket of 2 kg: some tenths of a second.
    write(
        "sweep.yaml",
        head +
            "seeds: [1, 2]\nset: {experiment.mass_kg: 2}\n"
            "design: {type: grid, parameters: {material.mu: [0.1, 0.2, 0.4], material.mu_r: [0.1, 0.3]}}\n");
  }
  void TearDown() override { fs::remove_all(folder); }

  void write(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
  std::string in_folder(const std::string& name) const { return (folder / name).string(); }
  // What the store has of the sweep, but for the seconds it took.
  std::vector<std::string> rows(const std::string& store) {
    const Called called = call("sweep " + in_folder("sweep.yaml") + " --store " + in_folder(store) +
                               " --list --export " + in_folder("rows.csv"));
    EXPECT_EQ(called.code, 0) << called.text;
    std::vector<std::string> lines;
    std::istringstream in(slurp(folder / "rows.csv"));
    for (std::string line; std::getline(in, line);)
      if (!line.starts_with('#'))  // which sweep it is of
        lines.push_back(std::regex_replace(line, std::regex("(,done,[^,]*,)[0-9.]+"), "$1"));
    return lines;
  }
  // A sweep of one run that takes a while: its file.
  std::string sweep_of_one_run(const std::string& mass_kg) {
    write("sweep.yaml", head + "seeds: [1]\nset: {experiment.mass_kg: " + mass_kg +
                            "}\ndesign: {type: list, points: [{material.mu: 0.2}]}\n");
    return in_folder("sweep.yaml");
  }
  // Starts the program in the background.
  Background start(const std::vector<std::string>& words, const std::string& log = "log") const {
    return {words, folder / log};
  }
  fs::path folder;
  const std::string head = "scenario: " + std::string(SCREE_SOURCE_DIR) + "/scenarios/repose_lab.yaml\n";
};

TEST_F(SweepCli, KilledAtAnyMomentItGoesOnToTheSameStore) {
  const std::string sweep = in_folder("sweep.yaml");
  ASSERT_EQ(call("sweep " + sweep + " --store " + in_folder("whole.sqlite")).code, 0);
  const std::vector<std::string> whole = rows("whole.sqlite");
  ASSERT_EQ(whole.size(), 1u + 6 * 2);
  for (std::size_t k = 1; k < whole.size(); ++k) EXPECT_THAT(whole[k], HasSubstr(",done,"));

  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  int kills = 0, code = 0;
  while (true) {
    Background run = start({"sweep", sweep, "--store", in_folder("killed.sqlite")});
    // Longer as time goes on: on a busy machine a run takes more than the first ones.
    run.ended_within((0.02 + 0.4 * share(random)) * (1 + 0.05 * kills));
    run.send(SIGKILL);
    if ((code = run.code()) != -SIGKILL) break;
    ASSERT_LT(++kills, 500) << "it comes no further";
  }
  EXPECT_EQ(code, 0);
  EXPECT_GE(kills, 3);
  EXPECT_EQ(rows("killed.sqlite"), whole);
  EXPECT_FALSE(fs::exists(folder / "killed.sqlite.work")) << "nothing is left of what was killed";
}

// What a killed sweep had simulated of a long run is not simulated again.
TEST_F(SweepCli, KilledInTheMiddleOfARunItGoesOnFromItsCheckpoint) {
  const std::string sweep = sweep_of_one_run("4");
  ASSERT_EQ(call("sweep " + sweep + " --checkpoint-minutes 0 --store " + in_folder("whole.sqlite")).code, 0);
  std::set<std::string> goes_on;  // times from which it went on
  bool ended = false;
  for (int round = 0; !ended; ++round) {
    ASSERT_LT(round, 100) << "it comes no further";
    // Killed as soon as there is a checkpoint that was not there before.
    const fs::path work = folder / "killed.sqlite.work";
    const std::vector<fs::path> before = checkpoints_below(work);
    Background run =
        start({"sweep", sweep, "--checkpoint-minutes", "0.003", "--store", in_folder("killed.sqlite")});
    run.ended_before([&] {
      const std::vector<fs::path> now = checkpoints_below(work);
      return !std::includes(before.begin(), before.end(), now.begin(), now.end());
    });
    run.send(SIGKILL);
    const int code = run.code();
    ended = code != -SIGKILL;
    EXPECT_TRUE(!ended || code == 0) << code;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(work, none)) {
      std::smatch found;
      const std::string log = slurp(entry.path() / "log.txt");
      if (std::regex_search(log, found, std::regex("goes on from t = ([0-9.]+) s"))) goes_on.insert(found[1]);
    }
  }
  EXPECT_GE(goes_on.size(), 2u);
  EXPECT_EQ(rows("killed.sqlite"), rows("whole.sqlite"));
  EXPECT_FALSE(fs::exists(folder / "killed.sqlite.work")) << "nothing is left of what was killed";
}

TEST_F(SweepCli, TwoAtOnceDoEachRunOnce) {
  std::vector<Background> sweeps;
  for (const char* log : {"first", "second"})
    sweeps.push_back(
        start({"sweep", in_folder("sweep.yaml"), "--jobs", "1", "--store", in_folder("both.sqlite")}, log));
  for (Background& sweep : sweeps) EXPECT_EQ(sweep.code(), 0);
  int done_here = 0;
  for (const char* log : {"first", "second"}) {
    std::smatch found;
    const std::string text = slurp(folder / log);
    ASSERT_TRUE(std::regex_search(text, found, std::regex("\\(([0-9]+) runs done here\\)"))) << text;
    done_here += std::stoi(found[1]);
  }
  EXPECT_EQ(done_here, 12);
  const std::vector<std::string> both = rows("both.sqlite");
  for (std::size_t k = 1; k < both.size(); ++k) EXPECT_THAT(both[k], HasSubstr(",done,"));
}

TEST_F(SweepCli, InterruptGivesBackAndSaysHowToGoOn) {
  Background sweep = start({"sweep", in_folder("sweep.yaml"), "--store", in_folder("store.sqlite")});
  sweep.ended_within(0.3);
  sweep.send(SIGINT);
  EXPECT_EQ(sweep.code(), 130);
  EXPECT_THAT(slurp(folder / "log"), HasSubstr("the same command goes on"));
  for (const std::string& row : rows("store.sqlite")) EXPECT_THAT(row, testing::Not(HasSubstr(",running,")));
}

// Long before the first checkpoint that its time would bring.
TEST_F(SweepCli, InterruptedInTheMiddleOfARunItGoesOnFromThere) {
  const std::string sweep = sweep_of_one_run("10");
  ASSERT_EQ(call("sweep " + sweep + " --store " + in_folder("whole.sqlite")).code, 0);
  const fs::path work = folder / "store.sqlite.work";
  Background run = start({"sweep", sweep, "--store", in_folder("store.sqlite")});
  run.ended_before([&] {  // under way: its folder of results is there
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(work, none))
      if (fs::exists(entry.path() / "run")) return true;
    return false;
  });
  run.send(SIGINT);
  ASSERT_EQ(run.code(), 130) << "it ended before it was interrupted";
  ASSERT_EQ(checkpoints_below(work).size(), 1u) << "it ended before it was interrupted";
  Background again = start({"sweep", sweep, "--store", in_folder("store.sqlite")});
  std::string said;  // of the run, whose log goes with its folder
  again.ended_before([&] {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(work, none)) said = slurp(entry.path() / "log.txt");
    return said.find("goes on from t") != std::string::npos;
  });
  EXPECT_THAT(said, HasSubstr("goes on from t"));
  EXPECT_EQ(again.code(), 0);
  EXPECT_EQ(rows("store.sqlite"), rows("whole.sqlite"));
  EXPECT_FALSE(fs::exists(work));
}

TEST_F(SweepCli, PredictsAndCalibratesFromTheStore) {
  // A slim bucket of small grains gives a heap that has an angle.
  write("gravel.csv", "diameter_mm,passing_pct\n10,0\n25,100\n");
  const std::string six = "seeds: [1, 2]\nset: {experiment.mass_kg: 3, grading: " + in_folder("gravel.csv") +
                          ", experiment.container.mesh_scale: 0.4, experiment.container.diameter_m: 0.14, "
                          "experiment.container.height_m: 0.24}\nties: {material.mu_r: material.mu}\n",
                    store = " --store " + in_folder("store.sqlite"), sweep = in_folder("six.yaml");
  write("six.yaml", head + six + "design: {type: grid, parameters: {material.mu: [0.2, 0.3, 0.4]}}\n");
  ASSERT_EQ(call("sweep " + sweep + store + " --plot " + in_folder("angles.svg")).code, 0);
  EXPECT_TRUE(fs::exists(folder / "angles.svg"));
  const Called asked = call("predict " + sweep + store + " material.mu=0.35");
  EXPECT_EQ(asked.code, 0);
  EXPECT_THAT(asked.text, HasSubstr("from 6 runs"));
  const Called outside = call("predict " + sweep + store + " material.mu=0.9");
  EXPECT_EQ(outside.code, 2);
  EXPECT_THAT(outside.text, HasSubstr("outside of what was simulated, 0.2 to 0.4"));

  write("calibration.yaml", head + six +
                                "parameters: {material.mu: {from: 0.2, to: 0.4}}\n"
                                "targets: [{output: angle_deg, value: 32, uncertainty: 2}]\n"
                                "method: {type: bayes, first: 5, most: 8}\n");
  const Called found =
      call("calibrate " + in_folder("calibration.yaml") + store + " --out " + in_folder("found"));
  ASSERT_EQ(found.code, 0) << found.text;
  const auto json = nlohmann::json::parse(slurp(folder / "found" / "calibration.json"));
  const auto& mu = json["parameters"]["material.mu"];
  EXPECT_GT(mu["value"].get<double>(), mu["interval_90"][0].get<double>());
  EXPECT_LT(mu["value"].get<double>(), mu["interval_90"][1].get<double>());
  EXPECT_LE(json["simulations"].get<int>(), 8);
  for (const char* name : {"material.yaml", "posterior.csv", "runs.csv", "calibration.svg"})
    EXPECT_TRUE(fs::exists(folder / "found" / name)) << name;
  // The material is one that a scenario can take over.
  write("mine.yaml",
        "extends: found/material.yaml\ntitle: Mine\ngrading: Lab0\nexperiment: {type: repose_lift}\n");
  EXPECT_EQ(call("validate " + in_folder("mine.yaml")).code, 0)
      << call("validate " + in_folder("mine.yaml")).text;
}

// Points along a diagonal say nothing of the corners beside it; those of a grid say all of its corners.
TEST_F(SweepCli, PredictsOnlyAmongThePointsOfADesign) {
  const std::string drop = "scenario: " + std::string(SCREE_SOURCE_DIR) +
                           "/scenarios/drop_test.yaml\nseeds: [1]\n",
                    damping = "material.local_damping", height = "experiment.height_m",
                    store = " --store " + in_folder("store.sqlite");
  std::string points;
  for (int k = 0; k <= 4; ++k)
    points += fmt::format("{}{{{}: {:g}, {}: {:g}}}", k == 0 ? "" : ", ", damping, 0.3 + 0.05 * k, height,
                          1 + 0.25 * k);
  write("list.yaml", drop + "design: {type: list, points: [" + points + "]}\n");
  write("grid.yaml", drop + "design: {type: grid, parameters: {" + damping + ": [0.3, 0.4, 0.5], " + height +
                         ": [1, 1.5, 2]}}\n");
  const auto predict = [&](const std::string& file, const std::string& at, const std::string& h) {
    return call("predict " + in_folder(file) + store + " --output rebound_height_m " + damping + "=" + at +
                " " + height + "=" + h);
  };
  ASSERT_EQ(call("sweep " + in_folder("list.yaml") + store).code, 0);
  const Called corner = predict("list.yaml", "0.3", "2");
  EXPECT_EQ(corner.code, 2);
  EXPECT_THAT(
      corner.text,
      HasSubstr("material.local_damping=0.3 experiment.height_m=2: lies outside of what was simulated"));
  EXPECT_THAT(corner.text, HasSubstr("material.local_damping=0.4 experiment.height_m=1.5"));
  // Half of the way there the closed form is 0.41 m, and runs along the diagonal say 0.24 to 0.31 m.
  EXPECT_EQ(predict("list.yaml", "0.34", "1.7").code, 2);
  EXPECT_EQ(predict("list.yaml", "0.4", "1.5").code, 0);
  const Called beside = predict("list.yaml", "0.39", "1.54");
  EXPECT_EQ(beside.code, 0);
  EXPECT_THAT(beside.text, HasSubstr("it is extrapolated"));
  EXPECT_EQ(predict("list.yaml", "0.35", "1.25").code, 0);
  ASSERT_EQ(call("sweep " + in_folder("grid.yaml") + store).code, 0);
  const Called there = predict("grid.yaml", "0.3", "2");
  EXPECT_EQ(there.code, 0) << there.text;
  EXPECT_THAT(there.text, HasSubstr("rebound_height_m = 0.5"));  // 2 m ((1 - 0.3) / (1 + 0.3))^2 = 0.58 m
}

// A rock that falls rebounds alike whatever its friction; a node is found if the friction that is searched
// lies on its ray, at most 5 times its own.
TEST_F(SweepCli, NodesWithoutAnEquivalentAreCounted) {
  const auto fit = [&](const std::string& mu) {
    write("engines.yaml",
          "scenario: " + std::string(SCREE_SOURCE_DIR) +
              "/scenarios/drop_test.yaml\nseeds: [1]\nequivalent:\n  output: rebound_height_m\n"
              "  nodes: {material.mu: [" +
              mu + "], material.mu_r: [" + mu +
              "], material.local_damping: [0.4]}\n"
              "  search: {numerics.impulse_friction: {from: 0.6, to: 0.9}, "
              "numerics.impulse_rolling: {from: 0.6, to: 0.9}}\n"
              "  points: 4\n  rounds: 1\n  within: 100\n");
    return call("calibrate " + in_folder("engines.yaml") + " --store " + in_folder("store.sqlite") +
                " --force --out " + in_folder("fit"));
  };
  const Called some = fit("0.1, 0.4");
  EXPECT_EQ(some.code, 0) << some.text;
  EXPECT_THAT(some.text, HasSubstr("3 of 4 nodes are left out"));
  EXPECT_THAT(some.text, HasSubstr("copy it to assets/impulse"));
  const Called none = fit("0.05, 0.1");
  EXPECT_EQ(none.code, 1) << none.text;
  EXPECT_THAT(none.text, HasSubstr("4 of 4 nodes are left out"));
  EXPECT_THAT(none.text, testing::Not(HasSubstr("copy it to assets/impulse")));
}

// A rock that falls: hundredths of a second.
TEST_F(SweepCli, ARunThatAnotherProgramTriesAgainHasNotFailed) {
  write("calibration.yaml", "scenario: " + std::string(SCREE_SOURCE_DIR) +
                                "/scenarios/drop_test.yaml\nseeds: [1]\n"
                                "parameters: {material.local_damping: {from: 0.4, to: 0.7}}\n"
                                "targets: [{output: rebound_height_m, value: 0.1, uncertainty: 0.02}]\n"
                                "method: {type: bayes, first: 5, most: 5}\n");
  const std::string store = in_folder("store.sqlite");
  const auto calibrate = [&](const std::string& out) {
    return std::vector<std::string>{"calibrate",   in_folder("calibration.yaml"), "--store", store, "--out",
                                    in_folder(out)};
  };
  ASSERT_EQ(start(calibrate("whole")).code(), 0) << slurp(folder / "log");
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(store.c_str(), &db), SQLITE_OK);
  std::vector<std::string> keys;
  const auto ask = [&](const char* sql) {
    const auto keep = [](void* all, int, char** row, char**) {
      static_cast<std::vector<std::string>*>(all)->emplace_back(row[0]);
      return 0;
    };
    ASSERT_EQ(sqlite3_exec(db, sql, keep, &keys, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
  };
  ask("SELECT key FROM runs LIMIT 2");
  ask("UPDATE runs SET state = 'failed', message = 'made up' WHERE key IN (SELECT key FROM runs LIMIT 2)");
  sqlite3_close(db);
  ASSERT_EQ(keys.size(), 2u);

  scree::ResultsStore other(store);
  const auto finish = [&](const std::string& key) {
    return other.finish(key, "", other.find(key)->outputs, 1);
  };
  ASSERT_EQ(other.claim({keys[0], "", 1}, "1", true), scree::Claim::ours);
  Background again = start(calibrate("again"));
  again.ended_within(1);  // it knows by now that the second has failed, and waits for the first
  ASSERT_EQ(other.claim({keys[1], "", 1}, "1", true), scree::Claim::ours);
  EXPECT_TRUE(finish(keys[0]));
  EXPECT_FALSE(again.ended_within(4)) << slurp(folder / "log");
  EXPECT_TRUE(finish(keys[1]));
  EXPECT_EQ(again.code(), 0);
  EXPECT_THAT(slurp(folder / "log"), testing::Not(HasSubstr("left out")));
}

TEST_F(SweepCli, OutputsOfSectionsThatAreNotCutAreRefusedBeforeSimulations) {
  write("dump.yaml",
        "scenario: " + std::string(SCREE_SOURCE_DIR) +
            "/scenarios/quick_dump.yaml\ndesign: {type: grid, parameters: {material.mu: [0.2, 0.3]}}\n");
  const Called called =
      call("sweep " + in_folder("dump.yaml") + " --output chi_S7 --store " + in_folder("store.sqlite"));
  EXPECT_EQ(called.code, 2);
  EXPECT_NE(called.text.find("--output chi_S7: this scenario cuts the slope into 6 sections"),
            std::string::npos)
      << called.text;
  EXPECT_FALSE(fs::exists(in_folder("store.sqlite")));
}

TEST_F(SweepCli, TheTableIsWrittenBesideWhatFailed) {
  const Called called =
      call("sweep " SCREE_SOURCE_DIR "/scenarios/sweeps/repose_lab.yaml --from " SCREE_SOURCE_DIR
           "/assets/sweeps/repose_lab.csv --failed --export " +
           in_folder("all.csv"));
  EXPECT_EQ(called.code, 0);
  EXPECT_THAT(called.text, HasSubstr("no run has failed\ntable: "));
  EXPECT_TRUE(fs::exists(folder / "all.csv"));
}

// Where a caller ignores its children the system keeps to itself how they ended.
TEST_F(SweepCli, EndsWhereTheCallerIgnoresItsChildren) {
  const Called result = called("timeout 100 bash -c \"trap '' CHLD; exec " SCREE_BINARY " sweep " +
                               sweep_of_one_run("0.5") + " --store " + in_folder("s.sqlite") + "\"");
  EXPECT_EQ(result.code, 0) << result.text;
  EXPECT_THAT(result.text, HasSubstr("1 runs done here"));
}

TEST_F(SweepCli, WrongInputIsOneLineAndExitCodeTwo) {
  const std::string store = " --store " + in_folder("store.sqlite");
  write("bad.yaml", head + "design: {type: cube}\n");
  write("text.sqlite", "this is a text file that is long enough for the library to look at it as a database");
  for (const std::string& arguments :
       {"sweep " + in_folder("missing.yaml") + store, "sweep " + in_folder("bad.yaml") + store,
        "sweep " + in_folder("sweep.yaml") + " --list --store " + in_folder("none.sqlite"),
        "sweep " + in_folder("sweep.yaml") + " --store " + in_folder("text.sqlite"),
        "calibrate " + in_folder("sweep.yaml") + store + " --out " + in_folder("x"),
        "predict " + in_folder("sweep.yaml") + " --store " + in_folder("none.sqlite") + " material.mu=0.2"}) {
    const Called called = call(arguments);
    EXPECT_EQ(called.code, 2) << arguments << "\n" << called.text;
    EXPECT_FALSE(called.text.empty()) << arguments;
  }
}

}  // namespace
