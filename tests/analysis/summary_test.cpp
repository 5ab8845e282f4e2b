#include "analysis/results/summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "tests/analysis/fake_run.h"

namespace scree {
namespace {

using nlohmann::json;

std::filesystem::path fresh_folder(const std::string& name) {
  const auto folder = std::filesystem::path(testing::TempDir()) / ("scree_summary_" + name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

json read(const std::filesystem::path& file) {
  std::ifstream in(file);
  return json::parse(in);
}

TEST(Summary, TellsTheWholeRun) {
  const auto file = fresh_folder("whole") / "summary.json";
  const RunResult run = fake_run();
  write_summary(run, file);
  const json summary = read(file);

  EXPECT_EQ(summary["scenario"], "end_dump_10m");
  EXPECT_EQ(summary["title"], run.title);
  EXPECT_EQ(summary["seeds"], json({10001, 10002}));
  EXPECT_EQ(summary["particles"], 10000);
  EXPECT_EQ(summary["wall_seconds"], 845);
  EXPECT_DOUBLE_EQ(summary["simulated_seconds"], 123.0);
  EXPECT_DOUBLE_EQ(summary["particle_steps"], 2.4e9);
  EXPECT_DOUBLE_EQ(summary["largest_overlap_ratio"], 0.031);
  EXPECT_EQ(summary["lost_particles"], 6);
  EXPECT_NEAR(summary["lost_mass_t"], 0.48, 1e-12);
  EXPECT_EQ(summary["at_rest"], true);
  EXPECT_EQ(summary["notes"].size(), 1U);
  EXPECT_FALSE(summary.contains("repose"));

  ASSERT_EQ(summary["sections"].size(), 6U);
  const json& toe = summary["sections"][5];
  const double first = run.seeds[0].sections[0].sections[5].chi,
               second = run.seeds[1].sections[0].sections[5].chi;
  EXPECT_EQ(toe["name"], "S6");
  EXPECT_DOUBLE_EQ(toe["chi"]["per_seed"][1], second);
  EXPECT_DOUBLE_EQ(toe["chi"]["mean"], (first + second) / 2);
  // Standard deviation of two values with n - 1 = 1.
  EXPECT_NEAR(toe["chi"]["std"], std::abs(first - second) / std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(toe.contains("d10_rel"));
  EXPECT_EQ(summary["further_sections"][0]["n"], 3);
  EXPECT_EQ(summary["further_sections"][0]["sections"].size(), 3U);

  const json& row = summary["comparison"][6];
  EXPECT_EQ(row["quantity"], "d50_rel");
  EXPECT_EQ(row["reference"], 1.9);
  EXPECT_TRUE(row["z"].is_null());
  EXPECT_TRUE(row["reference_std"].is_null());
}

TEST(Summary, WritesWhatDoesNotExistAsNull) {
  const auto file = fresh_folder("null") / "summary.json";
  RunResult run = fake_run();
  run.seeds.pop_back();
  run.seeds[0].sections[0].sections[0].chi = std::numeric_limits<double>::quiet_NaN();
  write_summary(run, file);
  const json summary = read(file);
  EXPECT_TRUE(summary["sections"][0]["chi"]["per_seed"][0].is_null());
  EXPECT_TRUE(summary["sections"][0]["chi"]["mean"].is_null());
  EXPECT_TRUE(summary["sections"][1]["chi"]["std"].is_null()) << "one seed has no deviation";
}

TEST(Summary, HasTheReposeAngleOfEachSeed) {
  const auto file = fresh_folder("repose") / "summary.json";
  RunResult run;
  for (const double angle : {36.0, 38.0}) {
    SeedResult seed;
    seed.repose = ReposeAngle{};
    seed.repose->angle = angle;
    seed.heap = HeapShape{};
    seed.heap->rings.sections.resize(kHeapRings);
    seed.heap->profile[1] = angle / 100;
    run.seeds.push_back(seed);
  }
  write_summary(run, file);
  const json summary = read(file);
  EXPECT_EQ(summary["repose"]["angle_deg"]["mean"], 37.0);
  EXPECT_EQ(summary["repose"]["angle_deg"]["per_seed"], json({36.0, 38.0}));
  EXPECT_EQ(summary["heap"]["profile"][1]["height_share"]["mean"], 0.37);
  EXPECT_EQ(summary["heap"]["rings"].size(), 3U);
  EXPECT_TRUE(summary["sections"].empty());
}

TEST(Summary, AHeapWithoutARadiusHasNoRings) {
  const auto file = fresh_folder("no_radius") / "summary.json";
  RunResult run;
  run.seeds.resize(1);
  run.seeds[0].repose = measure_repose({});
  run.seeds[0].heap = HeapShape{};
  write_summary(run, file);
  const json summary = read(file);
  EXPECT_TRUE(summary["repose"]["radius_m"]["mean"].is_null());
  EXPECT_TRUE(summary["repose"]["runaways"]["mean"].is_null());
  EXPECT_TRUE(summary["heap"]["rings"][0]["grains"]["mean"].is_null());
}

TEST(Summary, SectionsCsvHasARowForEachSeedTableAndSection) {
  const auto file = fresh_folder("csv") / "sections.csv";
  RunResult run = fake_run();
  run.seeds[0].sections[0].sections[0].chi = std::numeric_limits<double>::quiet_NaN();
  write_sections_csv(run, file);
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line.substr(0, 56), "seed,sections,dumps,section,x_over_l,mass_t,grains,chi,d");
  const auto columns = std::count(line.begin(), line.end(), ',');
  int rows = 0;
  while (std::getline(in, line)) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns);
    if (rows == 0) {
      EXPECT_EQ(line.substr(0, 8), "10001,6,");
      EXPECT_THAT(line, testing::HasSubstr(",,")) << "NaN is empty";
    }
    ++rows;
  }
  EXPECT_EQ(rows, 2 * (6 + 3));
}

TEST(Summary, IsReadBackForComparison) {
  const auto file = fresh_folder("back") / "summary.json";
  RunResult run = fake_run();
  run.seeds[1].sections[0].sections[2].chi = std::numeric_limits<double>::quiet_NaN();
  write_summary(run, file);
  const StoredRun stored = read_summary(file);
  EXPECT_EQ(stored.seeds, (std::vector<std::uint64_t>{10001, 10002}));
  ASSERT_EQ(stored.outputs.size(), run.seeds.size());
  for (std::size_t k = 0; k < run.seeds.size(); ++k) {
    const Outputs& outputs = stored.outputs[k];
    EXPECT_EQ(outputs.contains("chi_S3"), k == 0) << "NaN is left out";
    const auto& tables = run.seeds[k].sections;
    EXPECT_DOUBLE_EQ(outputs.at("d50_rel_S2"), tables[0].sections[1].d50_rel);
    EXPECT_DOUBLE_EQ(outputs.at("chi_S2of3"), tables[1].sections[1].chi);
    EXPECT_NEAR(outputs.at("mass_t_S6"), tables[0].sections[5].mass / 1000, 1e-9);
    EXPECT_DOUBLE_EQ(outputs.at("slope_angle_deg"), *run.seeds[k].slope_angle);
  }
  std::ofstream(file) << "{\"title\": 3}";
  EXPECT_THROW(read_summary(file), std::runtime_error);
}

TEST(Summary, SaysWhichFileCannotBeWritten) {
  const auto file = fresh_folder("error") / "missing" / "summary.json";
  try {
    write_summary(fake_run(), file);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("missing/summary.json: No such file or directory"));
  }
}

}  // namespace
}  // namespace scree
