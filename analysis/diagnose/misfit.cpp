#include "analysis/diagnose/misfit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <stdexcept>

namespace scree {
namespace {

namespace bm = boost::math;

// Chi-square of `numbers` degrees of freedom that is as probable as this one over an uncertain scale.
double of_known_scale(double chi2, double numbers, double freedom) {
  if (std::isinf(freedom) || chi2 <= 0) return chi2;
  const double p = bm::cdf(bm::complement(bm::fisher_f(numbers, freedom), chi2 / numbers));
  if (p < std::numeric_limits<double>::min()) return std::numeric_limits<double>::infinity();
  return p < 1 ? bm::quantile(bm::complement(bm::chi_squared(numbers), p)) : 0.0;
}

}  // namespace

std::vector<ScatterBlock> blocks_among(const std::vector<ScatterBlock>& blocks,
                                       const std::vector<Eigen::Index>& which) {
  std::vector<ScatterBlock> among;
  for (const ScatterBlock& block : blocks) {
    ScatterBlock here{{}, block.freedom};
    for (std::size_t k = 0; k < which.size(); ++k)
      if (std::find(block.values.begin(), block.values.end(), which[k]) != block.values.end())
        here.values.push_back(static_cast<Eigen::Index>(k));
    if (!here.values.empty()) among.push_back(std::move(here));
  }
  return among;
}

Misfit misfit(const Eigen::VectorXd& difference, const Eigen::MatrixXd& covariance,
              const std::vector<ScatterBlock>& blocks) {
  std::vector<Eigen::Index> order;
  for (const ScatterBlock& block : blocks)
    order.insert(order.end(), block.values.begin(), block.values.end());
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt()(order);
  const Eigen::LLT<Eigen::MatrixXd> factor(Eigen::MatrixXd(
      scale.cwiseInverse().asDiagonal() * covariance(order, order) * scale.cwiseInverse().asDiagonal()));
  if (factor.info() != Eigen::Success || !(covariance.diagonal().minCoeff() > 0))
    throw std::runtime_error("the covariance of measurements and simulations is not positive definite");
  const Eigen::VectorXd white = factor.matrixL().solve(difference(order).cwiseQuotient(scale));
  Misfit all;
  Eigen::Index next = 0;
  for (const ScatterBlock& block : blocks) {
    const auto n = std::ssize(block.values);
    const double chi2 = white.segment(next, n).squaredNorm();
    next += n;
    all.chi2 += chi2;
    all.of_blocks.push_back(chi2);
    all.log_shape -= std::isinf(block.freedom)
                         ? 0.5 * chi2
                         : 0.5 * (block.freedom + static_cast<double>(n)) * std::log1p(chi2 / block.freedom);
  }
  if (std::isnan(all.chi2))
    throw std::runtime_error("a misfit is no number: the measurements' covariance, or what was simulated");
  all.log_density =
      all.log_shape - factor.matrixLLT().diagonal().array().log().sum() - scale.array().log().sum();
  return all;
}

Gap gap_of(const Misfit& misfit, const std::vector<ScatterBlock>& blocks, int fitted) {
  int numbers = 0;
  for (const ScatterBlock& block : blocks) numbers += static_cast<int>(block.values.size());
  const int freedom = std::max(numbers - fitted, 1);
  double sum = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    sum +=
        of_known_scale(misfit.of_blocks[b], static_cast<double>(blocks[b].values.size()) * freedom / numbers,
                       blocks[b].freedom);
  const double p = std::isinf(sum) ? 0 : sum > 0 ? bm::cdf(bm::complement(bm::chi_squared(freedom), sum)) : 1;
  return {misfit.chi2, freedom, p, numbers > fitted};
}

}  // namespace scree
