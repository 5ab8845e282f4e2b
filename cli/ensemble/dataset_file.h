#pragma once
// A dataset: what was measured, how well, and which scenario simulates it.
#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/ensemble/file_reader.h"
#include "sim/scene/scenario.h"

namespace scree {

/// Measurements of one or more experiments.
struct Dataset {
  std::string name;    ///< the file's stem, of `dataset.yaml` its folder
  std::string title;   ///< of the file; its name where it has none
  std::string source;  ///< where the numbers come from; may be empty

  struct Experiment {
    std::string name;
    std::filesystem::path file;          ///< of the scenario
    std::vector<std::string> overrides;  ///< "key=value"
    Scenario scenario;                   ///< loaded with these, checked
  };
  std::vector<Experiment> experiments;  ///< in the order of the file

  struct Observable {
    std::size_t experiment = 0;  ///< index into `experiments`
    std::string output;          ///< a name of analysis/results/outputs.h, which the scenario gives
    double value = 0;            ///< in the output's own unit (analysis/results/output_units.h), as all below
    double uncertainty = 0;      ///< standard uncertainty of the value, above 0
    std::optional<double> std;   ///< between repeats, where given
    std::optional<int> repeats;  ///< where given
    int line = 0;                ///< in the table
  };
  std::vector<Observable> observables;  ///< in the order of the table; experiment and output distinct

  /// n x n of the observables, symmetric positive definite; its diagonal holds the squares of `uncertainty`.
  Eigen::MatrixXd covariance;
  std::vector<std::string> notes;  ///< what was assumed or passed over, for the reader

  /// "experiment/output".
  std::string label(const Observable& observable) const {
    return experiments[observable.experiment].name + "/" + observable.output;
  }
};

/// A dataset, or everything that is wrong with it; with errors the dataset is empty.
struct DatasetResult {
  Dataset dataset;
  std::vector<ScenarioError> errors;
};

/// Reads a dataset file and its tables (docs/datasets.md):
///   title, source: text
///   experiments: {NAME: {scenario: PATH relative to this file, set: {KEY: VALUE}}}
///   observables: measured.csv          columns experiment, observable, value, unit, std, repeats,
///   uncertainty,
///                                      source
///   covariance: covariance.csv         optional; square, named experiment/observable, units of the table
///   default_relative_uncertainty: 0.1  optional; of the value, for rows that have no uncertainty
///
/// The standard uncertainty of a value is `uncertainty` where given, else std / sqrt(repeats), else std alone
/// (which becomes a note), else that of the covariance, else the default.
DatasetResult load_dataset(const std::filesystem::path& file, const std::filesystem::path& asset_dir);

/// One entry of `experiments`: a name and its scenario, relative to `file`; none, with errors, if it is not
/// one. `allowed`: its keys.
std::optional<Dataset::Experiment> read_experiment(const YamlEntry& entry, const std::filesystem::path& file,
                                                   const std::filesystem::path& asset_dir,
                                                   const std::vector<std::string>& allowed,
                                                   FileReader& reader);

}  // namespace scree
