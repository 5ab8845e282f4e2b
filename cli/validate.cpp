#include <fmt/format.h>

#include "analysis/results/output_units.h"
#include "cli/commands.h"
#include "cli/ensemble/calibrate.h"
#include "cli/ensemble/dataset_file.h"
#include "cli/ensemble/equivalence_fit.h"
#include "cli/ensemble/file_kind.h"
#include "cli/ensemble/model_file.h"
#include "cli/ensemble/study_file.h"
#include "cli/option_values.h"
#include "sim/material/grading.h"
#include "sim/material/input_bytes.h"
#include "sim/scene/estimate.h"
#include "sim/scene/scenario.h"

namespace {

int validate_dataset(const std::filesystem::path& file) {
  const scree::DatasetResult result = scree::load_dataset(file, asset_dir());
  if (!nothing_wrong(result.errors)) return kBadInput;
  const scree::Dataset& dataset = result.dataset;
  fmt::print("{}: ok: dataset '{}', {} observable{} of {} experiment{}\n", file.string(), dataset.title,
             dataset.observables.size(), dataset.observables.size() == 1 ? "" : "s",
             dataset.experiments.size(), dataset.experiments.size() == 1 ? "" : "s");
  if (!dataset.source.empty()) fmt::print("source: {}\n", dataset.source);
  for (const auto& experiment : dataset.experiments)
    fmt::print("experiment {}: {} ({}){}{}\n", experiment.name, experiment.file.string(),
               scree::experiment_type(experiment.scenario), experiment.overrides.empty() ? "" : ", with ",
               fmt::join(experiment.overrides, ", "));
  fmt::print("\n{:<44} {:>5} {:>12} {:>12} {:>10} {:>8}\n", "observable", "unit", "value", "uncertainty",
             "std", "repeats");
  for (const auto& row : dataset.observables) {
    const std::string unit = scree::unit_of_output(row.output);
    fmt::print("{:<44} {:>5} {:>12.5g} {:>12.3g} {:>10} {:>8}\n", dataset.label(row),
               unit.empty() ? "-" : unit, row.value, row.uncertainty,
               row.std ? fmt::format("{:.3g}", *row.std) : "-",
               row.repeats ? std::to_string(*row.repeats) : "-");
  }
  const Eigen::MatrixXd diagonal = dataset.covariance.diagonal().asDiagonal();
  fmt::print("\n{}\n", dataset.covariance.isApprox(diagonal) ? "The values are taken to be independent."
                                                             : "A covariance of the values is given.");
  for (const std::string& note : dataset.notes) fmt::print("note: {}\n", note);
  return kOk;
}

int validate_sweep(const std::filesystem::path& file) {
  const scree::SweepResult loaded = scree::load_sweep(file, asset_dir());
  if (!nothing_wrong(loaded.errors)) return kBadInput;
  std::size_t runs = 0;
  for (const scree::SweepPoint& point : loaded.sweep.points) runs += point.scenario.seeds.size();
  fmt::print("{}: ok: sweep over {}, {} points, {} runs\n", file.string(),
             fmt::join(loaded.sweep.parameters, ", "), loaded.sweep.points.size(), runs);
  return kOk;
}

int validate_calibration(const std::filesystem::path& file) {
  if (scree::is_equivalence(file)) {
    const scree::EquivalenceSpecResult loaded = scree::load_equivalence(file);
    if (!nothing_wrong(loaded.errors)) return kBadInput;
    fmt::print("{}: ok: equivalent settings of engine impulse, by {}\n", file.string(), loaded.spec.output);
    return kOk;
  }
  const scree::CalibrationSpecResult loaded = scree::load_calibration(file);
  if (!nothing_wrong(loaded.errors)) return kBadInput;
  if (const std::string why = scree::why_not_run(loaded.spec, asset_dir()); !why.empty()) {
    fmt::print(stderr, "{}: {}\n", file.string(), why);
    return kBadInput;
  }
  fmt::print("{}: ok: calibration of {} by {} target{}\n", file.string(),
             fmt::join(scree::names_of(loaded.spec), ", "), loaded.spec.targets.size(),
             loaded.spec.targets.size() == 1 ? "" : "s");
  return kOk;
}

int validate_study(const std::filesystem::path& file) {
  const scree::StudyResult loaded = scree::load_study(file, asset_dir());
  if (!nothing_wrong(loaded.errors, loaded.warnings)) return kBadInput;
  fmt::print("{}: ok: study of {} options, ranked by {}\n", file.string(), loaded.study.options.size(),
             loaded.study.rank_by);
  return kOk;
}

int validate_model(const std::filesystem::path& file) {
  const scree::DiagnosisModelResult loaded = scree::load_model(file, asset_dir());
  if (!nothing_wrong(loaded.errors)) return kBadInput;
  std::vector<std::string> parameters;
  for (const scree::BaseAxis& axis : loaded.model.base) parameters.push_back(axis.key);
  fmt::print("{}: ok: model, parameters {}, effects {}\n", file.string(), fmt::join(parameters, ", "),
             fmt::join(loaded.model.effects, ", "));
  return kOk;
}

int validate_grading(const std::filesystem::path& file) {
  try {
    const scree::Grading grading = scree::read_grading(file);
    fmt::print("{}: ok: grading from {:g} to {:g} m, D10 {:.3g}, D50 {:.3g}, D90 {:.3g} m\n", file.string(),
               grading.min_diameter(), grading.max_diameter(), grading.diameter(0.1), grading.diameter(0.5),
               grading.diameter(0.9));
    return kOk;
  } catch (const scree::FileError& error) {
    fmt::print(stderr,
               "{}; a table is taken for a grading here, one of a dataset is checked with its dataset\n",
               error.what());
    return kBadInput;
  }
}

}  // namespace

