#pragma once
// A calibration file: which parameters are free, and what the simulation should give.
#include <filesystem>
#include <string>
#include <vector>

#include "cli/ensemble/file_reader.h"

namespace scree {

struct CalibrationSpec {
  std::string name;  ///< the file's stem
  std::vector<FileReader::Span> parameters;
  Variation variation;
  std::vector<std::uint64_t> seeds;

  struct Target {
    std::string output;  ///< name of a run's number (analysis/results/outputs.h)
    double value = 0, uncertainty = 0;
    std::filesystem::path scenario;  ///< the one that gives it
  };
  std::vector<Target> targets;

  enum class Method { grid, bayes };
  Method method = Method::bayes;
  int grid_points = 4;        ///< grid: nodes along each parameter
  int first_points = 5;       ///< bayes: points of the first design
  int most_simulations = 24;  ///< bayes: of all scenarios together
  int together = 2;           ///< bayes: simulations chosen at a time, whatever the number of cores
  double enough = 0.05;       ///< bayes: ends when ignorance adds less than this share to the uncertainty
};

struct CalibrationSpecResult {
  CalibrationSpec spec;
  std::vector<ScenarioError> errors;
};

/// Reads a calibration file:
///   scenario: repose_lab.yaml
///   seeds: [1, 2, 3]
///   set: {experiment.mass_kg: 40}
///   parameters: {material.mu: {from: 0.1, to: 0.4}}    1 to 3 of them
///   ties: {material.mu_r: material.mu}
///   targets:
///     - {output: angle_deg, value: 25.4, uncertainty: 1.5, scenario: (default: the one above)}
///     - {passing_curve: measured.csv, section: S6, uncertainty: 0.03}   D10, D50, D80, D90 of the section
///   method: {type: grid, points: 4} or {type: bayes, first: 5, most: 24, enough: 0.05}
CalibrationSpecResult load_calibration(const std::filesystem::path& file);

}  // namespace scree
