#include "analysis/statistics/emulator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scree {
namespace {

constexpr double kLengths[] = {0.2, 0.35, 0.6, 1.0, 1.7, 3.0};  // of the unit cube's side
constexpr double kNoiseRatios[] = {1e-4, 1e-3, 5e-3, 0.02, 0.08, 0.3, 1.0};
constexpr double kLeastWeight = 1e-3;  // of the best; members below are left out

double matern52(double distance) {
  const double a = std::sqrt(5.0) * distance;
  return (1 + a + a * a / 3) * std::exp(-a);
}

double covariance(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Eigen::VectorXd& lengths) {
  return matern52((a - b).cwiseQuotient(lengths).norm());
}

}  // namespace

Emulator::Emulator(const Eigen::MatrixXd& x, const Eigen::VectorXd& y) : x_(x) {
  const auto n = x.rows(), d = x.cols();
  if (n < kLeastPoints || n > kMostPoints || d < 1 || d > kMostDimensions || y.size() != n ||
      !x.allFinite() || !y.allFinite())
    throw std::invalid_argument("an emulator cannot be made of these points");
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(n);
  // A constant answer has no variance to scale by.
  const double least = 1e-12 * (y.squaredNorm() + 1e-300);
  const double freedom = static_cast<double>(n - 1);
  // One choice of lengths and noise, and the logarithm of its weight.
  const auto member = [&](Eigen::Index choice, double& log_weight) {
    Member m;
    m.lengths.resize(d);
    for (Eigen::Index k = 0; k < d; ++k) {
      m.lengths[k] = kLengths[choice % std::ssize(kLengths)];
      choice /= std::ssize(kLengths);
    }
    m.noise_ratio = kNoiseRatios[choice];
    Eigen::MatrixXd r(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j <= i; ++j)
        r(i, j) = r(j, i) = covariance(x.row(i), x.row(j), m.lengths) + (i == j ? m.noise_ratio : 0.0);
    m.factor.compute(r);
    m.weights_1 = m.factor.solve(ones);
    m.sum_1 = ones.dot(m.weights_1);
    m.mean = m.weights_1.dot(y) / m.sum_1;
    m.weights_y = m.factor.solve(y - m.mean * ones);
    const double misfit = std::max((y - m.mean * ones).dot(m.weights_y), least);
    m.variance = misfit / std::max(freedom - 2, 1.0);  // that of Student's t
    log_weight = -m.factor.matrixLLT().diagonal().array().log().sum() - 0.5 * std::log(m.sum_1) -
                 0.5 * freedom * std::log(misfit);
    return m;
  };
  Eigen::Index choices = std::ssize(kNoiseRatios);
  for (Eigen::Index k = 0; k < d; ++k) choices *= std::ssize(kLengths);
  std::vector<double> log_weight(static_cast<std::size_t>(choices));
  for (Eigen::Index choice = 0; choice < choices; ++choice)
    member(choice, log_weight[static_cast<std::size_t>(choice)]);
  const double best = *std::max_element(log_weight.begin(), log_weight.end());
  double sum = 0;
  for (Eigen::Index choice = 0; choice < choices; ++choice) {  // only those that count are kept
    double& weight = log_weight[static_cast<std::size_t>(choice)];
    if (std::exp(weight - best) < kLeastWeight) continue;
    members_.push_back(member(choice, weight));
    sum += members_.back().weight = std::exp(weight - best);
  }
  for (Member& m : members_) m.weight /= sum;
}

Prediction Emulator::at(const Eigen::VectorXd& x) const {
  double mean = 0, square = 0, variance = 0, noise = 0;
  Eigen::VectorXd r(x_.rows());
  for (const Member& m : members_) {
    for (Eigen::Index i = 0; i < x_.rows(); ++i) r[i] = covariance(x, x_.row(i), m.lengths);
    const double value = m.mean + r.dot(m.weights_y), missing = 1 - r.dot(m.weights_1);
    const double share = 1 - r.dot(m.factor.solve(r)) + missing * missing / m.sum_1;
    mean += m.weight * value;
    square += m.weight * value * value;
    variance += m.weight * m.variance * std::max(share, 0.0);
    noise += m.weight * m.variance * m.noise_ratio;
  }
  return {mean, std::sqrt(variance + std::max(square - mean * mean, 0.0)), std::sqrt(noise)};
}

}  // namespace scree
