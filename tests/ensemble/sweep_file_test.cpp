// Sweep files: what they give, and what is said about wrong ones.
#include "cli/ensemble/sweep_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "cli/ensemble/calibration_file.h"
#include "cli/ensemble/equivalence_fit.h"
#include "cli/ensemble/output_scope.h"
#include "cli/ensemble/run_request.h"
#include "scree_version.h"

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

namespace scree {
namespace {

const fs::path kAssets = fs::path(SCREE_SOURCE_DIR) / "assets";
const std::string kScenario = std::string(SCREE_SOURCE_DIR) + "/scenarios/repose_lab.yaml";

class SweepFile : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("scree_sweep_" + std::to_string(getpid()));
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  SweepResult load(const std::string& text) {
    std::ofstream(folder / "friction.yaml") << "scenario: " << kScenario << "\n" << text;
    return load_sweep(folder / "friction.yaml", kAssets);
  }
  std::string first_error(const std::string& text) {
    const SweepResult result = load(text);
    return result.errors.empty() ? "" : result.errors.front().text();
  }
  fs::path folder;
};

TEST_F(SweepFile, GridIsEveryCombinationTheLastFastest) {
  const SweepResult r = load(
      "seeds: [4, 5]\nset: {experiment.mass_kg: 10}\n"
      "design: {type: grid, parameters: {material.mu: [0.1, 0.2], material.mu_r: [0.3, 0.4, 0.5]}}\n");
  ASSERT_TRUE(r.errors.empty()) << r.errors.front().text();
  EXPECT_EQ(r.sweep.name, "friction");
  EXPECT_THAT(r.sweep.parameters, ElementsAre("material.mu", "material.mu_r"));
  EXPECT_THAT(r.sweep.points[0].scenario.seeds, ElementsAre(4u, 5u));
  ASSERT_EQ(r.sweep.points.size(), 6u);
  EXPECT_THAT(r.sweep.points[0].values, ElementsAre("0.1", "0.3"));
  EXPECT_THAT(r.sweep.points[1].values, ElementsAre("0.1", "0.4"));
  EXPECT_THAT(r.sweep.points[5].values, ElementsAre("0.2", "0.5"));
  EXPECT_EQ(r.sweep.points[5].scenario.material.mu, 0.2);
  EXPECT_EQ(r.sweep.points[5].scenario.material.mu_r, 0.5);
  EXPECT_EQ(std::get<ReposeLift>(r.sweep.points[5].scenario.experiment).mass, 10);
}

TEST_F(SweepFile, EveryPointNamesItsPrintedCase) {
  const std::string grid =
      "design: {type: grid, parameters: {material.mu: [0.1, 0.2], material.mu_r: [0.4]}}\n";
  const SweepResult r = load("compare: \"lab_repose_{material.mu}_{material.mu_r}\"\n" + grid);
  ASSERT_TRUE(r.errors.empty()) << r.errors.front().text();
  EXPECT_EQ(r.sweep.points[1].compare, "lab_repose_0.2_0.4");
  EXPECT_THAT(first_error("compare: \"lab_{material.mu}\"\n" + grid),
              HasSubstr("compare: 'lab_0.1' is no case in assets/reference/results.csv"));
}

TEST_F(SweepFile, TiedKeyFollows) {
  const SweepResult r = load(
      "ties: {material.mu_r: material.mu}\ndesign: {type: list, points: [{material.mu: 0.25}, {material.mu: "
      "0.5}]}\n");
  ASSERT_TRUE(r.errors.empty()) << r.errors.front().text();
  EXPECT_EQ(r.sweep.points[0].scenario.material.mu_r, 0.25);
  EXPECT_EQ(r.sweep.points[1].scenario.material.mu_r, 0.5);
  EXPECT_EQ(r.sweep.points[0].scenario.seeds.size(), 10u) << "those of the scenario";
}

TEST_F(SweepFile, RandomDesignsStayInTheirRanges) {
  for (const char* type : {"latin_hypercube", "sobol"}) {
    const SweepResult r = load(std::string("design: {type: ") + type +
                               ", points: 20, parameters: {material.mu: {from: 0.2, to: 0.3}, "
                               "material.mu_r: {from: 0.4, to: 0.8}}}\n");
    ASSERT_TRUE(r.errors.empty()) << r.errors.front().text();
    ASSERT_EQ(r.sweep.points.size(), 20u);
    for (const SweepPoint& p : r.sweep.points) {
      EXPECT_GE(p.scenario.material.mu, 0.2);
      EXPECT_LE(p.scenario.material.mu, 0.3);
      EXPECT_GE(p.scenario.material.mu_r, 0.4);
      EXPECT_LE(p.scenario.material.mu_r, 0.8);
    }
  }
}

TEST_F(SweepFile, WrongOnesAreToldWithTheirPlace) {
  EXPECT_THAT(first_error("desing: {}\n"), HasSubstr("friction.yaml:2:1: unknown key 'desing'"));
  EXPECT_THAT(first_error("seeds: [1]\n"), HasSubstr("'design' is missing"));
  EXPECT_THAT(
      first_error(
          "design: {type: sobol, points: 4, seed: 5, parameters: {material.mu: {from: 0.1, to: 0.2}}}\n"),
      HasSubstr("unknown key 'seed' in sobol; allowed: type, parameters, points"));
  EXPECT_THAT(first_error("design: {type: cube}\n"), HasSubstr("one of grid, list, latin_hypercube, sobol"));
  EXPECT_THAT(first_error("design: {type: grid, parameters: {material.mu: 0.2}}\n"),
              HasSubstr("a list of values is expected"));
  EXPECT_THAT(first_error("design: {type: grid, parameters: {material.nu: [0.2]}}\n"),
              HasSubstr("a point is no scenario: --set material.nu=0.2"));
  EXPECT_THAT(first_error("design: {type: grid, parameters: {material.mu: [-1]}}\n"),
              HasSubstr("out of range"));
  EXPECT_THAT(first_error("design: {type: list, points: [{material.mu: 0.2}, {material.mu_r: 0.2}]}\n"),
              HasSubstr("material.mu is missing"));
  EXPECT_THAT(
      first_error("design: {type: sobol, points: 0, parameters: {material.mu: {from: 0.1, to: 0.2}}}\n"),
      HasSubstr("an integer from 1"));
  EXPECT_THAT(
      first_error("design: {type: sobol, points: 4, parameters: {material.mu: {from: 0.3, to: 0.2}}}\n"),
      HasSubstr("must be above"));
  EXPECT_THAT(first_error("ties: {material.mu_r: material.alpha}\n"
                          "design: {type: grid, parameters: {material.mu: [0.2]}}\n"),
              HasSubstr("is no parameter; there are material.mu"));
  EXPECT_THAT(first_error("seeds: [3, 3]\ndesign: {type: grid, parameters: {material.mu: [0.2]}}\n"),
              HasSubstr("stands twice"));
  EXPECT_THAT(load_sweep(folder / "missing.yaml", kAssets).errors.front().text(), HasSubstr("no such file"));
}

TEST(EnsembleFiles, ThoseOfTheProjectLoad) {
  int files = 0;
  for (const auto& item : fs::directory_iterator(fs::path(SCREE_SOURCE_DIR) / "scenarios" / "sweeps")) {
    const SweepResult r = load_sweep(item.path(), kAssets);
    EXPECT_TRUE(r.errors.empty()) << r.errors.front().text();
    ++files;
  }
  for (const auto& item : fs::directory_iterator(fs::path(SCREE_SOURCE_DIR) / "scenarios" / "calibrations")) {
    const std::vector<ScenarioError> errors = is_equivalence(item.path())
                                                  ? load_equivalence(item.path()).errors
                                                  : load_calibration(item.path()).errors;
    EXPECT_TRUE(errors.empty()) << errors.front().text();
    ++files;
  }
  EXPECT_GE(files, 4);
}

TEST_F(SweepFile, CasesWithFewerSeedsThanAskedForAreNamed) {
  const fs::path file = folder / "case.yaml";
  std::ofstream(file) << "extends: " << SCREE_SOURCE_DIR << "/scenarios/quick_dump.yaml\nseeds: [7, 8]\n";
  EXPECT_TRUE(load_cases({file}, 2, kAssets).warnings.empty());
  EXPECT_TRUE(load_cases({file}, 0, kAssets).warnings.empty());
  const SweepResult r = load_cases({file}, 5, kAssets);
  ASSERT_TRUE(r.errors.empty()) << r.errors.front().text();
  EXPECT_THAT(r.sweep.points[0].scenario.seeds, ElementsAre(7u, 8u));
  EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("case.yaml: 5 seeds are asked for, its file has 2")));
}

