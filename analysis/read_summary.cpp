#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "analysis/summary.h"

namespace scree {

StoredRun parse_summary(const std::string& text) {
  StoredRun run;
  try {
    const auto json = nlohmann::json::parse(text);
    run.title = json.at("title").get<std::string>();
    for (const auto& seed : json.at("per_seed")) {
      run.seeds.push_back(seed.at("seed").get<std::uint64_t>());
      run.outputs.push_back(seed.at("outputs").get<Outputs>());
    }
    for (const auto& row : json.at("comparison")) {
      const auto name = row.at("case").get<std::string>();
      if (std::find(run.cases.begin(), run.cases.end(), name) == run.cases.end()) run.cases.push_back(name);
    }
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(fmt::format("not a summary of scree: {}", error.what()));
  }
  return run;
}

StoredRun read_summary(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in)
    throw std::runtime_error(
        fmt::format("{}: cannot be read; is this the folder of a finished run?", file.string()));
  std::ostringstream text;
  text << in.rdbuf();
  try {
    return parse_summary(text.str());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), error.what()));
  }
}

}  // namespace scree
