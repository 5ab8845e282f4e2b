#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/summary.h"

namespace scree {
namespace {

using Json = nlohmann::json;

double number(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

// One table of sections, spread over the seeds.
void read_table(const Json& sections, const Json& per_seed, std::vector<SeedResult>& seeds) {
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    const Json& curves = per_seed.at(k).at("tables").at(seeds[k].sections.size());
    SectionTable table;
    table.dumps = curves.at("dumps").get<int>();
    table.sieves = curves.at("sieves_m").get<std::vector<double>>();
    table.original_passing = curves.at("original_passing").get<std::vector<double>>();
    for (const Json& s : sections) {
      const auto of = [&](const char* name) { return number(s.at(name).at("per_seed").at(k)); };
      Section section;
      section.name = s.at("name").get<std::string>();
      section.x_over_l = s.at("x_over_l").get<double>();
      section.mass = 1000 * of("mass_t");
      section.grains = static_cast<int>(of("grains"));
      section.chi = of("chi");
      section.d10 = of("d10_m"), section.d15 = of("d15_m"), section.d50 = of("d50_m");
      section.d80 = of("d80_m"), section.d90 = of("d90_m"), section.d95 = of("d95_m");
      section.d10_rel = of("d10_rel"), section.d50_rel = of("d50_rel"), section.d80_rel = of("d80_rel");
      section.d90_rel = of("d90_rel"), section.d95_rel = of("d95_rel");
      section.passing = curves.at("section_passing").at(table.sections.size()).get<std::vector<double>>();
      table.sections.push_back(section);
    }
    seeds[k].sections.push_back(std::move(table));
  }
}

}  // namespace

StoredRun read_summary(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in)
    throw std::runtime_error(
        fmt::format("{}: cannot be read; is this the folder of a finished run?", file.string()));
  StoredRun run;
  try {
    const Json json = Json::parse(in);
    run.title = json.at("title").get<std::string>();
    for (const Json& seed : json.at("seeds")) {
      run.seeds.emplace_back();
      run.seeds.back().seed = seed.get<std::uint64_t>();
    }
    if (json.contains("sections") && !json.at("sections").empty())
      read_table(json.at("sections"), json.at("per_seed"), run.seeds);
    if (json.contains("further_sections"))
      for (const Json& table : json.at("further_sections"))
        read_table(table.at("sections"), json.at("per_seed"), run.seeds);
    if (json.contains("repose") && !json.at("repose").is_null()) {
      const Json& repose = json.at("repose");
      for (std::size_t k = 0; k < run.seeds.size(); ++k) {
        ReposeAngle angle;
        angle.angle = number(repose.at("angle_deg").at("per_seed").at(k));
        angle.half_coverage = number(repose.at("half_coverage_deg").at("per_seed").at(k));
        angle.height_over_radius = number(repose.at("height_over_radius_deg").at("per_seed").at(k));
        run.seeds[k].repose = angle;
      }
    }
    if (json.contains("rebound_height_m"))
      for (std::size_t k = 0; k < run.seeds.size(); ++k)
        run.seeds[k].rebound_height = json.at("rebound_height_m").at("per_seed").at(k).get<double>();
    for (const Json& row : json.at("comparison")) {
      const auto name = row.at("case").get<std::string>();
      if (std::find(run.cases.begin(), run.cases.end(), name) == run.cases.end()) run.cases.push_back(name);
    }
  } catch (const Json::exception& error) {
    throw std::runtime_error(fmt::format("{}: not a summary of scree: {}", file.string(), error.what()));
  }
  return run;
}

}  // namespace scree
