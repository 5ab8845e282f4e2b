#pragma once
// What was measured, as a vector with its covariance, and what a model gives for it.
#include <Eigen/Dense>
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/misfit.h"
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

/// The covariance that a diagnosis uses: a deviation between few repeats is itself uncertain, and so are
/// correlations; the numbers of one test are correlated, while most tables do not state how.
///
/// Of values with the deviation s of n repeats, S is the covariance between seeds of the simulation, and k
/// the mean over the experiment of s^2 / S (of logarithms).
///
/// - Correlations are not stated: the variance between repeats is (m k S + (n - 1) s^2) / (m + n - 1) with
///   m = 10; the covariance of two such values is S's times min(k, 1); both over n. Together they are a block
///   (misfit.h): its scale is k's, whose freedom is the sum of the values'.
/// - p values whose correlations with each other are stated, V their covariance from n tests, are a block:
///   the scale of Student's t is (n - 1) V / (n - p) with n - p degrees of freedom (Hotelling 1931). With
///   less than p + 20 tests k S joins them as p + m more: ((p + m) k S + (n - 1) V) / (n + m) with n + m
///   degrees of freedom (inverse Wishart; Gelman et al., Bayesian Data Analysis, 3.6).
/// - What the stated uncertainty holds beyond s / sqrt(n) is added to the diagonal and is known: the freedom
///   of the block is that of its scatter over the mean square of scatter's share in its variances
///   (Welch-Satterthwaite).
/// - Where such correlated values are less certain than their repeats say (by more than a fifth of the
///   variance), or belong to several experiments, their covariance is of errors that they share, too. What
///   part is scatter is not said: all of it counts as known from n tests, (n - 1) / (n - p) times as stated
///   with n - p degrees of freedom, 1 at least.
/// - Other values stay as stated and are known.
struct WorkingCovariance {
  Eigen::MatrixXd matrix;
  std::vector<ScatterBlock> blocks;  ///< what is known first
};
WorkingCovariance working_covariance(const Measurements& measured,
                                     const std::vector<const ResponseSurface*>& surfaces);

/// Section of an output, the end of its name (S1, top, ring2); empty if it is of the whole.
std::string section_of_output(const std::string& output);
/// What is measured: the name without its section.
std::string quantity_of_output(const std::string& output);

}  // namespace scree