TEST_F(SweepFile, CasesPassOnWhatTheirScenariosAreWarnedOf) {
  // A sheet of two triangles is not closed, which is said.
  std::ofstream(folder / "sheet.stl")
      << "solid t\n"
         "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 4 0\nvertex 0 0 2\n"
         "endloop\nendfacet\n"
         "facet normal 0 0 0\nouter loop\nvertex 0 4 0\nvertex 0 4 2\nvertex 0 0 2\n"
         "endloop\nendfacet\nendsolid t\n";
  const fs::path file = folder / "case.yaml";
  std::ofstream(file)
      << "extends: " << SCREE_SOURCE_DIR
      << "/scenarios/quick_dump.yaml\ntools: [{name: a, mesh: sheet.stl, keyframes: [{time_s: 0}]}]\n";
  const SweepResult r = load_cases({file}, 1, kAssets);
  ASSERT_TRUE(r.errors.empty()) << r.errors.front().text();
  EXPECT_THAT(r.warnings, ElementsAre(HasSubstr("case.yaml:2:")));
}

TEST_F(SweepFile, OutputsAreThoseOfAnyPoint) {
  const fs::path file = folder / "sections.yaml";
  std::ofstream(file)
      << "scenario: " << SCREE_SOURCE_DIR
      << "/scenarios/quick_dump.yaml\ndesign: {type: grid, parameters: {output.sections: [4, 5]}}\n";
  const SweepResult r = load_sweep(file, kAssets);
  ASSERT_TRUE(r.errors.empty()) << r.errors.front().text();
  EXPECT_EQ(why_not_given(r.sweep, "chi_S5"), "");
  EXPECT_THAT(why_not_given(r.sweep, "chi_S6"), HasSubstr("cuts the slope into 4 sections"));
  EXPECT_THAT(why_not_given(r.sweep.points[0].scenario, "chi_S5"),
              HasSubstr("4 sections, without 'of' (output.sections)"));
}

