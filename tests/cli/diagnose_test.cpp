// Datasets as others keep them, given to `scree diagnose`: what is understood is said, what is not is refused
// in one line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "scree_version.h"
#include "tests/cli/call.h"

namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class DiagnoseCli : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("scree_diagnose_cli_" + std::to_string(getpid()));
    fs::create_directories(folder);
    put("model.yaml",
        "parameters:\n  material.mu: {nominal: 0.4, from: 0.3, to: 0.5}\neffects: [cohesion, "
        "release_speed]\n");
  }
  void TearDown() override { fs::remove_all(folder); }
  void put(const std::string& name, const std::string& text) { std::ofstream(folder / name) << text; }
  // What diagnose says before it would simulate.
  Called planned(const std::string& table, const std::string& more = "", const std::string& options = "") {
    put("sieved.csv", table);
    put("data.yaml", "experiments:\n  dump: {scenario: " + std::string(SCREE_SOURCE_DIR) +
                         "/scenarios/small_dump.yaml}\nobservables: sieved.csv\n" + more);
    return call("diagnose " + (folder / "data.yaml").string() + " --model " +
                (folder / "model.yaml").string() + " --store " + (folder / "store.sqlite").string() +
                " --plan " + options);
  }
  fs::path folder;
};

TEST_F(DiagnoseCli, TheModelFileOfTheManualIsOne) {
  std::istringstream manual(slurp(fs::path(SCREE_SOURCE_DIR) / "docs/diagnose.md"));
  std::string model;
  bool there = false;
  for (std::string line; std::getline(manual, line);) {
    if (line.starts_with("#")) there = line == "## The model file";
    if (there && line.starts_with("    ")) model += line.substr(4) + "\n";
  }
  const std::string scenario = "../drop_test.yaml";
  const auto at = model.find(scenario);
  ASSERT_NE(at, std::string::npos) << model;
  put("manual.yaml", model.replace(at, scenario.size(), SCREE_SOURCE_DIR "/scenarios/drop_test.yaml"));
  const Called said = call("validate " + (folder / "manual.yaml").string());
  EXPECT_EQ(said.code, 0) << said.text;
  EXPECT_THAT(said.text, HasSubstr("ok: model, parameters material.mu, material.mu_r"));
}

// What chance hides is drawn from effects that act; here none does.
TEST_F(DiagnoseCli, ATwinHidesOnlyWhatActs) {
  const std::string fall =
      "parameters: {material.local_damping: {nominal: 0.4, from: 0.3, to: 0.5}}\n"
      "experiments: {fall: {scenario: " SCREE_SOURCE_DIR
      "/scenarios/drop_test.yaml, observables: [rebound_height_m], errors: {rebound_height_m: 0.01}}}\n";
  put("fall.yaml", fall + "effects: [release_speed, image_blur]\n");
  put("all.yaml", fall + "set: {effects.cohesion.bond_number: 0.1}\n");
  const auto twin = [&](const std::string& model, const std::string& more) {
    return call("twin " + (folder / model).string() + " --store " + (folder / "store.sqlite").string() +
                " --strength medium --out " + (folder / "out").string() + more);
  };
  const std::string none = "--effect image_blur: cannot be hidden in the model's experiments: ";
  EXPECT_THAT(twin("fall.yaml", " --effect image_blur").text, HasSubstr(none + "changes nothing"));
  const Called given = twin("all.yaml", " --effect cohesion");
  EXPECT_EQ(given.code, 2);
  EXPECT_THAT(given.text, HasSubstr("the model gives it"));
  EXPECT_FALSE(fs::exists(folder / "out"));
  for (const char* seed : {" --seed 1", " --seed 2", " --seed 3", " --seed 4"}) {
    const Called made = twin("fall.yaml", std::string(" --force") + seed);
    EXPECT_EQ(made.code, 0) << made.text;
    EXPECT_THAT(slurp(folder / "out.answer.json"), HasSubstr("\"effects\": []"));
  }
}

TEST_F(DiagnoseCli, ASpreadsheetIsRead) {
  // Semicolons, decimal commas, millimetres, kilograms, columns of others.
  const Called plan = planned(
      "Date;Experiment;Observable;Value;Unit;Std;Repeats;Who\n"
      "3 May;dump;d50_m_S3;612,5;mm;40;5;AB\n"
      "3 May;dump;mass_t_S1;3450;kg;400;5;AB\n"
      "4 May;dump;slope_angle_deg;26,1;deg;1,2;5;CD\n");
  EXPECT_EQ(plan.code, 0) << plan.text;
  EXPECT_THAT(plan.text, HasSubstr("columns that are not read: Date, Who"));
  // 6 nominal, 24 over the parameter, 10 of each of two effects.
  EXPECT_THAT(plan.text, HasSubstr("50 simulations, 0 in the store"));
}

TEST_F(DiagnoseCli, WhatIsMissingIsAskedFor) {
  const std::string head = "experiment,observable,value,unit,uncertainty\n";
  const Called none = planned(head + "dump,d50_m_S3,612,mm,\n");
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.text,
              HasSubstr("sieved.csv:2: dump/d50_m_S3: no uncertainty. Give `uncertainty`, or `std` and"));
  const Called assumed = planned(head + "dump,d50_m_S3,612,mm,\n", "default_relative_uncertainty: 0.1\n");
  EXPECT_EQ(assumed.code, 0) << assumed.text;
  EXPECT_THAT(assumed.text, HasSubstr("1 of 1 uncertainties are assumed: 10 % of the value"));
  const Called sections = planned(head + "dump,chi_S6,0.3,-,0.05\n");
  EXPECT_EQ(sections.code, 2);
  EXPECT_THAT(sections.text, AllOf(HasSubstr("chi_S6"), HasSubstr("cuts the slope into 3 sections")));
  const Called unit = planned(head + "dump,d50_m_S3,24,inches,1\n");
  EXPECT_EQ(unit.code, 2);
  EXPECT_THAT(unit.text, HasSubstr("unit 'inches' does not fit; allowed: m, cm, mm"));
  const Called without = planned(head + "dump,chi_S3,0.3,-,0.05\n", "", "--without cohesoin");
  EXPECT_EQ(without.code, 2);
  EXPECT_THAT(without.text, HasSubstr("--without cohesoin: no such effect (did you mean 'cohesion'?)"));
  for (const Called* each : {&none, &sections, &unit, &without})
    EXPECT_THAT(each->text, Not(HasSubstr("simulations")));
}

}  // namespace
