#pragma once
// A sweep file: a scenario, and the values that some of its keys take in turn.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "sim/scene/scenario.h"

namespace scree {

/// One point: keys of the scenario and their values, as text.
struct SweepPoint {
  std::vector<std::string> values;  ///< in the order of Sweep::parameters
  std::string compare;              ///< case in assets/reference/results.csv; may be empty
  Scenario scenario;                ///< with these values, checked; its seeds are those to run
};

/// 0.2 and 0.20 are the same value of a parameter.
bool same_value(const std::string& a, const std::string& b);

struct Sweep {
  std::string name;                     ///< the file's stem
  std::vector<std::string> parameters;  ///< dotted keys of the scenario: material.mu
  std::vector<SweepPoint> points;
};

/// A sweep, or everything that is wrong with it.
struct SweepResult {
  Sweep sweep;
  std::vector<ScenarioError> errors;
  std::vector<std::string> warnings;  ///< a line each, of all points
};

/// Reads a sweep file:
///   scenario: repose_lab.yaml       relative to the sweep file
///   seeds: [1, 2, 3]                default: those of the scenario
///   set: {material.local_damping: 0.4}   further values that differ from the scenario's
///   ties: {material.mu_r: material.mu}   the first key takes the value of the second
///   compare: lab_repose_{material.mu}_{material.mu_r}   printed case of each point
///   design:
///     type: grid | list | latin_hypercube | sobol
///     parameters: {material.mu: [0.1, 0.2]}          grid: every combination
///     points: [{material.mu: 0.2}, ...]               list
///     parameters: {material.mu: {from: 0.1, to: 0.8}} latin_hypercube, sobol, with points: N (and seed: N)
/// Every point is loaded and checked as a scenario.
SweepResult load_sweep(const std::filesystem::path& file, const std::filesystem::path& asset_dir);

/// Scenario files as the points of a sweep with the one parameter `case`, the file's stem. `seeds`: how many
/// of each, at most; 0: all that it has. Warns of what the scenarios are warned of, and of cases with fewer
/// seeds than asked for.
SweepResult load_cases(const std::vector<std::filesystem::path>& files, int seeds,
                       const std::filesystem::path& asset_dir);

}  // namespace scree
