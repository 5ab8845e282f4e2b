// scree calibrate: parameters that make the simulation give what was measured.
#include "cli/ensemble/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "analysis/sweep_chart.h"
#include "cli/commands.h"
#include "cli/ensemble/run_request.h"
#include "cli/ensemble_console.h"
#include "scree_version.h"
#include "sim/io/text_file.h"

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr double kShare = 0.9;  // of the probability that an interval holds

std::vector<std::string> names_of(const scree::CalibrationSpec& spec) {
  std::vector<std::string> names;
  for (const auto& span : spec.parameters) names.push_back(span.key);
  return names;
}

std::vector<double> values_at(const scree::CalibrationSpec& spec, const Eigen::VectorXd& at) {
  std::vector<double> values;
  for (int k = 0; k < at.size(); ++k) values.push_back(scree::parameter_value(spec, k, at[k]));
  return values;
}

// Every point of the calibration as a scenario. A fault ends the calibration before it has cost anything.
scree::Simulator simulator(const scree::CalibrationSpec& spec, scree::ResultsStore& store, int jobs) {
  return [&spec, &store, jobs](const std::vector<scree::CalibrationRun>& runs) {
    std::vector<scree::RunRequest> requests;
    for (const scree::CalibrationRun& run : runs) {
      std::vector<std::string> values;
      for (const double value : values_at(spec, run.at)) values.push_back(fmt::format("{:.6g}", value));
      const scree::ScenarioResult loaded = scree::load_scenario(
          run.scenario, scree::overrides_of(spec.variation, names_of(spec), values), asset_dir());
      if (!loaded.errors.empty()) throw std::invalid_argument(loaded.errors.front().text());
      requests.push_back(scree::run_request(loaded.scenario, run.seed, SCREE_VERSION, asset_dir()));
    }
    run_with_progress(requests, store, jobs, false);
    if (interrupted) throw scree::CalibrationStopped("interrupted; the same command goes on from here");
    std::vector<std::vector<double>> values;
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const auto found = store.find(requests[k].key);
      values.emplace_back();
      for (const auto& target : spec.targets) {
        const bool given =
            found && target.scenario == runs[k].scenario && found->outputs.contains(target.output);
        values.back().push_back(given ? found->outputs.at(target.output) : NAN);
      }
      if (found && found->state == scree::RunState::failed)
        fmt::print(stderr, "a run failed and is left out: {}\n", found->message);
    }
    return values;
  };
}

// "material.mu" -> "material:\n  mu: 0.2\n"; keys that follow others included.
std::string as_yaml(const std::map<std::string, double>& values) {
  std::map<std::string, std::string> groups;  // by the part before the last dot
  for (const auto& [key, value] : values) {
    const auto dot = key.rfind('.');
    groups[dot == std::string::npos ? "" : key.substr(0, dot)] +=
        fmt::format("{}: {:.4g}\n", dot == std::string::npos ? key : key.substr(dot + 1), value);
  }
  std::string text;
  for (const auto& [group, lines] : groups) {
    std::string indent;
    for (std::size_t begin = 0; begin < group.size();) {
      const auto dot = std::min(group.find('.', begin), group.size());
      text += indent + group.substr(begin, dot - begin) + ":\n";
      indent += "  ";
      begin = dot + 1;
    }
    for (std::size_t begin = 0; begin < lines.size();) {
      const auto end = lines.find('\n', begin);
      text += indent + lines.substr(begin, end - begin + 1);
      begin = end + 1;
    }
  }
  return text;
}

struct Found {
  std::vector<double> best;                     // of each parameter
  std::vector<std::array<double, 2>> interval;  // of each parameter
  std::vector<std::array<double, 2>> line;      // two parameters: pairs that fit equally well
  std::optional<double> interpolated;           // grid of one parameter, first target
  std::optional<double> equal;                  // two parameters: where both are the same, first target
};

// Values of a number over the grid of two parameters, [second][first].
struct Map {
  std::vector<double> x, y;
  std::vector<std::vector<double>> value;
};

Map map_of(const scree::CalibrationSpec& spec, const scree::CalibrationResult& result) {
  Map map;
  const bool grid = !result.grid.empty();
  const int side = grid ? spec.grid_points : result.posterior->side();
  for (int k = 0; k < side; ++k) {
    map.x.push_back(scree::parameter_value(spec, 0, static_cast<double>(k) / (side - 1)));
    map.y.push_back(scree::parameter_value(spec, 1, static_cast<double>(k) / (side - 1)));
  }
  for (int j = 0; j < side; ++j) {
    map.value.emplace_back();
    for (int i = 0; i < side; ++i) {
      const auto node = static_cast<std::size_t>(j * side + i);
      map.value.back().push_back(grid ? result.grid[0][node] : result.posterior->prediction(node, 0).mean);
    }
  }
  return map;
}

