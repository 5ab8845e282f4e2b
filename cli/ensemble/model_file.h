#pragma once
// A model file: which parameters of the simulation are uncertain, and which effects may be missing.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "analysis/diagnose/model_space.h"
#include "cli/ensemble/dataset_file.h"
#include "cli/ensemble/file_reader.h"

namespace scree {

/// An experiment that could be made, and what it would measure.
struct ModelExperiment {
  Dataset::Experiment experiment;
  std::vector<std::string> observables;
  /// Standard deviation of one measurement's error, where it is stated, of observables.
  std::map<std::string, double> errors;
};

/// Simulations of each experiment.
struct SimulationCounts {
  int nominal = 6;  ///< at the nominal parameters
  int base = 24;    ///< over the ranges of the base parameters
  int effect = 10;  ///< of each effect
  int check = 4;    ///< of a fitted model, with fresh seeds
  int rounds = 4;   ///< of simulating fitted models and fitting again, at most: of one effect, from when a
                    ///< pair first leads, and of a name that its simulations have not borne out
};

struct DiagnosisModel {
  std::string name;  ///< the file's stem
  std::string title;
  std::vector<BaseAxis> base;
  Variation variation;               ///< of every experiment, after what the dataset sets
  std::vector<std::string> effects;  ///< names of those to be considered
  std::vector<ModelExperiment> experiments;
  SimulationCounts simulations;
  Place place;                          ///< of the file's content
  std::map<std::string, Place> places;  ///< of the keys in parameters, ties and set
};

struct DiagnosisModelResult {
  DiagnosisModel model;
  std::vector<ScenarioError> errors;
};

/// Reads a model file (docs/diagnose.md):
///   title: text
///   parameters: {material.mu: {nominal: 0.2, from: 0.12, to: 0.32}}   1 to 6
///   ties: {material.mu_r: material.mu}
///   set: {KEY: VALUE}
///   effects: [cohesion, twisting]          default: all there are
///   simulations: {nominal: 6, base: 24, effect: 10, check: 4, rounds: 4}
///   experiments: {NAME: {scenario: FILE, set: {..}, observables: [angle_deg], errors: {angle_deg: 0.5}}}
/// The experiments are for twins and may be left out.
DiagnosisModelResult load_model(const std::filesystem::path& file, const std::filesystem::path& asset_dir);

/// What would be refused only in the middle of a design: reasons why the experiment is no scenario at an end
/// of the parameters' ranges, at the keys of the model; none if all is well.
std::vector<ScenarioError> why_not_simulated(const DiagnosisModel& model,
                                             const Dataset::Experiment& experiment,
                                             const std::filesystem::path& asset_dir);

/// The space that a diagnosis of these experiments searches: the model's effects that act in any of them,
/// with what the model sets, less those of `without`.
ModelSpace space_of(const DiagnosisModel& model, const std::vector<Dataset::Experiment>& experiments,
                    const std::vector<std::string>& without, const std::filesystem::path& asset_dir);

/// Overrides "key=value" that make an experiment's scenario that of a point of the space.
std::vector<std::string> overrides_at(const DiagnosisModel& model, const ModelSpace& space,
                                      const Dataset::Experiment& experiment, const ModelPoint& point);

}  // namespace scree
