#pragma once
// A Gaussian process that stands for a simulation: what it would give at parameters that were not run, and
// how sure that is.
//
// y(x) = m + f(x) + noise; f has a Matern 5/2 covariance with one length a dimension; the noise is what
// differs between seeds. m and the variance are integrated out in closed form, lengths and noise over a grid,
// each weighted by its marginal likelihood, so that few points give wide intervals instead of a false
// certainty. Source: Rasmussen & Williams, Gaussian Processes for Machine Learning (2006), 2.7 and 5.4;
// Handcock & Stein, Technometrics 35 (1993).
#include <Eigen/Dense>
#include <vector>

namespace scree {

/// Standard deviations about the mean within which 90 % of a normal distribution lie.
inline constexpr double kDeviations90 = 1.645;

/// Mean and standard deviation at one point.
struct Prediction {
  double mean = 0;
  double std = 0;    ///< of the mean over many seeds: what is not known
  double noise = 0;  ///< standard deviation between seeds
};

class Emulator {
 public:
  // Beyond these it is not made: a matrix of all points is factored for every choice of lengths.
  static constexpr Eigen::Index kLeastPoints = 4, kMostPoints = 1000, kMostDimensions = 3;

  /// `x`: points of the unit cube, a row each (n x d); the same point may come with several seeds. `y`: what
  /// the simulation gave (n). Throws std::invalid_argument beyond the limits above.
  Emulator(const Eigen::MatrixXd& x, const Eigen::VectorXd& y);
  Prediction at(const Eigen::VectorXd& x) const;

 private:
  // One choice of lengths and noise.
  struct Member {
    double weight;
    Eigen::VectorXd lengths;
    double noise_ratio;     // variance of noise over that of f
    double variance, mean;  // of f; m
    Eigen::LLT<Eigen::MatrixXd> factor;
    Eigen::VectorXd weights_y, weights_1;  // R^-1 (y - m), R^-1 1
    double sum_1;                          // 1' R^-1 1
  };
  Eigen::MatrixXd x_;
  std::vector<Member> members_;
};

}  // namespace scree
