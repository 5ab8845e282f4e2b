#pragma once
// What was measured in pictures of a slope, as a dataset.
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/field/field_analysis.h"
#include "cli/ensemble/output_scope.h"

namespace scree {

struct FieldDatasetRequest {
  std::filesystem::path scenario;        ///< that simulates the slope
  MeasuredSections sections;             ///< in its outputs
  std::string source;                    ///< where the numbers come from
  std::vector<std::string> observables;  ///< chi, d50_m, d50_rel ...; empty: chi
};

/// Writes dataset.yaml, observables.csv and covariance.csv: mean and deviation over pictures of each quantity
/// in each section, and the covariance of the means. Correlations are those of the pictures that have all of
/// them; with fewer such pictures than observables they are not known, and no covariance is written. Returns
/// what the reader should know, a line each. Throws std::invalid_argument for an observable that pictures do
/// not give, std::runtime_error as write_dataset().
std::vector<std::string> write_field_dataset(const FieldAnalysis& field, const FieldDatasetRequest& request,
                                             const std::filesystem::path& folder);

}  // namespace scree
