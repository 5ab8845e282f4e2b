#include "cli/ensemble/sweep_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>

#include "analysis/results/outputs.h"
#include "cli/ensemble/run_request.h"
#include "sim/io/text_file.h"
#include "sim/material/input_bytes.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

const std::string kTableOf = "# Runs of sweep ";  // first line of a table

const char* name_of(RunState state) {
  return state == RunState::done ? "done" : state == RunState::failed ? "failed" : "running";
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : c == '\n' ? " " : std::string(1, c);
  return out + "\"";
}

std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (quoted && c == '"' && k + 1 < line.size() && line[k + 1] == '"')
      fields.back() += line[++k];
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

template <class Number>
std::optional<Number> number(const std::string& text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<Number>)
    if (!std::isfinite(value)) return std::nullopt;
  return value;
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
  std::string text = kTableOf + sweep.name + "\n";
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
  std::istringstream in(read_input_text(file));
  std::vector<PointResults> points;
  for (const SweepPoint& point : sweep.points)
    points.push_back({&point, point.scenario.seeds,
                      std::vector<std::optional<StoredResult>>(point.scenario.seeds.size())});

  std::string line;
  int at_line = 0;
  const auto fail = [&](const std::string& what) { throw FileError(file, at_line, what); };
  std::vector<std::string> header;
  const std::size_t first = sweep.parameters.size();
  while (std::getline(in, line)) {
    ++at_line;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.starts_with(kTableOf) && line.substr(kTableOf.size()) != sweep.name)
      fail(fmt::format("these are runs of sweep {}, not of {}", line.substr(kTableOf.size()), sweep.name));
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> fields = csv_fields(line);
    if (header.empty()) {
      header = fields;
      std::vector<std::string> expected = sweep.parameters;
      expected.insert(expected.end(), {"seed", "state", "version", "wall_seconds"});
      if (header.size() < expected.size() + 1 ||
          !std::equal(expected.begin(), expected.end(), header.begin()) || header.back() != "message")
        fail(fmt::format("not a table of this sweep: its columns begin with {} and end with message",
                         fmt::join(expected, ",")));
      for (auto name = header.begin(); name != header.end(); ++name)
        if (std::find(header.begin(), name, *name) != name)
          fail(fmt::format("the column {} stands twice", *name));
      continue;
    }
    if (fields.size() != header.size())
      fail(fmt::format("{} columns, {} are needed", fields.size(), header.size()));
    const auto seed = number<std::uint64_t>(fields[first]);
    if (!seed) fail(fmt::format("seed '{}' is no integer", fields[first]));
    if (fields[first + 1] == "not run" || fields[first + 1] == "running") continue;
    StoredResult run;
    if (fields[first + 1] != "done" && fields[first + 1] != "failed")
      fail(fmt::format("state '{}' is none of done, failed, running, not run", fields[first + 1]));
    run.state = fields[first + 1] == "done" ? RunState::done : RunState::failed;
    run.version = fields[first + 2];
    if (const std::string& text = fields[first + 3]; !text.empty()) {
      const auto seconds = number<double>(text);
      if (!seconds) fail(fmt::format("wall_seconds '{}' is no number", text));
      run.wall_seconds = *seconds;
    }
    run.message = fields.back();
    for (std::size_t k = first + 4; k + 1 < fields.size(); ++k) {
      if (fields[k].empty()) continue;
      const auto value = number<double>(fields[k]);
      if (!value) fail(fmt::format("{} '{}' is no number", header[k], fields[k]));
      run.outputs[header[k]] = *value;
    }
    bool known = false;
    for (PointResults& point : points) {
      if (!std::equal(point.point->values.begin(), point.point->values.end(), fields.begin(), same_value))
        continue;
      known = true;
      const auto found = std::find(point.seeds.begin(), point.seeds.end(), *seed);
      if (found == point.seeds.end()) continue;
      auto& place = point.runs[static_cast<std::size_t>(found - point.seeds.begin())];
      if (place)
        fail(fmt::format("the run of seed {} at {} stands twice", *seed,
                         fmt::join(point.point->values, ", ")));
      place = run;
    }
    if (!known && refuse_others)
      fail(fmt::format("{} is no point of sweep {}",
                       fmt::join(fields.begin(), fields.begin() + static_cast<std::ptrdiff_t>(first), ", "),
                       sweep.name));
  }
  if (header.empty()) fail("there is no header");
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
