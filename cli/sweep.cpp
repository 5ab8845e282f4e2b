// scree sweep: a scenario over many values of its parameters, into a store.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/report/sweep_chart.h"
#include "cli/commands.h"
#include "cli/ensemble/output_scope.h"
#include "cli/ensemble/sweep_results.h"
#include "cli/ensemble_console.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "cli/printed_values.h"

namespace fs = std::filesystem;
using scree::PointResults;

namespace {

// What is shown unless asked otherwise.
std::vector<std::string> main_outputs(const std::set<std::string>& all) {
  if (all.contains("angle_deg")) return {"angle_deg", "height_over_radius_deg", "half_coverage_deg"};
  if (all.contains("rebound_height_m")) return {"rebound_height_m"};
  std::vector<std::string> chi;
  for (const std::string& name : all)
    if (name.starts_with("chi_")) chi.push_back(name);
  return chi;
}

std::string with_deviation(const scree::MeanStd& both) {
  return both.n == 0   ? "-"
         : both.n == 1 ? fmt::format("{:.3f}", both.mean)
                       : fmt::format("{:.3f} +- {:.3f}", both.mean, both.std);
}

// A row a point; beside the first output what is printed for it, and below how far all of them are from it.
void print_points(const scree::Sweep& sweep, const std::vector<PointResults>& points,
                  const std::vector<std::string>& outputs,
                  const std::vector<scree::SweepComparison>& comparisons) {
  const bool compared = !comparisons.empty() && comparisons.front().compared > 0;
  for (const std::string& name : sweep.parameters) fmt::print("{:>16} ", name);
  fmt::print("{:>7}", "runs");
  for (std::size_t k = 0; k < outputs.size(); ++k)
    fmt::print(" {:>22}{}", outputs[k],
               k == 0 && compared ? fmt::format(" {:>9} {:>10}", "printed", "difference") : "");
  fmt::print("\n");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PointResults& p = points[i];
    for (const std::string& value : p.point->values) fmt::print("{:>16} ", value);
    fmt::print("{:>7}", fmt::format("{}/{}", p.count(scree::RunState::done), p.runs.size()));
    for (std::size_t k = 0; k < outputs.size(); ++k) {
      fmt::print(" {:>22}", with_deviation(p.of(outputs[k])));
      if (k > 0 || !compared) continue;
      const double printed = comparisons[0].printed[i], difference = comparisons[0].difference[i];
      fmt::print(" {:>9} {:>10}", std::isfinite(printed) ? fmt::format("{:.4g}", printed) : "-",
                 std::isfinite(difference) ? fmt::format("{:+.2f}", difference) : "-");
    }
    const int failed = p.count(scree::RunState::failed);
    const auto restless = std::count_if(p.runs.begin(), p.runs.end(), [](const auto& run) {
      return run && run->state == scree::RunState::done && !run->at_rest();
    });
    fmt::print("{}{}\n", failed > 0 ? fmt::format("  {} failed", failed) : "",
               restless > 0 ? fmt::format("  {} not at rest", restless) : "");
  }
  if (compared) fmt::print("\nagainst printed values:\n");
  for (std::size_t k = 0; k < comparisons.size(); ++k) {
    const scree::SweepComparison& c = comparisons[k];
    if (c.compared > 0)
      fmt::print("{:>24}: root mean square {:.2f}, mean {:+.2f}, largest {:+.2f} at {} ({} points)\n",
                 outputs[k], c.rms, c.mean, c.difference[static_cast<std::size_t>(c.worst)],
                 fmt::join(points[static_cast<std::size_t>(c.worst)].point->values, ", "), c.compared);
  }
}

void print_failed(const scree::Sweep& sweep, const std::vector<PointResults>& points) {
  bool none = true;
  for (const PointResults& p : points)
    for (std::size_t k = 0; k < p.runs.size(); ++k) {
      if (!p.runs[k] || p.runs[k]->state != scree::RunState::failed) continue;
      none = false;
      for (std::size_t q = 0; q < sweep.parameters.size(); ++q)
        fmt::print("{}={} ", sweep.parameters[q], p.point->values[q]);
      fmt::print("seed {}: {}\n", p.seeds[k], p.runs[k]->message);
    }
  if (none) fmt::print("no run has failed\n");
}

