#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/results/summary.h"
#include "sim/material/input_bytes.h"

namespace scree {
namespace {

constexpr std::uintmax_t kMostSummaryBytes = 100'000'000;

}  // namespace

StoredRun parse_summary(const std::string& text) {
  StoredRun run;
  try {
    const auto json = nlohmann::json::parse(text);
    run.title = json.at("title").get<std::string>();
    run.interrupted = json.value("interrupted", false);
    for (const auto& seed : json.at("per_seed")) {
      if (!seed.at("seed").is_number_unsigned())
        throw std::runtime_error("not a summary of scree: a seed is no integer of 0 or more");
      run.seeds.push_back(seed.at("seed").get<std::uint64_t>());
      run.outputs.push_back(seed.at("outputs").get<Outputs>());
      run.wall_seconds.push_back(seed.value("wall_seconds", 0.0));
    }
    for (const auto& row : json.at("comparison")) {
      const auto name = row.at("case").get<std::string>();
      if (std::find(run.cases.begin(), run.cases.end(), name) == run.cases.end()) run.cases.push_back(name);
    }
  } catch (const nlohmann::json::parse_error& error) {
    throw std::runtime_error(
        fmt::format("not a summary of scree, or cut short: no JSON at byte {}", error.byte));
  } catch (const nlohmann::json::exception& error) {
    const std::string what = error.what();  // "[json.exception.type_error.302] type must be ..."
    throw std::runtime_error(fmt::format("not a summary of scree: {}", what.substr(what.find(' ') + 1)));
  }
  return run;
}

StoredRun read_summary(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none))
    throw FileError(file, 0, "cannot be read; is this the folder of a finished run?");
  const std::string text = read_input_text(file, kMostSummaryBytes);
  try {
    return parse_summary(text);
  } catch (const std::runtime_error& error) {
    throw FileError(file, 0, error.what());
  }
}

}  // namespace scree
