// scree calibrate: parameters that make the simulation give what was measured.
#include "cli/ensemble/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "analysis/report/sweep_chart.h"
#include "analysis/results/output_units.h"
#include "cli/commands.h"
#include "cli/ensemble/equivalence_fit.h"
#include "cli/ensemble/output_scope.h"
#include "cli/ensemble/run_request.h"
#include "cli/ensemble/scenario_patch.h"
#include "cli/ensemble_console.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "scree_version.h"
#include "sim/io/text_file.h"

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr double kUndetermined =
    0.8;                       // share of a range that an interval of 90 % takes when nothing is known
constexpr double kMissed = 2;  // standard deviations beyond which a target is not met

// Scenarios with their seeds through the store; what came of each.
std::vector<scree::StoredResult> simulate(
    const std::vector<std::pair<scree::ScenarioResult, std::uint64_t>>& runs, scree::ResultsStore& store,
    const CalibrateOptions& options) {
  std::vector<scree::RunRequest> requests;
  for (const auto& [loaded, seed] : runs) {
    if (!loaded.errors.empty()) throw std::invalid_argument(loaded.errors.front().text());
    requests.push_back(scree::run_request(loaded.scenario, seed, scree::results_version(), asset_dir()));
  }
  auto ended = ended_runs(requests, store, options.ensemble);
  if (!ended) throw scree::CalibrationStopped("interrupted; the same command goes on from here");
  return std::move(*ended);
}

bool is_good(const scree::StoredResult& result) {
  return result.state == scree::RunState::done && result.at_rest();
}

std::string why_left_out(const scree::StoredResult& result) {
  return result.state != scree::RunState::done ? result.message
         : !result.at_rest()                   ? "its pile did not come to rest"
                                               : "its pile does not give the number asked for";
}

// Does what simulates; the exit code if the user ended it or a scenario was refused.
template <class Work>
int simulations(const Work& work) {
  try {
    work();
    return kOk;
  } catch (const scree::CalibrationStopped& stopped) {
    fmt::print(stderr, "{}\n", stopped.what());
    return kInterrupted;
  } catch (const std::invalid_argument& wrong) {
    fmt::print(stderr, "{}\n", wrong.what());
    return kBadInput;
  }
}

// Does the simulations of a calibration.
scree::Simulator simulator(const scree::CalibrationSpec& spec, scree::ResultsStore& store,
                           const CalibrateOptions& options) {
  return [&](const std::vector<scree::CalibrationRun>& runs) {
    std::vector<std::pair<scree::ScenarioResult, std::uint64_t>> scenarios;
    for (const scree::CalibrationRun& run : runs)
      scenarios.emplace_back(
          scree::calibrated_scenario(spec, run.scenario, scree::values_at(spec, run.at), asset_dir()),
          run.seed);
    const auto found = simulate(scenarios, store, options);
    std::vector<std::vector<double>> values;
    for (std::size_t k = 0; k < runs.size(); ++k) {
      values.emplace_back();
      for (const auto& target : spec.targets) {
        const bool given = is_good(found[k]) && target.scenario == runs[k].scenario &&
                           found[k].outputs.contains(target.output);
        values.back().push_back(given ? found[k].outputs.at(target.output) : NAN);
      }
      if (!is_good(found[k]))
        fmt::print(stderr, "a run with {} is left out: {}\n",
                   fmt::join(scree::values_at(spec, runs[k].at), ", "), why_left_out(found[k]));
    }
    return values;
  };
}

// The whole rock, and the other keys that were calibrated, for `extends`.
std::string material_file(const scree::CalibrationSpec& spec, const scree::CalibrationAnswer& answer,
                          std::size_t simulations) {
  std::string text = fmt::format("# Calibrated by {} from {} simulations (scree {}).\n", spec.name,
                                 simulations, SCREE_VERSION);
  for (std::size_t t = 0; t < spec.targets.size(); ++t)
    text += fmt::format("# {}: {:.4g}, aimed at {:g} +- {:g}{}\n", spec.targets[t].output,
                        answer.at_value[t].mean, spec.targets[t].value, spec.targets[t].uncertainty,
                        std::abs(answer.missed_by[t]) > kMissed ? " (NOT MET)" : "");
  text += "# A scenario takes these values over with `extends:` and the path of this file.\n";
  const scree::ScenarioResult best =
      scree::calibrated_scenario(spec, spec.targets[0].scenario, answer.value, asset_dir());
  const std::string& resolved = best.scenario.resolved_yaml;
  const auto begin = resolved.find("material:\n");
  auto end = begin;
  while (end != std::string::npos && end < resolved.size() && (end == begin || resolved[end] == ' '))
    end = resolved.find('\n', end) + 1;
  text += resolved.substr(begin, end - begin);
  std::vector<std::string> others;
  std::map<std::string, double> values;
  for (std::size_t k = 0; k < spec.parameters.size(); ++k) values[spec.parameters[k].key] = answer.value[k];
  for (const auto& [key, leader] : spec.variation.ties) values[key] = values.at(leader);
  for (const auto& [key, value] : values)
    if (!key.starts_with("material.")) others.push_back(fmt::format("{}={:.6g}", key, value));
  return text + scree::nested_yaml(others);
}