TEST_F(SweepFile, PassingCurveIsATargetForItsDiameters) {
  std::ofstream(folder / "curve.csv") << "diameter_mm,passing_pct\n100,0\n1000,100\n";
  const fs::path file = folder / "calibration.yaml";
  const auto load = [&](const std::string& target) {
    std::ofstream(file)
        << "scenario: " << SCREE_SOURCE_DIR
        << "/scenarios/quick_dump.yaml\nseeds: [1]\nparameters: {material.mu: {from: 0.1, to: 0.4}}\n"
           "targets: [{passing_curve: curve.csv, section: S6"
        << target << "}]\n";
    return load_calibration(file);
  };
  const CalibrationSpecResult r = load(", uncertainty: 0.05");
  ASSERT_TRUE(r.errors.empty()) << r.errors.front().text();
  ASSERT_EQ(r.spec.targets.size(), 4u);
  EXPECT_EQ(r.spec.targets[1].output, "d50_m_S6");
  // Linear in the logarithm: D_x = 0.1 m * 10^x.
  EXPECT_NEAR(r.spec.targets[1].value, 0.1 * std::sqrt(10.0), 1e-9);
  EXPECT_NEAR(r.spec.targets[1].uncertainty, 0.05 * (std::pow(10, 0.55) - std::pow(10, 0.45)), 1e-9);
  EXPECT_THAT(load("").errors.front().text(), HasSubstr("passing_curve, section and uncertainty are needed"));
  EXPECT_THAT(load(", uncertainty: 3").errors.front().text(), HasSubstr("uncertainty: of a passing share"));
  fs::remove(folder / "curve.csv");
  EXPECT_THAT(load(", uncertainty: 0.05").errors.front().text(), HasSubstr("passing_curve: "));
}

TEST_F(SweepFile, KeyIsThatOfTheNumbersAlone) {
  const auto key = [&](const std::vector<std::string>& overrides, std::uint64_t seed, const char* version) {
    ScenarioResult loaded = load_scenario(kScenario, overrides, kAssets);
    EXPECT_TRUE(loaded.errors.empty());
    return run_request(loaded.scenario, seed, version, kAssets).key;
  };
  const std::string key0 = key({}, 1, "1");
  EXPECT_EQ(key0.size(), 32u);
  EXPECT_EQ(key({"title=Another", "output.frame_interval_s=0.5", "compare=[]"}, 1, "1"), key0);
  EXPECT_NE(key({}, 2, "1"), key0);
  EXPECT_NE(key({}, 1, "2"), key0);
  EXPECT_NE(key({"material.mu=0.21"}, 1, "1"), key0);
  // The content of a file counts, not its name.
  fs::copy(kAssets / "gradings" / "Lab0.csv", folder / "mine.csv");
  const std::string mine = "grading=" + (folder / "mine.csv").string();
  EXPECT_EQ(key({mine}, 1, "1"), key0);
  std::ofstream(folder / "mine.csv", std::ios::app) << "\n";
  EXPECT_NE(key({mine}, 1, "1"), key0);
}

TEST_F(SweepFile, ResolvedScenarioIsOneItself) {
  ScenarioResult loaded = load_scenario(kScenario, {}, kAssets);
  const RunRequest request = run_request(loaded.scenario, 17, "1", kAssets);
  std::ofstream(folder / "resolved.yaml") << request.scenario;
  ScenarioResult again = load_scenario(folder / "resolved.yaml", {}, kAssets);
  ASSERT_TRUE(again.errors.empty()) << again.errors.front().text();
  EXPECT_THAT(again.scenario.seeds, ElementsAre(17u));
  EXPECT_EQ(run_request(again.scenario, 17, "1", kAssets).key, request.key);
}

}  // namespace
}  // namespace scree