int run_validate(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  const scree::FileKind kind = scree::kind_of(file);
  const bool table = file.extension() == ".csv" || file.extension() == ".CSV";
  if ((table || (kind != scree::FileKind::scenario && kind != scree::FileKind::unknown)) &&
      !overrides.empty()) {
    fmt::print(stderr, "--set: changes a scenario, and {} is none\n", file.string());
    return kBadInput;
  }
  if (table) return validate_grading(file);
  switch (kind) {
    case scree::FileKind::dataset:
      return validate_dataset(file);
    case scree::FileKind::sweep:
      return validate_sweep(file);
    case scree::FileKind::calibration:
      return validate_calibration(file);
    case scree::FileKind::study:
      return validate_study(file);
    case scree::FileKind::model:
      return validate_model(file);
    case scree::FileKind::scenario:
    case scree::FileKind::unknown:
      break;
  }
  const scree::ScenarioResult result = scree::load_scenario(file, overrides, asset_dir());
  if (!nothing_wrong(result.errors, result.warnings)) return kBadInput;

  const scree::Scenario& scenario = result.scenario;
  const scree::Grading grading = scree::effective_model(scenario).grading;
  const double mass = scree::total_mass(scenario);
  std::string seeds;
  for (const auto seed : scenario.seeds) seeds += (seeds.empty() ? "" : ", ") + std::to_string(seed);
  std::string effects;
  for (const scree::EffectUse& use : scenario.effects)
    effects += fmt::format("{}{}", effects.empty() ? ", effects " : ", ", use.effect->name);
  fmt::print("{}: ok: {}, engine {}, grading {}, {:g} t, about {:.0f} spheres, seeds {}{}\n", file.string(),
             scree::experiment_type(scenario),
             scenario.engine == scree::EngineKind::rrlinear ? "rrlinear" : "impulse", grading.name(),
             mass / 1000, scree::estimated_spheres(scenario), seeds, effects);
  for (const std::string& effect : scree::effects_in_words(scenario)) fmt::print("effect {}\n", effect);
  return 0;
}