// False: more parameters than a picture shows.
bool draw_picture(const scree::CalibrationSpec& spec, const scree::CalibrationResult& result,
                  const scree::CalibrationAnswer& answer, const fs::path& file) {
  const auto& target = spec.targets[0];
  if (answer.map) {
    scree::draw(scree::ContourMap{spec.name, spec.parameters[0].key, spec.parameters[1].key, target.output,
                                  *answer.map, std::nullopt, target.value},
                file);
    return true;
  }
  if (spec.parameters.size() != 1) return false;
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
    chart.low.push_back(p.mean - scree::kDeviations90 * p.std);
    chart.high.push_back(p.mean + scree::kDeviations90 * p.std);
  }
  chart.target = target.value, chart.uncertainty = target.uncertainty;
  chart.best = answer.value[0], chart.interval = answer.interval[0];
  scree::draw(chart, file);
  return true;
}

void write_tables(const scree::CalibrationSpec& spec, const scree::CalibrationResult& result,
                  const scree::CalibrationAnswer& answer, const fs::path& out) {
  const std::vector<std::string> names = scree::names_of(spec);
  std::string runs = fmt::format("{},seed", fmt::join(names, ","));
  for (const auto& target : spec.targets) {
    const bool alone = std::count_if(spec.targets.begin(), spec.targets.end(),
                                     [&](const auto& other) { return other.output == target.output; }) == 1;
    runs += "," + (alone ? target.output : target.scenario.stem().string() + "/" + target.output);
  }
  runs += "\n";
  for (std::size_t k = 0; k < result.runs.size(); ++k) {
    runs += fmt::format("{:.6g},{}", fmt::join(scree::values_at(spec, result.runs[k].at), ","),
                        result.runs[k].seed);
    for (const double value : result.values[k])
      runs += std::isfinite(value) ? fmt::format(",{:.6g}", value) : ",";
    runs += "\n";
  }
  scree::write_text_file(out / "runs.csv", runs);
  std::string posterior = fmt::format("{},probability\n", fmt::join(names, ","));
  for (std::size_t node = 0; node < result.posterior->size(); ++node)
    if (result.posterior->density(node) > 1e-6)
      posterior += fmt::format("{:.6g},{:.6g}\n",
                               fmt::join(scree::values_at(spec, result.posterior->point(node)), ","),
                               result.posterior->density(node));
  scree::write_text_file(out / "posterior.csv", posterior);
  if (answer.line.empty()) return;
  std::string line = fmt::format("{}\n", fmt::join(names, ","));
  for (const auto& [a, b] : answer.line) line += fmt::format("{:.4f},{:.4f}\n", a, b);
  scree::write_text_file(out / "equal_fit.csv", line);
}

void write_json(const scree::CalibrationSpec& spec, const scree::CalibrationResult& result,
                const scree::CalibrationAnswer& answer, const fs::path& file) {
  Json parameters = Json::object(), targets = Json::array();
  for (std::size_t k = 0; k < spec.parameters.size(); ++k)
    parameters[spec.parameters[k].key] = {{"value", answer.value[k]},
                                          {"interval_90", answer.interval[k]},
                                          {"range", {spec.parameters[k].from, spec.parameters[k].to}},
                                          {"cut_off_by_range", static_cast<bool>(answer.cut_off[k])}};
  for (std::size_t t = 0; t < spec.targets.size(); ++t)
    targets.push_back({{"output", spec.targets[t].output},
                       {"value", spec.targets[t].value},
                       {"uncertainty", spec.targets[t].uncertainty},
                       {"simulated", answer.at_value[t].mean},
                       {"simulated_std", answer.at_value[t].std},
                       {"missed_by", answer.missed_by[t]}});
  const auto optional = [](const std::optional<double>& v) { return v ? Json(*v) : Json(nullptr); };
  const Json json = {
      {"calibration", spec.name},
      {"version", fmt::format("{} ({})", SCREE_VERSION, SCREE_REVISION)},
      {"simulations", result.runs.size()},
      {"targets", targets},
      {"parameters", parameters},
      {"grid_interpolation", optional(answer.interpolated)},
      {"both_equal", optional(answer.equal)},
      {"both_equal_interval_90", answer.equal_interval ? Json(*answer.equal_interval) : Json(nullptr)},
      {"excess_uncertainty", result.posterior->excess_uncertainty()}};
  scree::write_text_file(file, json.dump(2) + "\n");
}

