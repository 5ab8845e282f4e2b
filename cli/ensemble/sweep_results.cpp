#include "cli/ensemble/sweep_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "analysis/results/outputs.h"
#include "cli/ensemble/run_request.h"
#include "sim/io/text_file.h"
#include "sim/material/input_text.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const std::string kTableOf = "Runs of sweep ";  // comment at the head of a table

const char* name_of(RunState state) {
  return state == RunState::done ? "done" : state == RunState::failed ? "failed" : "running";
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : c == '\n' || c == '\r' ? " " : std::string(1, c);
  return out + "\"";
}

std::optional<std::uint64_t> seed_in(const std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Throws if a table says that it is of another sweep.
void check_sweep(const Sweep& sweep, const DelimitedTable& table, const fs::path& file) {
  for (const auto& [line, text] : table.comments())
    if (text.starts_with(kTableOf) && text.substr(kTableOf.size()) != sweep.name)
      throw FileError(
          file, line,
          fmt::format("these are runs of sweep {}, not of {}", text.substr(kTableOf.size()), sweep.name));
}

// Throws if the columns are not those of a table of this sweep.
void check_columns(const Sweep& sweep, const DelimitedTable& table) {
  std::vector<std::string> expected = sweep.parameters;
  expected.insert(expected.end(), {"seed", "state", "version", "wall_seconds"});
  const std::vector<std::string>& header = table.header();
  if (header.size() < expected.size() + 1 || !std::equal(expected.begin(), expected.end(), header.begin()) ||
      header.back() != "message")
    table.fail(fmt::format("not a table of this sweep: its columns begin with {} and end with message",
                           fmt::join(expected, ",")));
}

// What this row says of a run; none if it was not run to its end.
std::optional<StoredResult> run_in(const DelimitedTable& table, std::size_t state) {
  const std::string& name = table.field(state);
  if (name == "not run" || name == "running") return std::nullopt;
  if (name != "done" && name != "failed")
    table.fail(fmt::format("state '{}' is none of done, failed, running, not run", name));
  StoredResult run;
  run.state = name == "done" ? RunState::done : RunState::failed;
  run.version = table.field(state + 1);
  run.wall_seconds = table.number(state + 2).value_or(0);
  const std::size_t message = table.header().size() - 1;
  run.message = table.field(message);
  for (std::size_t k = state + 3; k < message; ++k)
    if (const auto value = table.number(k)) run.outputs[table.header()[k]] = *value;
  return run;
}

// `run`: the numbers of some run.
bool is_reading_of(const std::string& output, const ReferenceValue& printed, const Outputs& run) {
  if (meaning_of(printed) != Meaning::value) return false;
  if (printed.quantity == "angle" && (output == "height_over_radius_deg" || output == "half_coverage_deg"))
    return true;
  return output_name_for(pile_value(printed), run) == output;
}

}  // namespace

std::vector<RunRequest> requests_of(const Sweep& sweep, const fs::path& asset_dir) {
  std::vector<RunRequest> requests;
  for (const SweepPoint& point : sweep.points)
    for (const std::uint64_t seed : point.scenario.seeds)
      requests.push_back(run_request(point.scenario, seed, results_version(), asset_dir));
  return requests;
}

std::vector<PointResults> look_up(const Sweep& sweep, const std::vector<RunRequest>& requests,
                                  const ResultsStore& store) {
  std::vector<PointResults> points;
  auto request = requests.begin();
  for (const SweepPoint& point : sweep.points) {
    points.push_back({&point, point.scenario.seeds, {}});
    for (std::size_t k = 0; k < point.scenario.seeds.size(); ++k)
      points.back().runs.push_back(store.find((request++)->key));
  }
  return points;
}

FinishedRuns finished(const PointResults& point) {
  FinishedRuns result;
  for (const auto& run : point.runs) {
    if (!run || run->state == RunState::running) {
      ++result.missing;
    } else if (run->state == RunState::failed) {
      ++result.failed;
    } else if (!run->at_rest()) {
      ++result.restless;
    } else {
      result.seeds.push_back(run->outputs);
      result.wall_seconds += run->wall_seconds;
    }
  }
  return result;
}

MeanStd PointResults::of(const std::string& output) const {
  std::vector<double> values;
  for (const auto& run : runs)
    if (run && run->at_rest() && run->outputs.contains(output)) values.push_back(run->outputs.at(output));
  return mean_std(values);
}

int PointResults::count(RunState state) const {
  return static_cast<int>(
      std::count_if(runs.begin(), runs.end(), [&](const auto& run) { return run && run->state == state; }));
}

