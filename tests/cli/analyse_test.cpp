// scree analyse and scree validate of datasets, as a user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "scree_version.h"
#include "tests/cli/call.h"

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

namespace {

class Analyse : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("scree_analyse_" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  // A cone of laboratory size and of this slope, of grains of 20 mm; `d`: length of a unit in m.
  std::string cone(const std::string& name, double slope, double unit = 1) {
    std::ofstream out(folder / name);
    out << "x,y,z,diameter\n";
    const double step = 0.015, radius = 0.45;
    for (int i = -30; i <= 30; ++i)
      for (int j = -30; j <= 30; ++j)
        for (int k = 0; k < 30; ++k)
          if (k * step <= slope * (radius - step * std::hypot(i, j)))
            out << i * step / unit << "," << j * step / unit << "," << (k * step + 0.01) / unit << ","
                << (k % 3 == 0 ? 0.016 : 0.02) / unit << "\n";
    return (folder / name).string();
  }
  // A number of the table by name and column: 2 the mean, 3 the deviation.
  static double value(const std::string& text, const std::string& name, int column = 2) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string word;
      words >> word;
      if (word != name) continue;
      for (int k = 0; k < column; ++k) words >> word;
      return std::stod(word);
    }
    ADD_FAILURE() << name << " is not in\n" << text;
    return NAN;
  }
  fs::path folder;
  const std::string source = SCREE_SOURCE_DIR;
  const std::string repose = " --scenario " + source + "/scenarios/repose_lab.yaml";
};

TEST_F(Analyse, RepeatsBecomeADataset) {
  const std::string files = cone("a.csv", 0.45) + " " + cone("b.csv", 0.5) + " " + cone("c.csv", 0.55);
  const std::string out = (folder / "measured").string();
  const Called made = call("analyse " + files + repose + " --out " + out);
  ASSERT_EQ(made.code, 0) << made.text;
  EXPECT_NEAR(value(made.text, "angle_deg"), std::atan(0.5) * 180 / std::numbers::pi, 1.5);
  EXPECT_GT(value(made.text, "angle_deg", 3), 1);
  EXPECT_THAT(made.text, HasSubstr("chi_ring1"));
  EXPECT_THAT(made.text, HasSubstr("2760 kg/m3"));
  EXPECT_THAT(made.text, Not(HasSubstr("largest_overlap_ratio")));

  const Called checked = call("validate " + out + "/dataset.yaml");
  ASSERT_EQ(checked.code, 0) << checked.text;
  EXPECT_THAT(checked.text, HasSubstr("repose_lab/angle_deg"));
  EXPECT_THAT(checked.text, HasSubstr("experiment repose_lab: "));
  EXPECT_THAT(checked.text, HasSubstr("independent"));
  const Called chosen =
      call("analyse " + files + repose + " --force --observables angle_deg,height_m --out " + out);
  ASSERT_EQ(chosen.code, 0) << chosen.text;
  EXPECT_THAT(chosen.text, HasSubstr("(2 observables)"));
  EXPECT_EQ(call("analyse " + files + repose + " --out " + out).code, 2) << "the folder is not empty";
}

TEST_F(Analyse, UnitsAndAxesGiveTheSamePile) {
  const Called metres = call("analyse " + cone("a.csv", 0.5) + repose);
  const Called millimetres = call("analyse " + cone("b.csv", 0.5, 1e-3) + repose + " --length-unit mm");
  ASSERT_EQ(metres.code, 0) << metres.text;
  ASSERT_EQ(millimetres.code, 0) << millimetres.text;
  EXPECT_EQ(value(metres.text, "angle_deg"), value(millimetres.text, "angle_deg"));
  EXPECT_EQ(value(metres.text, "spread_95"), value(millimetres.text, "spread_95"));
  const Called high = call("analyse " + (folder / "a.csv").string() + repose + " --shift 0,0,5");
  EXPECT_THAT(high.text, HasSubstr("the floor must be z = 0"));
  const Called alone = call("analyse " + (folder / "a.csv").string() + " --experiment repose_lift");
  ASSERT_EQ(alone.code, 0) << alone.text;
  EXPECT_EQ(value(alone.text, "angle_deg"), value(metres.text, "angle_deg"));
}

TEST_F(Analyse, OwnTrajectoryGivesTheNumbersOfItsRun) {
  const std::string scenario = source + "/scenarios/quick_dump.yaml";
  const std::string small =
      " --set experiment.payload_t=10 --set experiment.bench.height_m=3 --set experiment.bench.width_m=30"
      " --set experiment.bench.top_length_m=10 --set experiment.bench.floor_length_m=15";
  const fs::path out = folder / "run";
  const Called run = call("run " + scenario + small + " --summary-only --out " + out.string());
  ASSERT_EQ(run.code, 0) << run.text;
  const Called read =
      call("analyse " + (out / "seed_10001/particles.h5").string() + " --scenario " + scenario + small);
  ASSERT_EQ(read.code, 0) << read.text;
  const auto outputs = nlohmann::json::parse(slurp(out / "summary.json"))["per_seed"][0]["outputs"];
  for (const char* name :
       {"chi_S1", "chi_S4", "d50_m_S2", "mass_t_S4", "slope_angle_deg", "inside_porosity"}) {
    if (!outputs.contains(name)) continue;
    const double expected = outputs[name].get<double>();
    EXPECT_NEAR(value(read.text, name), expected, 2e-3 * std::max(0.1, std::abs(expected))) << name;
  }
}

