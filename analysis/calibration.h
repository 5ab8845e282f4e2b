#pragma once
// From targets and emulators to the parameters that meet them.
#include <array>
#include <functional>
#include <vector>

#include "analysis/emulator.h"

namespace scree {

/// A measured number that the simulation should give, and the emulator of what it gives.
struct CalibrationTarget {
  double value = 0;
  double uncertainty = 0;  ///< standard deviation of the measured number
  const Emulator* emulator = nullptr;
};

/// Probability of the parameters on a regular grid over their unit cube.
class Posterior {
 public:
  /// A uniform prior times the likelihood of every target (normal, the emulator's own uncertainty added to
  /// the target's). 1 to 3 dimensions.
  Posterior(const std::vector<CalibrationTarget>& targets, int dimensions);

  int side() const { return side_; }  ///< nodes along each axis
  std::size_t size() const { return density_.size(); }
  Eigen::VectorXd point(std::size_t node) const;
  double density(std::size_t node) const { return density_[node]; }  ///< sums to 1
  const Prediction& prediction(std::size_t node, std::size_t target) const {
    return predictions_[node * targets_ + target];
  }
  Eigen::VectorXd mean() const;
  Eigen::VectorXd most_likely() const;
  /// Interval of one parameter that holds `share` of the probability, the same below and above.
  std::array<double, 2> interval(int dimension, double share) const;
  /// How much larger the uncertainty of what is aimed at is than that of the targets alone, because the
  /// emulator is not sure: 0.05 is 5 per cent; mean over the posterior, the worst target.
  double excess_uncertainty() const;
  /// Points at which further simulations would help most: likely, not well known, and not close together.
  std::vector<Eigen::VectorXd> next_points(int count) const;

 private:
  int dimensions_, side_;
  std::size_t targets_;
  std::vector<double> uncertainty_;  // by target
  std::vector<double> density_;
  std::vector<Prediction> predictions_;
};

/// Where a function on a rectangular grid, linear in between, has the value `level`: for each x the first y,
/// NaN where there is none. `value`: [y][x].
std::vector<double> level_line(const std::vector<double>& x, const std::vector<double>& y,
                               const std::vector<std::vector<double>>& value, double level);

/// First x at which a line of points (rising x, linear in between) has the value `level`; NaN if nowhere.
double crossing(const std::vector<double>& x, const std::vector<double>& value, double level);

}  // namespace scree