std::set<std::string> output_names(const std::vector<PointResults>& points) {
  std::set<std::string> names;
  for (const PointResults& point : points)
    for (const auto& run : point.runs)
      if (run)
        for (const auto& [name, value] : run->outputs) names.insert(name);
  return names;
}

void write_sweep_csv(const Sweep& sweep, const std::vector<PointResults>& points, const fs::path& file) {
  const std::set<std::string> outputs = output_names(points);
  std::string text = "# " + kTableOf + sweep.name + "\n";
  for (const std::string& name : sweep.parameters) text += csv_field(name) + ",";
  text += "seed,state,version,wall_seconds";
  for (const std::string& name : outputs) text += ',' + csv_field(name);
  text += ",message\n";
  for (const PointResults& p : points)
    for (std::size_t k = 0; k < p.runs.size(); ++k) {
      for (const std::string& value : p.point->values) text += csv_field(value) + ",";
      const auto& run = p.runs[k];
      text += fmt::format("{},{},{},{}", p.seeds[k], run ? name_of(run->state) : "not run",
                          run ? run->version : "",
                          run && run->wall_seconds > 0 ? fmt::format("{:.1f}", run->wall_seconds) : "");
      for (const std::string& name : outputs)
        text += run && run->outputs.contains(name) ? fmt::format(",{:.8g}", run->outputs.at(name)) : ",";
      text += ',' + csv_field(run ? run->message : "") + "\n";
    }
  write_text_file(file, text);
}

std::vector<PointResults> read_sweep_csv(const Sweep& sweep, const fs::path& file, bool refuse_others) {
  DelimitedTable table(file);
  check_sweep(sweep, table, file);
  check_columns(sweep, table);
  std::vector<PointResults> points;
  for (const SweepPoint& point : sweep.points)
    points.push_back({&point, point.scenario.seeds,
                      std::vector<std::optional<StoredResult>>(point.scenario.seeds.size())});
  const std::size_t seed_column = sweep.parameters.size();
  while (table.next()) {
    const auto seed = seed_in(table.field(seed_column));
    if (!seed) table.fail(fmt::format("seed '{}' is no integer", table.field(seed_column)));
    const std::optional<StoredResult> run = run_in(table, seed_column + 1);
    if (!run) continue;
    std::vector<std::string> values;
    for (std::size_t k = 0; k < seed_column; ++k) values.push_back(table.field(k));
    bool known = false;
    for (PointResults& point : points) {
      if (!std::equal(values.begin(), values.end(), point.point->values.begin(), same_value)) continue;
      known = true;
      const auto found = std::find(point.seeds.begin(), point.seeds.end(), *seed);
      if (found == point.seeds.end()) continue;
      auto& place = point.runs[static_cast<std::size_t>(found - point.seeds.begin())];
      if (place)
        table.fail(fmt::format("the run of seed {} at {} stands twice", *seed, fmt::join(values, ", ")));
      place = run;
    }
    if (!known && refuse_others)
      table.fail(fmt::format("{} is no point of sweep {}", fmt::join(values, ", "), sweep.name));
  }
  return points;
}

SweepComparison compare_sweep(const std::vector<PointResults>& points, const std::string& output,
                              const std::vector<ReferenceValue>& reference) {
  Outputs some;
  for (const PointResults& point : points)
    for (const auto& run : point.runs)
      if (run && some.empty()) some = run->outputs;
  std::map<std::string, const ReferenceValue*> printed;  // by case
  for (const ReferenceValue& value : reference) {
    if (!is_reading_of(output, value, some)) continue;
    const ReferenceValue*& here = printed[value.case_name];
    if (here == nullptr || value.kind == "pfc3d") here = &value;
  }
  SweepComparison result;
  double largest = 0;
  for (const PointResults& point : points) {
    const auto found = printed.find(point.point->compare);
    const MeanStd simulated = point.of(output);
    result.printed.push_back(found == printed.end() ? nan : found->second->value);
    result.difference.push_back(simulated.n > 0 ? simulated.mean - result.printed.back() : nan);
    const double difference = result.difference.back();
    if (!std::isfinite(difference)) continue;
    ++result.compared;
    result.mean += difference;
    result.rms += difference * difference;
    if (std::abs(difference) >= largest) {
      largest = std::abs(difference);
      result.worst = static_cast<int>(result.printed.size()) - 1;
    }
  }
  if (result.compared > 0) {
    result.mean /= result.compared;
    result.rms = std::sqrt(result.rms / result.compared);
  }
  return result;
}

}  // namespace scree