// A line over one parameter, a map over two that form a grid. False if the sweep is neither.
bool plot(const scree::Sweep& sweep, const std::vector<PointResults>& points, const std::string& output,
          const scree::SweepComparison& comparison, const fs::path& file) {
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
    for (std::size_t k = 0; k < points.size(); ++k)
      chart.points.push_back({at[k][0], points[k].of(output), comparison.printed[k]});
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
  scree::ContourMap picture{sweep.name, sweep.parameters[0], sweep.parameters[1], output, {}, {}, {}};
  scree::ParameterMap& map = picture.map;
  map.x = values(0), map.y = values(1);
  if (map.x.size() < 2 || map.y.size() < 2 || map.x.size() * map.y.size() != points.size()) return false;
  map.value.assign(map.y.size(), std::vector<double>(map.x.size(), NAN));
  scree::ParameterMap printed = map;
  std::set<double> different;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto i = std::lower_bound(map.x.begin(), map.x.end(), at[k][0]) - map.x.begin();
    const auto j = std::lower_bound(map.y.begin(), map.y.end(), at[k][1]) - map.y.begin();
    printed.value[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = comparison.printed[k];
    const scree::MeanStd both = points[k].of(output);
    if (both.n == 0) continue;
    map.value[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = both.mean;
    different.insert(both.mean);
  }
  if (different.size() < 2) return false;
  if (comparison.compared > 1) picture.beside = printed;
  scree::draw(picture, file);
  return true;
}

// Whether the points lie on a line or a grid of numbers, so that a picture can show them.
bool can_be_drawn(const scree::Sweep& sweep) {
  if (sweep.parameters.empty() || sweep.parameters.size() > 2) return false;
  std::vector<std::set<double>> values(sweep.parameters.size());
  for (const scree::SweepPoint& point : sweep.points)
    for (std::size_t k = 0; k < values.size(); ++k) {
      const auto number = number_of(point.values[k]);
      if (!number) return false;
      values[k].insert(*number);
    }
  return values.size() == 1 || (values[0].size() > 1 && values[1].size() > 1 &&
                                values[0].size() * values[1].size() == sweep.points.size());
}

// What would be refused only after hours of work; false with a message.
bool can_be_written(const SweepOptions& options, const scree::Sweep& sweep) {
  if (!options.plot.empty() && !can_be_drawn(sweep)) {
    fmt::print(stderr, "--plot: needs one numeric parameter, or two that form a grid\n");
    return false;
  }
  if (!options.plot.empty() && options.plot.extension() != ".svg") {
    fmt::print(stderr, "--plot {}: an SVG is drawn; name it so, FILE.svg\n", options.plot.string());
    return false;
  }
  const fs::path store = store_file(options.ensemble.store);
  return (options.csv.empty() || may_replace(options.csv, {options.file, options.from, store})) &&
         (options.plot.empty() ||
          may_replace(options.plot, {options.file, options.from, store, options.csv}));
}

// Tables and pictures of what is known.
int show(const SweepOptions& options, const scree::Sweep& sweep, const std::vector<PointResults>& points,
         const std::vector<scree::ReferenceValue>& reference) {
  const std::vector<std::string> shown = options.output.empty() ? main_outputs(scree::output_names(points))
                                                                : std::vector<std::string>{options.output};
  std::vector<scree::SweepComparison> comparisons;
  for (const std::string& output : shown)
    comparisons.push_back(scree::compare_sweep(points, output, reference));
  if (options.failed)
    print_failed(sweep, points);
  else
    print_points(sweep, points, shown, comparisons);
  if (!options.csv.empty()) {
    scree::write_sweep_csv(sweep, points, options.csv);
    fmt::print("table: {}\n", options.csv.string());
  }
  if (options.plot.empty() || interrupted) return kOk;
  if (shown.empty() || !plot(sweep, points, shown.front(), comparisons.front(), options.plot)) {
    fmt::print(stderr, "--plot: there are too few results to draw\n");
    return kBadInput;
  }
  fmt::print("picture: {}\n", options.plot.string());
  return kOk;
}

}  // namespace

int run_sweep(const SweepOptions& options) {
  if (!is_of_kind(options.file, scree::FileKind::sweep)) return kBadInput;
  const scree::SweepResult loaded = scree::load_sweep(options.file, asset_dir());
  if (!nothing_wrong(loaded.errors, loaded.warnings)) return kBadInput;
  const scree::Sweep& sweep = loaded.sweep;
  if (!options.output.empty())
    if (const std::string why = scree::why_not_given(sweep, options.output); !why.empty()) {
      fmt::print(stderr, "--output {}: {}\n", options.output, why);
      return kBadInput;
    }
  if (!can_be_written(options, sweep)) return kBadInput;
  const auto reference = printed_values();
  if (!reference) return kBadInput;
  if (!options.from.empty()) {
    std::vector<PointResults> points;
    try {
      points = scree::read_sweep_csv(sweep, options.from);
    } catch (const std::runtime_error& error) {
      fmt::print(stderr, "{}\n", error.what());
      return kBadInput;
    }
    return show(options, sweep, points, *reference);
  }

  const std::vector<scree::RunRequest> requests = scree::requests_of(sweep, asset_dir());
  const bool only_look = options.list || options.failed;
  const std::unique_ptr<scree::ResultsStore> store =
      open_store(options.ensemble.store, only_look ? StoreUse::list : StoreUse::change);
  if (!store) return kBadInput;
  scree::EnsembleProgress progress;
  if (!only_look) progress = run_with_progress(requests, *store, options.ensemble);

  const int shown = show(options, sweep, scree::look_up(sweep, requests, *store), *reference);
  if (!only_look) fmt::print("store: {} ({} runs done here)\n", store->file().string(), progress.ended_here);
  if (interrupted) {
    fmt::print(stderr, "interrupted; the same command goes on from here\n");
    return kInterrupted;
  }
  if (progress.failed > 0)
    fmt::print(stderr, "{} runs failed; scree sweep {} --failed says why, --again tries them again\n",
               progress.failed, options.file.string());
  return shown != kOk ? shown : progress.failed > 0 ? kFailed : kOk;
}
