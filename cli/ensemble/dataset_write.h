#pragma once
// Writing a dataset of what was measured in repeats.
#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/results/results.h"

namespace scree {

/// What a dataset is made of.
struct DatasetDraft {
  struct Experiment {
    std::string name;
    std::filesystem::path scenario;
    std::vector<std::string> overrides;  ///< "key=value"; files are those found from the working folder
    std::map<std::string, MeanStd> observables;
  };
  /// Of the values, in the units of their outputs; its diagonal holds the squares of std / sqrt(repeats).
  struct Covariance {
    std::vector<std::string> names;  ///< experiment/observable
    Eigen::MatrixXd matrix;
  };
  std::string title, source;
  std::vector<Experiment> experiments;
  std::optional<Covariance> covariance;
  std::optional<double> relative_uncertainty;  ///< of those with one repeat
};

/// Writes dataset.yaml, observables.csv and, if there is one, covariance.csv into a folder that is there.
/// Observables without a scatter between repeats have no uncertainty: they are left out unless
/// `relative_uncertainty` is given, and returned, as experiment/observable. Throws
/// std::invalid_argument if nothing is left, std::runtime_error if a file cannot be written.
std::vector<std::string> write_dataset(const DatasetDraft& draft, const std::filesystem::path& folder);

}  // namespace scree
