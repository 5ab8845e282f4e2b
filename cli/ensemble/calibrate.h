#pragma once
// The loop of a calibration: simulate where it helps, emulate, find the parameters that meet the targets.
#include <Eigen/Dense>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "analysis/statistics/calibration.h"
#include "cli/ensemble/calibration_file.h"

namespace scree {

/// One simulation that a calibration asks for.
struct CalibrationRun {
  std::filesystem::path scenario;
  Eigen::VectorXd at;  ///< parameters, each from 0 to 1 between its ends
  std::uint64_t seed = 0;
};

/// Does simulations (as many at once as it likes) and returns the number asked for of each target's scenario:
/// [run][target], NaN for a target of another scenario. Throws CalibrationStopped, std::runtime_error.
using Simulator = std::function<std::vector<std::vector<double>>(const std::vector<CalibrationRun>& runs)>;

struct CalibrationStopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct CalibrationResult {
  std::vector<CalibrationRun> runs;
  std::vector<std::vector<double>> values;           ///< [run][target]
  std::vector<std::shared_ptr<Emulator>> emulators;  ///< by target
  std::shared_ptr<Posterior> posterior;
  /// Grid only, by target: means over seeds at the nodes, the first parameter fastest.
  std::vector<std::vector<double>> grid;
};

/// What a calibration answers.
struct CalibrationAnswer {
  std::vector<double> value;                    ///< of each parameter
  std::vector<std::array<double, 2>> interval;  ///< of each parameter, 90 % of the probability
  std::vector<bool> cut_off;                    ///< the range of the parameter cuts the probability off
  std::vector<Prediction> at_value;             ///< of each target
  /// By how many standard deviations (target's and emulator's) each target is missed.
  std::vector<double> missed_by;
  /// One target and a grid of one parameter: linear between its points.
  std::optional<double> interpolated;
  std::optional<ParameterMap> map;          ///< two parameters: the first target's number over them
  std::vector<std::array<double, 2>> line;  ///< two parameters: pairs that give the first target
  std::optional<double> equal;              ///< one target, mu and mu_r: where both are equal
  std::optional<std::array<double, 2>> equal_interval;  ///< 90 % of the probability on that line
};

/// One parameter: the mean of the posterior; two: the most likely pair; three: the mean. With a single target
/// the thesis's ways go before these: on a grid of one parameter linear between its points; of mu and mu_r
/// the pair that is equal and gives the target, with the interval along that line, if there is one.
CalibrationAnswer answer_of(const CalibrationSpec& spec, const CalibrationResult& result);

/// Keys of the parameters.
std::vector<std::string> names_of(const CalibrationSpec& spec);
/// A value of a parameter, or of all of them, from its share of the way between its ends.
double parameter_value(const CalibrationSpec& spec, int parameter, double share);
std::vector<double> values_at(const CalibrationSpec& spec, const Eigen::VectorXd& shares);
/// One of its scenarios with these values of the parameters.
ScenarioResult calibrated_scenario(const CalibrationSpec& spec, const std::filesystem::path& scenario,
                                   const std::vector<double>& values, const std::filesystem::path& asset_dir);
/// What would be refused only after simulations have cost time: ends of the ranges, and outputs that a
/// scenario does not give. Empty if all is well.
std::string why_not_run(const CalibrationSpec& spec, const std::filesystem::path& asset_dir);

/// Runs the calibration. `bayes`: a Sobol design first, a new seed at each point; then, some at a time, where
/// the posterior says that it helps most.
CalibrationResult calibrate(const CalibrationSpec& spec, const Simulator& simulate);

}  // namespace scree
