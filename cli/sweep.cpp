// scree sweep: a scenario over many values of its parameters, into a store.
#include "cli/ensemble/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/run_outputs.h"
#include "analysis/sweep_chart.h"
#include "cli/commands.h"
#include "cli/ensemble/run_request.h"
#include "cli/ensemble/sweep.h"
#include "cli/ensemble_console.h"
#include "scree_version.h"
#include "sim/io/text_file.h"

namespace fs = std::filesystem;

namespace {

// A point of the sweep with what the store knows of its runs, in the order of the seeds.
struct PointResults {
  const scree::SweepPoint* point;
  std::vector<scree::RunRequest> requests;
  std::vector<std::optional<scree::StoredResult>> runs;

  scree::MeanStd of(const std::string& output) const {
    std::vector<double> values;
    for (const auto& run : runs)
      if (run && run->outputs.contains(output)) values.push_back(run->outputs.at(output));
    return scree::mean_std(values);
  }
  int count(scree::RunState state) const {
    return static_cast<int>(
        std::count_if(runs.begin(), runs.end(), [&](const auto& run) { return run && run->state == state; }));
  }
};

void look_up(std::vector<PointResults>& points, const scree::ResultsStore& store) {
  for (PointResults& point : points) {
    point.runs.clear();
    for (const scree::RunRequest& request : point.requests) point.runs.push_back(store.find(request.key));
  }
}

std::set<std::string> outputs_of(const std::vector<PointResults>& points) {
  std::set<std::string> names;
  for (const PointResults& point : points)
    for (const auto& run : point.runs)
      if (run)
        for (const auto& [name, value] : run->outputs) names.insert(name);
  return names;
}

// What is shown unless asked otherwise.
std::vector<std::string> main_outputs(const std::set<std::string>& all) {
  if (all.contains("angle_deg")) return {"angle_deg", "half_coverage_deg", "slope_fit_deg"};
  if (all.contains("rebound_height_m")) return {"rebound_height_m"};
  std::vector<std::string> chi;
  for (const std::string& name : all)
    if (name.starts_with("chi_")) chi.push_back(name);
  return chi;
}

void print_points(const scree::Sweep& sweep, const std::vector<PointResults>& points,
                  const std::vector<std::string>& outputs) {
  for (const std::string& name : sweep.parameters) fmt::print("{:>16} ", name);
  fmt::print("{:>7}", "runs");
  for (const std::string& name : outputs) fmt::print(" {:>18}", name);
  fmt::print("\n");
  for (const PointResults& p : points) {
    for (const std::string& value : p.point->values) fmt::print("{:>16} ", value);
    fmt::print("{:>7}", fmt::format("{}/{}", p.count(scree::RunState::done), p.requests.size()));
    for (const std::string& name : outputs) {
      const scree::MeanStd both = p.of(name);
      fmt::print(" {:>18}", both.n == 0   ? "-"
                            : both.n == 1 ? fmt::format("{:.3f}", both.mean)
                                          : fmt::format("{:.3f} +- {:.3f}", both.mean, both.std));
    }
    const int failed = p.count(scree::RunState::failed);
    const auto restless = std::count_if(p.runs.begin(), p.runs.end(), [](const auto& run) {
      return run && run->state == scree::RunState::done && !run->at_rest();
    });
    fmt::print("{}{}\n", failed > 0 ? fmt::format("  {} failed", failed) : "",
               restless > 0 ? fmt::format("  {} not at rest", restless) : "");
  }
}

int print_failed(const scree::Sweep& sweep, const std::vector<PointResults>& points) {
  int count = 0;
  for (const PointResults& p : points)
    for (std::size_t k = 0; k < p.runs.size(); ++k) {
      if (!p.runs[k] || p.runs[k]->state != scree::RunState::failed) continue;
      ++count;
      for (std::size_t q = 0; q < sweep.parameters.size(); ++q)
        fmt::print("{}={} ", sweep.parameters[q], p.point->values[q]);
      fmt::print("seed {}: {}\n", p.requests[k].seed, p.runs[k]->message);
    }
  if (count == 0) fmt::print("no run has failed\n");
  return count;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : c == '\n' ? " " : std::string(1, c);
  return out + "\"";
}

void write_csv(const scree::Sweep& sweep, const std::vector<PointResults>& points, const fs::path& file) {
  const std::set<std::string> outputs = outputs_of(points);
  std::string text;
  for (const std::string& name : sweep.parameters) text += csv_field(name) + ",";
  text += "seed,state,version,wall_seconds";
  for (const std::string& name : outputs) text += "," + csv_field(name);
  text += ",message\n";
  for (const PointResults& p : points)
    for (std::size_t k = 0; k < p.runs.size(); ++k) {
      for (const std::string& value : p.point->values) text += csv_field(value) + ",";
      const auto& run = p.runs[k];
      text += fmt::format("{},{},{},{}", p.requests[k].seed,
                          !run                                    ? "not run"
                          : run->state == scree::RunState::done   ? "done"
                          : run->state == scree::RunState::failed ? "failed"
                                                                  : "running",
                          run ? run->version : "",
                          run && run->wall_seconds > 0 ? fmt::format("{:.1f}", run->wall_seconds) : "");
      for (const std::string& name : outputs)
        text += run && run->outputs.contains(name) ? fmt::format(",{:.8g}", run->outputs.at(name)) : ",";
      text += "," + csv_field(run ? run->message : "") + "\n";
    }
  scree::write_text_file(file, text);
}

// A line over one parameter, a map over two that form a grid. False if the sweep is neither.
bool plot(const scree::Sweep& sweep, const std::vector<PointResults>& points, const std::string& output,
          const fs::path& file) {
  std::vector<std::vector<double>> at;  // numbers of each point
  for (const PointResults& p : points) {
    at.emplace_back();
    for (const std::string& value : p.point->values) {
      const auto number = number_of(value);
      if (!number) return false;
      at.back().push_back(*number);
    }
  }
  if (sweep.parameters.size() == 1) {
    scree::LineChart chart{sweep.name, sweep.parameters[0], output, {}};
    for (std::size_t k = 0; k < points.size(); ++k) chart.points.push_back({at[k][0], points[k].of(output)});
    std::sort(chart.points.begin(), chart.points.end(),
              [](const auto& a, const auto& b) { return a.x < b.x; });
    scree::draw(chart, file);
    return true;
  }
  if (sweep.parameters.size() != 2) return false;
  const auto values = [&](std::size_t k) {
    std::set<double> all;
    for (const auto& point : at) all.insert(point[k]);
    return std::vector<double>(all.begin(), all.end());
  };
  scree::ContourMap picture{sweep.name, sweep.parameters[0], sweep.parameters[1], output, {}, std::nullopt};
  scree::ParameterMap& map = picture.map;
  map.x = values(0), map.y = values(1);
  if (map.x.size() < 2 || map.y.size() < 2 || map.x.size() * map.y.size() != points.size()) return false;
  map.value.assign(map.y.size(), std::vector<double>(map.x.size(), NAN));
  std::set<double> different;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto i = std::lower_bound(map.x.begin(), map.x.end(), at[k][0]) - map.x.begin();
    const auto j = std::lower_bound(map.y.begin(), map.y.end(), at[k][1]) - map.y.begin();
    const scree::MeanStd both = points[k].of(output);
    if (both.n == 0) continue;
    map.value[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = both.mean;
    different.insert(both.mean);
  }
  if (different.size() < 2) return false;
  scree::draw(picture, file);
  return true;
}

}  // namespace

