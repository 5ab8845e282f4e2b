// The table of a simulated pile's conductivity.
#include "analysis/report/conductivity_table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/analysis/fake_run.h"

namespace scree {
namespace {

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) out.push_back(field);
  return out;
}

TEST(ConductivityTable, SectionsToeOverCrestAndCells) {
  RunResult result;
  result.seeds.push_back(fake_seed(1));
  SeedResult& seed = result.seeds.front();
  VerticalSection section;
  section.half_width = 4;
  section.cell = 2;
  seed.inside = analyse_inside(seed.final_state.grains, {}, seed.original, section);
  const auto file =
      std::filesystem::temp_directory_path() / ("scree_ksat_" + std::to_string(getpid()) + ".csv");
  write_conductivity_csv(result, file);
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> header = fields(line);
  std::map<std::string, std::vector<std::string>> parts;
  int cells = 0;
  while (std::getline(in, line)) {
    const std::vector<std::string> row = fields(line);
    parts[row[1]] = row;
    cells += row[1] == "cell";
  }
  std::filesystem::remove(file);
  const auto number = [&](const std::string& part, const std::string& column) {
    const auto at = std::find(header.begin(), header.end(), column) - header.begin();
    return std::stod(parts.at(part).at(static_cast<std::size_t>(at)));
  };
  ASSERT_TRUE(parts.contains("S1") && parts.contains("S6") && parts.contains("S6/S1"));
  EXPECT_GT(cells, 10);
  const SectionTable& table = seed.sections.front();
  for (const Section& s : table.sections) {
    EXPECT_NEAR(number(s.name, "ksat_kcm_rel"), s.ksat_rel, 1e-4 * s.ksat_rel) << s.name;
    EXPECT_NEAR(number(s.name, "ksat_taylor_rel"), std::pow(s.d50_rel, 1.5), 1e-4 * std::pow(s.d50_rel, 1.5))
        << s.name;
  }
  EXPECT_NEAR(number("S6/S1", "ksat_kcm_rel"),
              table.sections.back().ksat_rel / table.sections.front().ksat_rel,
              1e-4 * number("S6/S1", "ksat_kcm_rel"));
}

TEST(ConductivityTable, NothingForARunWithoutSections) {
  RunResult result;
  result.seeds.push_back(fake_seed(1));
  result.seeds.front().sections.clear();
  const auto file =
      std::filesystem::temp_directory_path() / ("scree_ksat_none_" + std::to_string(getpid()) + ".csv");
  write_conductivity_csv(result, file);
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace scree
