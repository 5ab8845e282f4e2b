#pragma once
// The evidence for a hypothesis: its likelihood, averaged over what is not known of its parameters.
#include <Eigen/Dense>
#include <functional>
#include <vector>

namespace scree {

/// A box of parameters, uniform a priori.
struct ParameterBox {
  Eigen::VectorXd low, high;
};

struct Evidence {
  double log_evidence = 0;
  double log_error = 0;         ///< standard deviation of it, from the samples
  Eigen::VectorXd most_likely;  ///< of the samples
  Eigen::MatrixXd samples;      ///< a row each
  Eigen::VectorXd weights;      ///< sum to 1
  ParameterBox box;

  /// Below which a share of the probability of one parameter lies.
  double quantile(Eigen::Index parameter, double share) const;
  struct Range {
    double low, high;
  };
  /// The shortest range that holds a share of the probability of one parameter: with one mode, what is most
  /// probable is in it, also at the end of the box. Ends nearer to the box's than a hundredth of its width
  /// are the box's.
  Range shortest(Eigen::Index parameter, double share) const;
};

/// Integrates exp(log_likelihood) over the box by adaptive importance sampling, from the prior to the
/// posterior in steps of temperature (Cornuet et al., Scand. J. Stat. 39 (2012)). The same arguments give the
/// same numbers.
Evidence integrate(const std::function<double(const Eigen::VectorXd&)>& log_likelihood,
                   const ParameterBox& box, std::uint64_t seed);

}  // namespace scree
