#include <fmt/format.h>

#include "analysis/results/output_units.h"
#include "cli/commands.h"
#include "cli/ensemble/dataset_file.h"
#include "sim/scene/estimate.h"
#include "sim/scene/scenario.h"

namespace {

int validate_dataset(const std::filesystem::path& file) {
  const scree::DatasetResult result = scree::load_dataset(file, asset_dir());
  for (const scree::ScenarioError& error : result.errors) fmt::print(stderr, "{}\n", error.text());
  if (!result.errors.empty()) return kBadInput;
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

}  // namespace

int run_validate(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  if (scree::is_dataset(file)) {
    if (overrides.empty()) return validate_dataset(file);
    fmt::print(stderr, "--set: a dataset names what differs from its scenarios itself (set)\n");
    return kBadInput;
  }
  const scree::ScenarioResult result = scree::load_scenario(file, overrides, asset_dir());
  for (const std::string& warning : result.warnings) fmt::print(stderr, "warning: {}\n", warning);
  for (const scree::ScenarioError& error : result.errors) fmt::print(stderr, "{}\n", error.text());
  if (!result.errors.empty()) return kBadInput;

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
  return 0;
}
