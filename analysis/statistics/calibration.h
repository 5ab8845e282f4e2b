#pragma once
// From targets and emulators to the parameters that meet them.
#include <array>
#include <functional>
#include <vector>

#include "analysis/statistics/emulator.h"

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
  /// True if the probability does not vanish towards an end of a parameter's range: more than a seventh of
  /// its largest value.
  bool cut_off(int dimension) const;
  /// How much larger the uncertainty of what is aimed at is than that of the targets alone, because the
  /// emulator is not sure: 0.05 is 5 per cent; mean over the posterior, the worst target.
  double excess_uncertainty() const;
  /// Points at which further simulations would help most: likely, not well known, and not close together.
  std::vector<Eigen::VectorXd> next_points(int count) const;

 private:
  std::vector<double> marginal(int dimension) const;
  int dimensions_, side_;
  std::size_t targets_;
  std::vector<double> uncertainty_;  // by target
  std::vector<double> density_;
  std::vector<Prediction> predictions_;
};

/// A number over two parameters on a rectangular grid, bilinear in between.
struct ParameterMap {
  std::vector<double> x, y;                ///< rising, two at least
  std::vector<std::vector<double>> value;  ///< [y][x]; NaN where nothing is known
  double at(double x, double y) const;
};

/// Pairs at which a map has the value `level`, by rising x: crossings of some hundred lines along either
/// axis.
std::vector<std::array<double, 2>> level_pairs(const ParameterMap& map, double level);

/// Where a map has the value `level` and both parameters are equal; NaN if nowhere.
double level_where_equal(const ParameterMap& map, double level);

/// First x at which a line of points (rising x, linear in between) has the value `level`; NaN if nowhere.
double crossing(const std::vector<double>& x, const std::vector<double>& value, double level);

}  // namespace scree