// Where both parameters have one value: the level's crossing along the diagonal of what both ranges share.
std::optional<double> where_equal(const Map& map, double level) {
  const double from = std::max(map.x.front(), map.y.front()), to = std::min(map.x.back(), map.y.back());
  if (!(from < to)) return std::nullopt;
  const auto interpolated = [&](double v) {
    const auto cell = [v](const std::vector<double>& axis) {
      const auto above = std::upper_bound(axis.begin(), axis.end() - 1, v) - axis.begin();
      return static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - 1, 0));
    };
    const std::size_t i = cell(map.x), j = cell(map.y);
    const double s = (v - map.x[i]) / (map.x[i + 1] - map.x[i]),
                 t = (v - map.y[j]) / (map.y[j + 1] - map.y[j]);
    return (1 - t) * ((1 - s) * map.value[j][i] + s * map.value[j][i + 1]) +
           t * ((1 - s) * map.value[j + 1][i] + s * map.value[j + 1][i + 1]);
  };
  std::vector<double> at, value;
  for (int k = 0; k <= 200; ++k) {
    at.push_back(from + (to - from) * k / 200);
    value.push_back(interpolated(at.back()));
  }
  const double found = scree::crossing(at, value, level);
  return std::isfinite(found) ? std::optional(found) : std::nullopt;
}

Found find(const scree::CalibrationSpec& spec, const scree::CalibrationResult& result) {
  Found found;
  const scree::Posterior& posterior = *result.posterior;
  const auto dimensions = static_cast<int>(spec.parameters.size());
  found.best = values_at(spec, dimensions == 1 ? posterior.mean() : posterior.most_likely());
  for (int k = 0; k < dimensions; ++k) {
    const auto [low, high] = posterior.interval(k, kShare);
    found.interval.push_back({scree::parameter_value(spec, k, low), scree::parameter_value(spec, k, high)});
  }
  const double level = spec.targets[0].value;
  if (dimensions == 1 && !result.grid.empty()) {
    std::vector<double> x;
    for (int k = 0; k < spec.grid_points; ++k)
      x.push_back(scree::parameter_value(spec, 0, static_cast<double>(k) / (spec.grid_points - 1)));
    const double at = scree::crossing(x, result.grid[0], level);
    if (std::isfinite(at)) found.interpolated = at;
  }
  if (dimensions == 2) {
    const Map map = map_of(spec, result);
    const std::vector<double> line = scree::level_line(map.x, map.y, map.value, level);
    for (std::size_t k = 0; k < line.size(); ++k)
      if (std::isfinite(line[k])) found.line.push_back({map.x[k], line[k]});
    found.equal = where_equal(map, level);
  }
  return found;
}

void draw_picture(const scree::CalibrationSpec& spec, const scree::CalibrationResult& result,
                  const Found& found, const fs::path& file) {
  const auto& target = spec.targets[0];
  if (spec.parameters.size() == 1) {
    scree::CalibrationChart chart;
    chart.title = spec.name;
    chart.x_label = spec.parameters[0].key;
    for (const auto& [key, leader] : spec.variation.ties) chart.x_label += " = " + key;
    chart.y_label = target.output;
    for (std::size_t k = 0; k < result.runs.size(); ++k)
      if (std::isfinite(result.values[k][0]))
        chart.runs.push_back({scree::parameter_value(spec, 0, result.runs[k].at[0]), result.values[k][0]});
    for (std::size_t node = 0; node < result.posterior->size(); node += 4) {
      const scree::Prediction& p = result.posterior->prediction(node, 0);
      chart.x.push_back(scree::parameter_value(spec, 0, result.posterior->point(node)[0]));
      chart.mean.push_back(p.mean);
      chart.low.push_back(p.mean - 1.645 * p.std);
      chart.high.push_back(p.mean + 1.645 * p.std);
    }
    chart.target = target.value, chart.uncertainty = target.uncertainty;
    chart.best = found.best[0], chart.interval = found.interval[0];
    scree::draw(chart, file);
  } else if (spec.parameters.size() == 2) {
    const Map map = map_of(spec, result);
    scree::ContourMap picture{spec.name,
                              spec.parameters[0].key,
                              spec.parameters[1].key,
                              target.output,
                              map.x,
                              map.y,
                              map.value,
                              target.value,
                              2,
                              true};
    scree::draw(picture, file);
  }
}

void write_tables(const scree::CalibrationSpec& spec, const scree::CalibrationResult& result,
                  const Found& found, const fs::path& out) {
  const std::vector<std::string> names = names_of(spec);
  std::string runs = fmt::format("{},seed", fmt::join(names, ","));
  for (const auto& target : spec.targets) runs += "," + target.output;
  runs += "\n";
  for (std::size_t k = 0; k < result.runs.size(); ++k) {
    runs += fmt::format("{:.6g},{}", fmt::join(values_at(spec, result.runs[k].at), ","), result.runs[k].seed);
    for (const double value : result.values[k])
      runs += std::isfinite(value) ? fmt::format(",{:.6g}", value) : ",";
    runs += "\n";
  }
  scree::write_text_file(out / "runs.csv", runs);
  std::string posterior = fmt::format("{},probability\n", fmt::join(names, ","));
  for (std::size_t node = 0; node < result.posterior->size(); ++node)
    if (result.posterior->density(node) > 1e-6)
      posterior +=
          fmt::format("{:.6g},{:.6g}\n", fmt::join(values_at(spec, result.posterior->point(node)), ","),
                      result.posterior->density(node));
  scree::write_text_file(out / "posterior.csv", posterior);
  if (found.line.empty()) return;
  std::string line = fmt::format("{}\n", fmt::join(names, ","));
  for (const auto& [a, b] : found.line) line += fmt::format("{:.4f},{:.4f}\n", a, b);
  scree::write_text_file(out / "equal_fit.csv", line);
}