int run_sweep(const SweepOptions& options) {
  const scree::SweepResult loaded = scree::load_sweep(options.file, asset_dir());
  for (const scree::ScenarioError& error : loaded.errors) fmt::print(stderr, "{}\n", error.text());
  if (!loaded.errors.empty()) return kBadInput;
  const scree::Sweep& sweep = loaded.sweep;

  std::vector<PointResults> points;
  std::vector<scree::RunRequest> requests;
  for (const scree::SweepPoint& point : sweep.points) {
    points.push_back({&point, {}, {}});
    for (const std::uint64_t seed : sweep.seeds) {
      points.back().requests.push_back(
          scree::run_request(point.scenario, seed, scree::results_version(), asset_dir()));
      requests.push_back(points.back().requests.back());
    }
  }
  const bool only_look = options.list || options.failed;
  const std::string type(scree::experiment_type(sweep.points.front().scenario));
  if (!options.output.empty() && !scree::may_give(type, options.output)) {
    fmt::print(stderr, "--output {}: a scenario of type {} does not give it; it gives {}\n", options.output,
               type, scree::outputs_given(type));
    return kBadInput;
  }
  const std::unique_ptr<scree::ResultsStore> store = open_store(options.store, only_look);
  if (!store) return kBadInput;
  scree::EnsembleProgress progress;
  if (!only_look) progress = run_with_progress(requests, *store, options.jobs, options.again);

  look_up(points, *store);
  if (options.failed) {
    print_failed(sweep, points);
  } else {
    const std::set<std::string> all = outputs_of(points);
    const std::vector<std::string> shown =
        options.output.empty() ? main_outputs(all) : std::vector<std::string>{options.output};
    print_points(sweep, points, shown);
    if (!options.csv.empty()) {
      write_csv(sweep, points, options.csv);
      fmt::print("table: {}\n", options.csv.string());
    }
    if (!only_look)
      fmt::print("store: {} ({} runs done here)\n", store->file().string(), progress.ended_here);
    if (!options.plot.empty() && !interrupted) {
      if (shown.empty() || !plot(sweep, points, shown.front(), options.plot)) {
        fmt::print(stderr,
                   "--plot: needs results over one numeric parameter, or over two that form a grid\n");
        return kBadInput;
      }
      fmt::print("picture: {}\n", options.plot.string());
    }
  }
  if (interrupted) {
    fmt::print(stderr, "interrupted; the same command goes on from here\n");
    return kInterrupted;
  }
  if (progress.failed > 0)
    fmt::print(stderr, "{} runs failed; scree sweep {} --failed says why\n", progress.failed,
               options.file.string());
  return progress.failed > 0 ? kFailed : kOk;
}
