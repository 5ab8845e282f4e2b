// scree analyse: snapshots of any program as observables, and as a dataset.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>

#include "analysis/report/report_text.h"
#include "analysis/results/output_units.h"
#include "analysis/results/outputs.h"
#include "cli/commands.h"
#include "cli/ensemble/dataset_write.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "cli/snapshot_outputs.h"
#include "cli/written_dataset.h"
#include "sim/material/input_text.h"
#include "sim/scene/scenario.h"

namespace fs = std::filesystem;

namespace {

// The scenario that says how to look at the pile; none, with a message, if it cannot be had.
std::optional<scree::Scenario> scenario_of(const AnalyseOptions& options) {
  if (options.scenario.empty() == options.experiment.empty()) {
    fmt::print(stderr, "scree: --scenario FILE or --experiment TYPE is needed, one of them\n");
    return std::nullopt;
  }
  if (!options.scenario.empty()) {
    if (!is_of_kind(options.scenario, scree::FileKind::scenario)) return std::nullopt;
    scree::ScenarioResult loaded =
        scree::load_scenario(options.scenario, options.overrides, asset_dir(), scree::ReadFor::numbers);
    if (!nothing_wrong(loaded.errors, loaded.warnings)) return std::nullopt;
    return std::move(loaded.scenario);
  }
  scree::Scenario scenario;
  if (options.experiment == "repose_lift") {
    scenario.experiment = scree::ReposeLift{};
  } else if (options.experiment == "bucket_dump") {
    scenario.experiment = scree::BucketDump{};
  } else {
    const bool bench = options.experiment == "end_dump" || options.experiment == "push_dump";
    fmt::print(stderr, "--experiment {}: {}\n", options.experiment,
               bench ? "the height of the bench and its sections are needed: --scenario FILE"
                     : "repose_lift or bucket_dump; for dumps over a bench --scenario FILE");
    return std::nullopt;
  }
  if (!options.overrides.empty()) {
    fmt::print(stderr, "--set changes a scenario: --scenario FILE is needed\n");
    return std::nullopt;
  }
  return scenario;
}

std::optional<scree::SnapshotOptions> reading_of(const AnalyseOptions& options,
                                                 const scree::Scenario& scenario) {
  scree::SnapshotOptions reading;
  reading.frame = options.frame;
  reading.density = scenario.material.density;
  reading.up = options.up == "y" ? scree::SnapshotOptions::Up::y : scree::SnapshotOptions::Up::z;
  if (!options.length_unit.empty()) {
    reading.length_unit = scree::unit_factor(options.length_unit, "m");
    if (!reading.length_unit) {
      fmt::print(stderr, "--length-unit {}: one of m, cm, mm\n", options.length_unit);
      return std::nullopt;
    }
  }
  if (!options.shift.empty()) {
    std::string_view rest = options.shift;
    for (int axis = 0; axis < 3; ++axis) {
      const auto comma = std::min(rest.find(','), rest.size());
      const auto value = scree::number_in(rest.substr(0, comma));
      if (!value || (axis < 2) != (comma < rest.size())) {
        fmt::print(stderr, "--shift {}: three numbers in metres, x,y,z\n", options.shift);
        return std::nullopt;
      }
      reading.shift[axis] = *value;
      rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
  }
  return reading;
}

// What a dataset gets unless it is chosen: numbers that say different things of a pile.
bool is_of_the_core(const std::string& output) {
  static const std::regex core(
      "angle_deg|slope_angle_deg|spread_95|profile_(25|50|75)|(chi|mass_share)_ring[123]|"
      "(chi|mass_t)_(S[0-9]+|top|middle|bottom)");
  return std::regex_match(output, core);
}

void print_table(const std::map<std::string, scree::MeanStd>& table) {
  fmt::print("{:<28} {:>6} {:>12} {:>12} {:>4}\n", "observable", "unit", "mean", "std", "n");
  for (const auto& [name, value] : table) {
    const std::string unit = scree::unit_of_output(name);
    const int decimals = scree::decimals_of(value.mean, 4);
    fmt::print("{:<28} {:>6} {:>12.{}f} {:>12} {:>4}\n", name, unit.empty() ? "-" : unit, value.mean,
               decimals, value.n > 1 ? fmt::format("{:.{}f}", value.std, decimals) : "-", value.n);
  }
}

int write_dataset_of(const AnalyseOptions& options, const scree::Scenario& scenario,
                     const std::map<std::string, scree::MeanStd>& table) {
  scree::DatasetDraft draft;
  draft.title = scenario.title.empty() ? scenario.name : scenario.title;
  std::vector<std::string> names;
  for (const fs::path& file : options.files) names.push_back(file.filename().string());
  draft.source = fmt::format("scree analyse {}", fmt::join(names, " "));
  scree::DatasetDraft::Experiment experiment;
  experiment.name = std::regex_replace(scenario.name, std::regex("[/,;\"]"), "_");
  experiment.scenario = options.scenario;
  experiment.overrides = options.overrides;
  draft.relative_uncertainty = options.relative_uncertainty;
  for (const auto& [name, value] : table) {
    const auto& chosen = options.observables;
    if (chosen.empty() ? is_of_the_core(name) : std::find(chosen.begin(), chosen.end(), name) != chosen.end())
      experiment.observables[name] = value;
  }
  draft.experiments.push_back(std::move(experiment));
  WrittenDataset dataset(options.out, [&](const fs::path& folder) {
    return note_of_left_out(scree::write_dataset(draft, folder));
  });
  if (dataset.check() != kOk || !prepare_folder(options.out, options.force)) return kBadInput;
  dataset.put_in_place();
  return kOk;
}

}  // namespace

int run_analyse(const AnalyseOptions& options) {
  if (given_twice(options.files)) return kBadInput;
  const auto scenario = scenario_of(options);
  if (!scenario) return kBadInput;
  const auto reading = reading_of(options, *scenario);
  if (!reading) return kBadInput;
  if (!options.out.empty()) {
    if (options.scenario.empty()) {
      fmt::print(stderr, "--out: a dataset names the scenario that simulates it: --scenario FILE\n");
      return kBadInput;
    }
    if (options.files.size() == 1 && !options.relative_uncertainty) {
      fmt::print(stderr,
                 "--out: one snapshot says nothing of the scatter between repeats: give several, or "
                 "--relative-uncertainty 0.1 (of each value)\n");
      return kBadInput;
    }
    if (!may_fill(options.out, options.force)) return kBadInput;
  }
  std::map<std::string, std::vector<double>> values;
  std::vector<std::string> found, notes;
  if (options.scenario.empty())
    notes.emplace_back(
        "chi and ratios are against the rock of each pile itself; --scenario FILE gives the grading as "
        "dumped");
  try {
    for (const fs::path& file : options.files) {
      scree::SnapshotRead read = scree::read_snapshot(file, *reading);
      found.push_back(fmt::format("{}: {} grains", file.string(), read.snapshot.grains.size()));
      std::vector<std::string> of_file = read.notes;
      const fs::path folder = fs::absolute(file).parent_path();
      if (std::error_code none; file.filename().string().starts_with("particles.") &&
                                folder.filename().string().starts_with("seed_") &&
                                fs::exists(folder.parent_path() / "resume.json", none))
        of_file.push_back(fmt::format("{}: the run that it belongs to has not ended", file.string()));
      try {
        for (const auto& [name, value] : scree::outputs_of_snapshot(*scenario, std::move(read), of_file))
          values[name].push_back(value);
      } catch (const std::invalid_argument& error) {
        throw scree::FileError(file, 0, error.what());
      }
      for (const std::string& note : of_file)
        if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
    }
  } catch (const scree::FileError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kBadInput;
  }
  std::map<std::string, scree::MeanStd> table;
  for (const auto& [name, list] : values) table[name] = scree::mean_std(list);
  for (const std::string& name : options.observables)
    if (!table.contains(name)) {
      fmt::print(stderr, "--observables {}: these piles do not give it\n", name);
      return kBadInput;
    }
  for (const std::string& line : found) fmt::print("{}\n", line);
  for (const std::string& note : notes) fmt::print("note: {}\n", note);
  print_table(table);
  return options.out.empty() ? kOk : write_dataset_of(options, *scenario, table);
}