void write_result(const scree::CalibrationSpec& spec, const scree::CalibrationResult& result,
                  const Found& found, const fs::path& out) {
  std::map<std::string, double> values;
  Json parameters = Json::object(), targets = Json::array();
  for (std::size_t k = 0; k < spec.parameters.size(); ++k) {
    values[spec.parameters[k].key] = found.best[k];
    parameters[spec.parameters[k].key] = {{"value", found.best[k]},
                                          {"interval_90", found.interval[k]},
                                          {"range", {spec.parameters[k].from, spec.parameters[k].to}}};
  }
  for (const auto& [key, leader] : spec.variation.ties) values[key] = values.at(leader);
  for (const auto& t : spec.targets)
    targets.push_back({{"output", t.output}, {"value", t.value}, {"uncertainty", t.uncertainty}});
  const auto optional = [](const std::optional<double>& v) { return v ? Json(*v) : Json(nullptr); };
  const Json json = {{"calibration", spec.name},
                     {"version", fmt::format("{} ({})", SCREE_VERSION, SCREE_REVISION)},
                     {"simulations", result.runs.size()},
                     {"targets", targets},
                     {"parameters", parameters},
                     {"grid_interpolation", optional(found.interpolated)},
                     {"both_equal", optional(found.equal)},
                     {"excess_uncertainty", result.posterior->excess_uncertainty()}};
  scree::write_text_file(out / "calibration.json", json.dump(2) + "\n");
  std::string head = fmt::format("# Calibrated by {} from {} simulations (scree {}).\n", spec.name,
                                 result.runs.size(), SCREE_VERSION);
  for (const auto& t : spec.targets)
    head += fmt::format("# {} = {:g} +- {:g}\n", t.output, t.value, t.uncertainty);
  head += "# A scenario takes these values over with `extends:` and the path of this file.\n";
  scree::write_text_file(out / "material.yaml", head + as_yaml(values));
}

}  // namespace

int run_calibrate(const CalibrateOptions& options) {
  const scree::CalibrationSpecResult loaded = scree::load_calibration(options.file);
  for (const scree::ScenarioError& error : loaded.errors) fmt::print(stderr, "{}\n", error.text());
  if (!loaded.errors.empty()) return kBadInput;
  const scree::CalibrationSpec& spec = loaded.spec;
  const std::unique_ptr<scree::ResultsStore> store = open_store(options.store, false);
  if (!store) return kBadInput;

  scree::CalibrationResult result;
  try {
    result = scree::calibrate(spec, simulator(spec, *store, options.jobs), side_by_side(options.jobs));
  } catch (const scree::CalibrationStopped& stopped) {
    fmt::print(stderr, "{}\n", stopped.what());
    return kInterrupted;
  } catch (const std::invalid_argument& wrong) {
    fmt::print(stderr, "{}\n", wrong.what());
    return kBadInput;
  }
  const Found found = find(spec, result);
  const fs::path out = options.out.empty() ? fs::path("runs") / spec.name : options.out;
  fs::create_directories(out);
  write_tables(spec, result, found, out);
  write_result(spec, result, found, out);
  if (spec.parameters.size() <= 2) draw_picture(spec, result, found, out / "calibration.svg");

  fmt::print("{} simulations\n\n{:<24} {:>8}   90 % interval\n", result.runs.size(), "parameter", "value");
  for (std::size_t k = 0; k < spec.parameters.size(); ++k)
    fmt::print("{:<24} {:>8.4f}   {:.4f} to {:.4f}\n", spec.parameters[k].key, found.best[k],
               found.interval[k][0], found.interval[k][1]);
  if (found.interpolated) fmt::print("interpolated between the grid's points: {:.4f}\n", *found.interpolated);
  if (found.equal) fmt::print("where both are equal: {:.4f}\n", *found.equal);
  for (std::size_t k = 0; k < spec.parameters.size(); ++k)
    if (found.interval[k][0] <=
            spec.parameters[k].from + 0.01 * (spec.parameters[k].to - spec.parameters[k].from) ||
        found.interval[k][1] >=
            spec.parameters[k].to - 0.01 * (spec.parameters[k].to - spec.parameters[k].from))
      fmt::print("note: {} may lie outside of its range; widen it, or give a second target\n",
                 spec.parameters[k].key);
  if (result.posterior->excess_uncertainty() > spec.enough)
    fmt::print(
        "note: more simulations would make the intervals narrower (now {:.0f} % wider than the targets "
        "alone would make them)\n",
        100 * result.posterior->excess_uncertainty());
  fmt::print("\nresult: {}, material for `extends`: {}\n", (out / "calibration.json").string(),
             (out / "material.yaml").string());
  return kOk;
}
