#pragma once
// A study file: disposal options that are to be held against each other.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/ensemble/sweep_file.h"

namespace scree {

/// What a study says of an option besides its scenario.
struct StudyEntry {
  double tonnes_per_load = 0;
  std::optional<double> cost_per_t;  ///< in the study's currency
};

struct Study {
  Sweep sweep;                      ///< a point an option, over the one parameter `option`
  std::vector<StudyEntry> options;  ///< in the order of the points
  std::string rank_by = "chi_range";
  std::string currency;
};

/// A study, or everything that is wrong with it.
struct StudyResult {
  Study study;
  std::vector<ScenarioError> errors;
  std::vector<std::string> warnings;  ///< a line each: options that cannot be ranked, or are not alike
};

/// Reads a study file:
///   seeds: [1, 2, 3]      default: those of each scenario
///   rank_by: chi_range    a criterion of analysis/cases/study.h
///   currency: USD
///   options:
///     - name: push dumping
///       scenario: ../thesis/d2.yaml       relative to the study file
///       set: {experiment.payload_t: 200}  values that differ from the scenario's
///       cost_per_load: 40                 truck and ground crew
///       blade_per_hour: 300               of push_dump: one pass over load and distance at the blade's
///       velocity
/// Options must be dumps over a bench.
StudyResult load_study(const std::filesystem::path& file, const std::filesystem::path& asset_dir);

}  // namespace scree