void print_answer(const scree::CalibrationSpec& spec, const scree::CalibrationResult& result,
                  const scree::CalibrationAnswer& answer) {
  fmt::print("{} simulations\n\n{:<24} {:>8}   90 % interval\n", result.runs.size(), "parameter", "value");
  for (std::size_t k = 0; k < spec.parameters.size(); ++k)
    fmt::print("{:<24} {:>8.4f}   {:.4f} to {:.4f}\n", spec.parameters[k].key, answer.value[k],
               answer.interval[k][0], answer.interval[k][1]);
  if (answer.interpolated) fmt::print("interpolated between the grid's points, as the thesis did\n");
  if (answer.equal)
    fmt::print("the pair with both equal is taken, of all that fit (equal_fit.csv){}\n",
               answer.equal_interval ? fmt::format("; on that line {:.4f} to {:.4f} hold 90 %",
                                                   (*answer.equal_interval)[0], (*answer.equal_interval)[1])
                                     : "");
  else if (!answer.line.empty())
    fmt::print("the most likely pair is taken; all on the line in equal_fit.csv give the first target\n");
  fmt::print("\n{:<24} {:>10} {:>18}\n", "target", "aimed at", "simulated");
  for (std::size_t t = 0; t < spec.targets.size(); ++t)
    fmt::print("{:<24} {:>10.4g} {:>18}{}\n", spec.targets[t].output, spec.targets[t].value,
               fmt::format("{:.4g} +- {:.2g}", answer.at_value[t].mean, answer.at_value[t].std),
               std::abs(answer.missed_by[t]) > kMissed
                   ? fmt::format("   NOT MET: off by {:.1f} standard deviations", answer.missed_by[t])
                   : "");
  for (std::size_t k = 0; k < spec.parameters.size(); ++k) {
    const auto& [key, from, to] = spec.parameters[k];
    if (answer.interval[k][1] - answer.interval[k][0] > kUndetermined * (to - from))
      fmt::print(
          "note: {} is not determined by these targets; its value is as good as any other of its range\n",
          key);
    else if (answer.cut_off[k])
      fmt::print("note: {} is cut off by its range; widen it, or give a second target\n", key);
  }
  if (result.posterior->excess_uncertainty() > spec.enough)
    fmt::print(
        "note: more simulations would make the intervals narrower (what is not known makes them {:.0f} % "
        "wider than "
        "the targets alone)\n",
        100 * result.posterior->excess_uncertainty());
}

