// The program as a user meets it: exit codes, messages, files, interruption, and the same numbers with any
// number of threads.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "scree_version.h"
#include "tests/cli/background.h"
#include "tests/cli/call.h"

namespace fs = std::filesystem;

namespace {

class Cli : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("scree_cli_" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  fs::path folder;
  // A load of a few hundred spheres over a bench of 3 m: some seconds.
  const std::string small =
      std::string(SCREE_SOURCE_DIR) + "/scenarios/quick_dump.yaml --set experiment.payload_t=10" +
      " --set experiment.bench.height_m=3 --set experiment.bench.width_m=30" +
      " --set experiment.bench.top_length_m=10 --set experiment.bench.floor_length_m=15";
};

// Hours of simulation must not end at a table that could have been read before.
TEST_F(Cli, PrintedValuesAreReadBeforeAnythingIsSimulated) {
  const fs::path assets = folder / "assets";
  fs::copy(fs::path(SCREE_SOURCE_DIR) / "assets", assets, fs::copy_options::recursive);
  fs::create_directory_symlink(fs::path(SCREE_SOURCE_DIR) / "scenarios", folder / "scenarios");
  const std::string table = slurp(assets / "reference" / "results.csv");  // of another version: a column less
  std::ofstream(assets / "reference" / "results.csv")
      << table.substr(0, table.find(",repeats")) << table.substr(table.find('\n'));
  setenv("SCREE_ASSETS", assets.c_str(), 1);
  const fs::path out = folder / "run", store = folder / "store.sqlite";
  std::ofstream(folder / "sweep.yaml") << "scenario: " SCREE_SOURCE_DIR
                                          "/scenarios/quick_dump.yaml\nseeds: [1]\n"
                                          "design: {type: grid, parameters: {material.mu: [0.3]}}\n";
  for (const std::string& command :
       {"run " + small + " --out " + out.string(),
        "reproduce a1 --store " + store.string() + " --out " + out.string(),
        "sweep " + (folder / "sweep.yaml").string() + " --store " + store.string()}) {
    const Called called = call(command);
    EXPECT_EQ(called.code, 2) << command;
    EXPECT_NE(called.text.find("results.csv:1: the header must be"), std::string::npos) << called.text;
    EXPECT_FALSE(fs::exists(out)) << command;
    EXPECT_FALSE(fs::exists(store)) << command;
  }
  unsetenv("SCREE_ASSETS");
}

TEST_F(Cli, RunWritesWhatItPromises) {
  const fs::path out = folder / "run";
  const Called run = call("run " + small + " --seeds 2 --out " + out.string());
  ASSERT_EQ(run.code, 0) << run.text;
  for (const char* name :
       {"scenario.yaml", "summary.json", "sections.csv", "ksat.csv", "report.html", "seed_10001/particles.h5",
        "seed_10001/particles.xdmf", "seed_10001/particles.xyz", "seed_10002/particles.h5"})
    EXPECT_GT(fs::file_size(out / name), 100u) << name;
  const auto summary = nlohmann::json::parse(slurp(out / "summary.json"));
  for (const char* key :
       {"scenario", "engine", "seeds", "particles", "wall_seconds", "simulated_seconds", "particle_steps",
        "largest_overlap_ratio", "lost_particles", "sections", "comparison"})
    EXPECT_TRUE(summary.contains(key)) << key;
  // What was put in is in the sections, above them, or lost.
  double mass = summary["lost_mass_t"].get<double>();
  for (const auto& section : summary["sections"])
    for (const auto& value : section["mass_t"]["per_seed"]) mass += value.get<double>();
  for (const auto& seed : summary["per_seed"]) mass += seed["tables"][0]["mass_outside_t"].get<double>();
  EXPECT_NEAR(mass, 20.0, 0.2);
  EXPECT_TRUE(summary["at_rest"].get<bool>());
  EXPECT_EQ(summary["watch"], "passed");
  EXPECT_LT(std::abs(summary["energy_error_over_put_in"].get<double>()), 0.01);
  EXPECT_GT(summary["per_seed"][0]["energy"]["taken_out"]["sliding_j"].get<double>(), 0);

  // The resolved scenario is a scenario, and gives the same numbers.
  const Called again =
      call("run " + (out / "scenario.yaml").string() + " --seeds 2 --out " + (folder / "again").string());
  ASSERT_EQ(again.code, 0) << again.text;
  EXPECT_EQ(slurp(out / "sections.csv"), slurp(folder / "again" / "sections.csv"));

  const Called compare = call("compare " + out.string() + " --case C1");
  EXPECT_EQ(compare.code, 0) << compare.text;
  EXPECT_NE(compare.text.find("share_above_1m"), std::string::npos) << compare.text;

  const Called twice = call("run " + small + " --out " + out.string());
  EXPECT_EQ(twice.code, 2);
  EXPECT_NE(twice.text.find("is there already"), std::string::npos) << twice.text;
}

// A floor of 1 m, over whose end most of the rock falls.
TEST_F(Cli, RunThatBreaksTheWatchFails) {
  const fs::path out = folder / "run";
  const Called run = call("run " + small + " --set experiment.bench.floor_length_m=1 --out " + out.string());
  EXPECT_EQ(run.code, 3) << run.text;
  EXPECT_NE(run.text.find("FAILED: seed 10001: "), std::string::npos) << run.text;
  const auto summary = nlohmann::json::parse(slurp(out / "summary.json"));
  EXPECT_EQ(summary["watch"], "FAILED");
  EXPECT_EQ(summary["failures"].size(), 1u);
  EXPECT_EQ(summary["per_seed"][0]["watch"], "FAILED");
  EXPECT_NE(slurp(out / "report.html").find("FAILED: this run does not count"), std::string::npos);

  // In a sweep it has failed, in its own words.
  const fs::path file = folder / "sweep.yaml";
  std::ofstream(file) << "scenario: " << SCREE_SOURCE_DIR
                      << "/scenarios/quick_dump.yaml\nseeds: [10001]\nset: {experiment.payload_t: 5, "
                         "experiment.bench.height_m: 3, experiment.bench.width_m: 30, "
                         "experiment.bench.top_length_m: 10}\ndesign: {type: grid, parameters: "
                         "{experiment.bench.floor_length_m: [1]}}\n";
  const std::string store = " --store " + (folder / "store.sqlite").string();
  EXPECT_EQ(call("sweep " + file.string() + store).code, 1);
  const Called failed = call("sweep " + file.string() + store + " --failed");
  EXPECT_NE(failed.text.find("of the mass left the model"), std::string::npos) << failed.text;
}

TEST_F(Cli, NumbersDoNotDependOnThreads) {
  std::string first;
  for (const int threads : {1, 2, 4}) {
    const fs::path out = folder / std::to_string(threads);
    const Called run =
        call("run " + small + " --threads " + std::to_string(threads) + " --out " + out.string());
    ASSERT_EQ(run.code, 0) << run.text;
    // The extended XYZ holds every place of every frame.
    const std::string places = slurp(out / "seed_10001" / "particles.xyz");
    if (first.empty()) first = places;
    EXPECT_TRUE(places == first) << threads << " threads";
  }
}

TEST_F(Cli, BadInputIsOneLineAndExitCodeTwo) {
  struct Case {
    const char* arguments;
    const char* message;
  };
  const Case cases[] = {
      {"", "subcommand"},
      {"run", "needs a scenario file"},
      {"run nowhere.yaml", "nowhere.yaml"},
      {"dig scenarios/a1_10m.yaml", "dig"},
      {"compare nowhere", "cannot be read"},
      {"validate nowhere.yaml", "nowhere.yaml"},
      {"run nowhere.yaml --seeds 0", "--seeds"},
      {"run nowhere.yaml --threads x", "--threads"},
      {"effects magic", "no such effect; there are cohesion"},
  };
  for (const Case& c : cases) {
    const Called result = call(c.arguments);
    EXPECT_EQ(result.code, 2) << c.arguments;
    EXPECT_NE(result.text.find(c.message), std::string::npos) << c.arguments << ": " << result.text;
    EXPECT_EQ(std::count(result.text.begin(), result.text.end(), '\n'), 1) << result.text;
  }
  const std::string push = "run " + std::string(SCREE_SOURCE_DIR) + "/scenarios/thesis/d2.yaml --out " +
                           (folder / "x").string() + " --set ";
  for (const char* key :
       {"experiment.blade.left_share=0.2", "experiment.side_walls=false --set experiment.settle_s=3"}) {
    const Called other = call(push + key);
    EXPECT_EQ(other.code, 2) << key;
    EXPECT_EQ(std::count(other.text.begin(), other.text.end(), '\n'), 1) << other.text;
  }
  for (const std::string& command :
       {std::string("validate "), "run --out " + (folder / "x").string() + " "}) {
    const Called breaks = call(command + small +
                               " --set experiment.bench.base_ball_diameter_m=0.5"
                               " --set effects.breakage.fragility_kg_per_j=1");
    EXPECT_EQ(breaks.code, 2);
    EXPECT_NE(breaks.text.find("set output.trajectory to false"), std::string::npos) << breaks.text;
    EXPECT_EQ(std::count(breaks.text.begin(), breaks.text.end(), '\n'), 1) << breaks.text;
  }
  const Called set =
      call("run " + small + " --set material.mux=1 --set material.mu=-1 --out " + (folder / "x").string());
  EXPECT_EQ(set.code, 2);
  EXPECT_NE(set.text.find("--set material.mux=1"), std::string::npos) << set.text;
  EXPECT_NE(set.text.find("--set material.mu=-1"), std::string::npos) << set.text;
  EXPECT_FALSE(fs::exists(folder / "x")) << "nothing is written before the input is good";
}

// Without damping half of the load still rolls when its time is over.
TEST_F(Cli, AHeapWithoutAnAngleSaysWhy) {
  const fs::path out = folder / "run";
  const Called run = call("run " + std::string(SCREE_SOURCE_DIR) +
                          "/scenarios/small_heap.yaml --set material.local_damping=0 --out " + out.string());
  EXPECT_EQ(run.code, 0) << run.text;
  EXPECT_EQ(run.text.find("nan"), std::string::npos) << run.text;
  EXPECT_NE(run.text.find("no repose angle (reason below)"), std::string::npos) << run.text;
  EXPECT_NE(run.text.find("note: seed 10002: no repose angle: not at rest"), std::string::npos) << run.text;
  EXPECT_NE(slurp(out / "report.html").find("No repose angle: not at rest."), std::string::npos);
}

TEST_F(Cli, ARunWhosePicturesGnuplotRefusesHasAReportAndFails) {
  std::ofstream(folder / "gnuplot") << "#!/bin/sh\necho 'no range' >&2\nexit 1\n";
  fs::permissions(folder / "gnuplot", fs::perms::owner_all);
  const fs::path out = folder / "run";
  const Called run =
      called("PATH=" + folder.string() + ":$PATH " SCREE_BINARY " run " + small + " --out " + out.string());
  EXPECT_EQ(run.code, 1) << run.text;
  EXPECT_NE(run.text.find("the report lacks a picture: gnuplot failed on"), std::string::npos) << run.text;
  EXPECT_NE(slurp(out / "report.html").find("A picture is missing: gnuplot failed on"), std::string::npos);
}

// Of 60 t on a face of 10 m few grains lie on each other.
TEST_F(Cli, ASlopeOfFewGrainsIsToldToBeTheFaces) {
  const Called run = call("run " SCREE_SOURCE_DIR "/scenarios/quick_dump.yaml --summary-only --out " +
                          (folder / "run").string());
  EXPECT_EQ(run.code, 0) << run.text;
  EXPECT_NE(run.text.find("its slope is the face"), std::string::npos) << run.text;
}

// Balls of 1 m on a bench of 0.5 m carry nearly all of the load above its crest.
TEST_F(Cli, BallsTooLargeForTheBenchAreTold) {
  const fs::path out = folder / "run";
  const Called run = call("run " + small + " --set experiment.bench.height_m=0.5 --out " + out.string() +
                          " --set effects.cohesion.bond_number=0.01");
  EXPECT_EQ(run.code, 0) << run.text;
  for (const char* text : {"balls of 1 m on a bench 0.5 m high, more than a fifth of it (0.1 m)",
                           "of the rock lies above the crest's height and belongs to no section",
                           "effect cohesion: bond_number 0.01; gamma "})
    EXPECT_NE(run.text.find(text), std::string::npos) << text << '\n' << run.text;
  const std::string report = slurp(out / "report.html");
  EXPECT_NE(report.find("belongs to no section.</strong>"), std::string::npos);
  EXPECT_NE(report.find("<dt>effect</dt><dd>cohesion: bond_number 0.01; gamma "), std::string::npos);
  const Called fine = call("validate " + small + " --set experiment.bench.base_ball_diameter_m=0.6" +
                           " --set effects.cohesion.bond_number=0.01");
  EXPECT_EQ(fine.text.find("warning"), std::string::npos) << "a fifth of 3 m\n" << fine.text;
  EXPECT_NE(fine.text.find("effect cohesion: bond_number 0.01; gamma "), std::string::npos) << fine.text;
}

// Effects on measurement change the gradings of the same pile, and nothing when absent.
TEST_F(Cli, EffectsOnMeasurementChangeGradingsAlone) {
  const auto run = [&](const std::string& name, const std::string& set) {
    const fs::path out = folder / name;
    const Called called = call("run " + small + " --summary-only --set output.trajectory=false" + set +
                               " --out " + out.string());
    EXPECT_EQ(called.code, 0) << called.text;
    return std::pair(slurp(out / "sections.csv"), nlohmann::json::parse(slurp(out / "summary.json")));
  };
  const auto truth = run("truth", "");
  EXPECT_EQ(run("absent",
                " --set effects.image_blur.width=0 --set effects.section_borders.shift=0"
                " --set effects.surface_only.share=0 --set effects.own_reference.share=0")
                .first,
            truth.first);
  for (const std::string seen :
       {"detection_limit.ratio=0.5", "surface_only.share=1", "own_reference.share=1"}) {
    const auto measured = run(seen.substr(0, seen.find('.')), " --set effects." + seen);
    EXPECT_NE(measured.first, truth.first) << seen;
    for (std::size_t k = 0; k < truth.second["sections"].size(); ++k)
      EXPECT_NEAR(measured.second["sections"][k]["mass_t"]["mean"].get<double>(),
                  truth.second["sections"][k]["mass_t"]["mean"].get<double>(), 1e-9);
  }
}

TEST_F(Cli, EffectsAreToldInWords) {
  const Called all = call("effects"), one = call("effects detection_limit");
  EXPECT_EQ(all.code, 0);
  EXPECT_NE(all.text.find("small grains that images miss (measurement)"), std::string::npos) << all.text;
  EXPECT_EQ(one.code, 0);
  EXPECT_NE(one.text.find("| `ratio` |"), std::string::npos) << one.text;
}

TEST_F(Cli, InterruptKeepsWhatIsDone) {
  const fs::path out = folder / "run";
  const std::string source = std::string(SCREE_SOURCE_DIR) + "/scenarios/quick_dump.yaml";
  Background run({"run", source, "--out", out.string()}, "/dev/null");
  // Some frames are on disk before the interruption.
  const fs::path frames = out / "seed_10001" / "particles.xyz";
  run.ended_before([&] { return fs::exists(frames) && fs::file_size(frames) > 200000; });
  run.send(SIGINT);
  EXPECT_EQ(run.code(), 130);
  const auto summary = nlohmann::json::parse(slurp(out / "summary.json"));
  EXPECT_TRUE(summary["interrupted"].get<bool>());
  EXPECT_FALSE(summary["at_rest"].get<bool>()) << "an interrupted run does not look finished";
  EXPECT_TRUE(summary["comparison"].empty());
  EXPECT_NE(slurp(out / "report.html").find("ended by the user"), std::string::npos);
}

// What cannot be said on stderr ends nothing, what is lost on stdout is no success.
TEST_F(Cli, StreamsThatCannotBeWritten) {
  for (const char* lost : {"2>&-", "2>/dev/full"}) {
    EXPECT_EQ(called(SCREE_BINARY " run nowhere.yaml " + std::string(lost)).code, 2) << lost;
    const fs::path out = folder / "quiet";
    fs::remove_all(out);
    EXPECT_EQ(
        called(SCREE_BINARY " run " + small + " --summary-only --out " + out.string() + " " + lost).code, 0);
    EXPECT_TRUE(fs::exists(out / "summary.json")) << lost;
  }
  const fs::path out = folder / "unheard";
  EXPECT_EQ(called("sh -c '" SCREE_BINARY " run " + small + " --summary-only --out " + out.string() +
                   " >/dev/full'")
                .code,
            1);
  EXPECT_TRUE(fs::exists(out / "summary.json"));
  EXPECT_FALSE(fs::exists(out / "resume.json")) << "it has come to its end";
  EXPECT_EQ(called("bash -c '" SCREE_BINARY " schema | head -1; exit ${PIPESTATUS[0]}'").code, 0);
  for (const char* command : {"schema", "--help", "effects"}) {
    const Called full = called("sh -c '" SCREE_BINARY " " + std::string(command) + " >/dev/full'");
    EXPECT_EQ(full.code, 1) << command;
    EXPECT_NE(full.text.find("cannot write to the standard output"), std::string::npos) << command;
  }
}

// gnuplot does not notice a full disk.
TEST_F(Cli, APictureThatIsCutOffIsNoPicture) {
  const fs::path svg = folder / "p.svg";
  std::ofstream(svg) << "the old one";
  const std::string sweep = std::string(SCREE_BINARY) +
                            " sweep " SCREE_SOURCE_DIR
                            "/scenarios/sweeps/repose_lab.yaml --from " SCREE_SOURCE_DIR
                            "/assets/sweeps/repose_lab.csv --plot " +
                            svg.string();
  const Called cut = called("ulimit -f 8; " + sweep);
  EXPECT_EQ(cut.code, 1) << cut.text;
  EXPECT_NE(cut.text.find("cannot write " + svg.string()), std::string::npos) << cut.text;
  EXPECT_EQ(slurp(svg), "the old one");
  EXPECT_FALSE(fs::exists(svg.string() + ".part"));
  EXPECT_EQ(called(sweep).code, 0);
  EXPECT_GT(fs::file_size(svg), 100000u);
}

TEST_F(Cli, WithoutGnuplotTheNumbersAreThereAndTheReportCanFollow) {
  const fs::path out = folder / "run";
  const Called without = called("PATH=/nonexistent " SCREE_BINARY " run " + small + " --out " + out.string());
  EXPECT_EQ(without.code, 1) << without.text;
  EXPECT_NE(without.text.find("the numbers are in " + (out / "summary.json").string()), std::string::npos);
  EXPECT_NE(without.text.find("to go on: scree run --resume"), std::string::npos) << without.text;
  EXPECT_TRUE(fs::exists(out / "summary.json"));
  const Called with = call("run --resume " + out.string());
  EXPECT_EQ(with.code, 0) << with.text;
  EXPECT_EQ(with.text.find("begins at its beginning"), std::string::npos) << with.text;
  EXPECT_TRUE(fs::exists(out / "report.html"));
}

TEST_F(Cli, ValidateAndSchema) {
  const Called good = call("validate " + std::string(SCREE_SOURCE_DIR) + "/scenarios/a1_10m.yaml");
  EXPECT_EQ(good.code, 0) << good.text;
  EXPECT_NE(good.text.find("ok"), std::string::npos);
  const Called schema = call("schema");
  EXPECT_EQ(schema.code, 0);
  EXPECT_TRUE(nlohmann::json::parse(schema.text).contains("properties"));
}

TEST_F(Cli, ThePageOnKeysIsThatOfTheProgram) {
  const Called page = call("schema --document");
  EXPECT_EQ(page.code, 0);
  EXPECT_EQ(page.text, slurp(SCREE_SOURCE_DIR "/docs/scenarios.md"))
      << "build/release/scree schema --document > docs/scenarios.md";
}

}  // namespace
