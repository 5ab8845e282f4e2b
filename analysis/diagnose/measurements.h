#pragma once
// What was measured, as a vector with its covariance, and what a model gives for it.
#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/response_surface.h"

namespace scree {

/// A number that was measured, and where.
struct MeasuredValue {
  std::size_t experiment = 0;  ///< index into Measurements::experiments
  std::string output;          ///< a name of analysis/results/outputs.h
  std::string label;           ///< experiment/output
  double value = 0;
  double uncertainty = 0;     ///< standard uncertainty as stated
  std::optional<double> std;  ///< between repeats
  std::optional<int> repeats;
};

/// Numbers of one or more experiments; those of one experiment follow each other.
struct Measurements {
  std::vector<std::string> experiments;
  std::vector<MeasuredValue> values;
  Eigen::MatrixXd covariance;  ///< as stated; diagonal where nothing was said of correlations

  Eigen::VectorXd vector() const;
  /// Indices of the values of an experiment.
  std::vector<Eigen::Index> of(std::size_t experiment) const;
};

/// The covariance that a diagnosis uses: a deviation between few repeats is itself uncertain, and the numbers
/// of one test are correlated, while most tables state neither.
///
/// For a value with the deviation s of n repeats whose correlations are not stated, the variance between
/// repeats is (m k S + (n - 1) s^2) / (m + n - 1) with S that between seeds of the simulation, k the mean
/// over the experiment of s^2 / S, and m = 10; the covariance of two such values is S's times min(k, 1); both
/// over n. What the stated uncertainty holds beyond s / sqrt(n) is added to the diagonal. Values without a
/// deviation, and stated covariances, stay as they are.
///
/// `freedom`: degrees of freedom of the scatter, the sum of n - 1 over such values; infinite without any.
/// Squares over this covariance follow Fisher's F, not chi-square: common scales are as uncertain as that.
struct WorkingCovariance {
  Eigen::MatrixXd matrix;
  double freedom = 0;
};
WorkingCovariance working_covariance(const Measurements& measured,
                                     const std::vector<const ResponseSurface*>& surfaces);

/// Section of an output, the end of its name (S1, top, ring2); empty if it is of the whole.
std::string section_of_output(const std::string& output);
/// What is measured: the name without its section.
std::string quantity_of_output(const std::string& output);

}  // namespace scree