// The table of settings of Bullet that are equivalent to rrlinear's parameters.
int run_equivalence(const CalibrateOptions& options) {
  const scree::EquivalenceSpecResult loaded = scree::load_equivalence(options.file);
  if (!nothing_wrong(loaded.errors)) return kBadInput;
  const scree::EquivalenceSpec& spec = loaded.spec;
  const scree::ScenarioResult first =
      scree::load_scenario(spec.scenario, spec.fixed, asset_dir(), scree::ReadFor::numbers);
  if (!nothing_wrong(first.errors, first.warnings)) return kBadInput;
  if (const std::string why = scree::why_not_given(first.scenario, spec.output); !why.empty()) {
    fmt::print(stderr, "output '{}': {}\n", spec.output, why);
    return kBadInput;
  }
  if (!options.out.empty() && !may_fill(options.out, options.force)) return kBadInput;
  const std::unique_ptr<scree::ResultsStore> store = open_store(options.ensemble.store, StoreUse::change);
  if (!store) return kBadInput;
  std::vector<scree::EquivalenceNode> nodes;
  const int ended = simulations([&] {
    nodes = scree::fit_equivalence(spec, [&](const std::vector<scree::EquivalenceRun>& runs) {
      std::vector<std::pair<scree::ScenarioResult, std::uint64_t>> scenarios;
      for (const scree::EquivalenceRun& run : runs)
        scenarios.emplace_back(
            scree::load_scenario(spec.scenario, run.overrides, asset_dir(), scree::ReadFor::numbers),
            run.seed);
      const auto found = simulate(scenarios, *store, options);
      std::vector<double> values;
      for (std::size_t k = 0; k < runs.size(); ++k) {
        const bool given = is_good(found[k]) && found[k].outputs.contains(spec.output);
        values.push_back(given ? found[k].outputs.at(spec.output) : NAN);
        if (!given)
          fmt::print(stderr, "a run with {} is left out: {}\n", fmt::join(runs[k].overrides, ", "),
                     why_left_out(found[k]));
      }
      return values;
    });
  });
  if (ended != kOk) return ended;
  const fs::path out = options.out.empty() ? free_run_folder(spec.name) : options.out;
  if (!prepare_folder(out, options.force)) return kBadInput;
  fmt::print("{:>6} {:>6} {:>14} {:>9} {:>8} {:>9} {:>8} {:>11}\n", "mu", "mu_r", "local_damping", "rrlinear",
             "impulse", "friction", "rolling", "");
  for (const scree::EquivalenceNode& node : nodes) {
    fmt::print("{:>6g} {:>6g} {:>14g} {:>9.2f} ", node.mu, node.mu_r, node.local_damping,
               node.angle_rrlinear);
    if (node.friction > 0)
      fmt::print("{:>8.2f} {:>9.4f} {:>8.4f}", node.angle_impulse, node.friction, node.rolling);
    else
      fmt::print("{:>8} {:>9} {:>8}", "-", "-", "-");
    fmt::print("{}\n", node.found ? "" : "   left out");
  }
  const fs::path table = out / "equivalent.csv";
  scree::write_text_file(
      table,
      scree::equivalence_csv(
          nodes,
          {fmt::format("Bullet's settings that give rrlinear's {} in {}, within {:g} degrees; {} seeds.",
                       spec.output, spec.scenario.filename().string(), spec.within, spec.seeds.size()),
           fmt::format("Made by scree {} ({}): scree calibrate {}.", SCREE_VERSION, SCREE_REVISION,
                       options.file.filename().string())}));
  const auto found = std::count_if(nodes.begin(), nodes.end(), [](const auto& node) { return node.found; });
  const std::string left_out = fmt::format(
      "{} of {} nodes are left out: no setting of Bullet gives their {} within {:g} {}, or too few "
      "runs gave it",
      std::ssize(nodes) - found, nodes.size(), spec.output, spec.within, scree::unit_of_output(spec.output));
  if (found == 0) {
    fmt::print(stderr, "{}; table: {}\n", left_out, table.string());
    return kFailed;
  }
  if (found < std::ssize(nodes)) fmt::print("\n{}", left_out);
  fmt::print("\ntable: {}; copy it to assets/impulse/equivalent.csv, where engine impulse looks for it\n",
             table.string());
  return kOk;
}

}  // namespace

int run_calibrate(const CalibrateOptions& options) {
  if (!is_of_kind(options.file, scree::FileKind::calibration)) return kBadInput;
  if (scree::is_equivalence(options.file)) return run_equivalence(options);
  const scree::CalibrationSpecResult loaded = scree::load_calibration(options.file);
  if (!nothing_wrong(loaded.errors)) return kBadInput;
  const scree::CalibrationSpec& spec = loaded.spec;
  if (const std::string why = scree::why_not_run(spec, asset_dir()); !why.empty()) {
    fmt::print(stderr, "{}: {}\n", options.file.string(), why);
    return kBadInput;
  }
  if (!options.out.empty() && !may_fill(options.out, options.force)) return kBadInput;
  const std::unique_ptr<scree::ResultsStore> store = open_store(options.ensemble.store, StoreUse::change);
  if (!store) return kBadInput;

  scree::CalibrationResult result;
  const int ended = simulations([&] { result = scree::calibrate(spec, simulator(spec, *store, options)); });
  if (ended != kOk) return ended;
  const fs::path out = options.out.empty() ? free_run_folder(spec.name) : options.out;
  if (!prepare_folder(out, options.force)) return kBadInput;
  const scree::CalibrationAnswer answer = scree::answer_of(spec, result);
  write_tables(spec, result, answer, out);
  write_json(spec, result, answer, out / "calibration.json");
  scree::write_text_file(out / "material.yaml", material_file(spec, answer, result.runs.size()));
  print_answer(spec, result, answer);
  fmt::print("\nresult: {}, material for `extends`: {}\n", (out / "calibration.json").string(),
             (out / "material.yaml").string());
  const fs::path picture = out / "calibration.svg";
  if (draw_picture(spec, result, answer, picture)) fmt::print("picture: {}\n", picture.string());
  const bool met = std::all_of(answer.missed_by.begin(), answer.missed_by.end(),
                               [](double by) { return std::abs(by) <= kMissed; });
  return met ? kOk : kFailed;
}