TEST_F(Analyse, WrongCallsSayTheWayOut) {
  const std::string file = cone("a.csv", 0.5);
  const auto text = [](const std::string& arguments) {
    const Called result = call("analyse " + arguments);
    EXPECT_EQ(result.code, 2) << result.text;
    return result.text;
  };
  EXPECT_THAT(text(file), HasSubstr("--scenario FILE or --experiment TYPE is needed"));
  EXPECT_THAT(text(file + " --experiment end_dump"), HasSubstr("--scenario FILE"));
  EXPECT_THAT(text(file + " --experiment heap"), HasSubstr("repose_lift or bucket_dump"));
  EXPECT_THAT(text(file + repose + " --out " + (folder / "x").string()),
              HasSubstr("--relative-uncertainty 0.1"));
  EXPECT_FALSE(fs::exists(folder / "x"));
  EXPECT_THAT(text(file + repose + " --length-unit ft"), HasSubstr("one of m, cm, mm"));
  EXPECT_THAT(text(file + repose + " --shift 1,2"), HasSubstr("three numbers"));
  EXPECT_THAT(text(file + repose + " --frame 2"), HasSubstr("frame 2: a table has one"));
  EXPECT_THAT(text(file + repose + " --observables beauty"), HasSubstr("these piles do not give it"));
  EXPECT_THAT(text((folder / "none.csv").string() + repose), HasSubstr("there is no such file"));
  EXPECT_THAT(text(file + " --scenario " + source + "/scenarios/drop_test.yaml"),
              HasSubstr("leaves no pile"));
  const Called one =
      call("analyse " + file + repose + " --relative-uncertainty 0.1 --out " + (folder / "x").string());
  EXPECT_EQ(one.code, 0) << one.text;
}

TEST_F(Analyse, ValidateNamesWhatIsWrongWithADataset) {
  const fs::path file = folder / "dataset.yaml";
  std::ofstream(folder / "o.csv") << "experiment,observable,value\nheap,angle_deg,25\n";
  std::ofstream(file) << "experiments: {heap: {scenario: " << source
                      << "/scenarios/repose_lab.yaml}}\nobservables: o.csv\n";
  const Called wrong = call("validate " + file.string());
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.text, HasSubstr("o.csv:2: heap/angle_deg: no uncertainty"));
  EXPECT_EQ(call("validate " + file.string() + " --set material.mu=1").code, 2);
}

// The bench of small_dump: 4 m, its face at 45 degrees. A pile on it at 37 degrees, mirrored, and shifted.
TEST_F(Analyse, APileThatIsNotAtTheBenchIsNoted) {
  const auto pile = [&](const std::string& name, double sign, double shift) {
    std::ofstream out(folder / name);
    out << "x,y,z,diameter\n";
    const double fall = std::tan(37 * std::numbers::pi / 180), d = 0.3;
    for (double x = 0; x < 4 / fall; x += d)
      for (double y = -3; y <= 3; y += d)
        for (double z = std::max(4 - x, 0.0) + d / 2; z <= std::max(4 - x * fall, d); z += d)
          out << sign * x + shift << "," << y << "," << z << "," << d << "\n";
    out.close();
    return call("analyse " + (folder / name).string() + " --scenario " + source +
                "/scenarios/small_dump.yaml")
        .text;
  };
  const std::string there = pile("there.csv", 1, 0), mirrored = pile("mirrored.csv", -1, 0),
                    shifted = pile("shifted.csv", 1, 45);
  EXPECT_THAT(there, HasSubstr("slope_angle_deg"));
  const std::string inside = "of the mass lies behind the crest (x < 0)", beyond = "beyond the toe (x = 4 m)",
                    no_angle =
                        "note: no slope angle; too little of the pile's surface lies between 0.6 and 3.4 m";
  for (const std::string& note : {inside, beyond, no_angle}) EXPECT_THAT(there, Not(HasSubstr(note)));
  EXPECT_THAT(mirrored, HasSubstr(inside));
  EXPECT_THAT(mirrored, Not(HasSubstr(beyond)));
  EXPECT_THAT(mirrored, HasSubstr(no_angle));
  EXPECT_THAT(shifted, HasSubstr("100 % of the mass lies more than 2 m " + beyond));
}

}  // namespace
