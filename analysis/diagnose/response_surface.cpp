#include "analysis/diagnose/response_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

namespace scree {
namespace {

// Prior standard deviations of coefficients, over the size of their group.
constexpr double kBase1 = 1, kBase2 = 0.5, kBase11 = 0.5, kBase3 = 0.3;
constexpr double kEffect1 = 1, kEffect2 = 0.6, kEffect3 = 0.4, kWithBase = 0.5, kWithOther = 0.5,
                 kWithOther2 = 0.3, kTogether = 0.5;
constexpr double kHat = 1;
constexpr int kHats = 5;           // along an amplitude, each a sixth of the range wide to either side
constexpr double kConstant = 1e4;  // of the scatter

// Sizes that a group may have, over the scatter; half a unit of a normal prior on their logarithm each way.
constexpr std::array<double, 11> kSizes{0.02, 0.1, 0.3, 0.7, 1.5, 3, 6, 15, 50, 200, 1000};
constexpr double kLogSizeMean = 0, kLogSizeStd = 2;
constexpr double kLogHatMean = -3, kLogHatStd = 1.5;  // hats are for what polynomials cannot do
constexpr int kMostSweeps = 6;

// 1 at the knot, 0 from its neighbours on; knots of negative amplitudes are negative.
double hat(double amplitude, int knot) {
  return std::max(0.0, 1 - std::abs((kHats + 1) * amplitude - knot));
}

double power(double x, int n) {
  double product = 1;
  for (int k = 0; k < n; ++k) product *= x;
  return product;
}

}  // namespace

int ResponseSurface::least_base_runs(std::size_t base_parameters) {
  const auto p = static_cast<int>(base_parameters);
  return 2 + 2 * p + p * (p - 1) / 2;
}

void ResponseSurface::make_terms(const ModelSpace& space, const std::vector<DesignRun>& runs) {
  const std::size_t p = space.base.size();
  const std::vector<int> none(p, 0);
  const auto base = [&](double prior, std::initializer_list<std::size_t> axes) {
    Term term{0, -1, prior, none};
    for (const std::size_t axis : axes) ++term.base_power[axis];
    terms_.push_back(std::move(term));
  };
  base(0, {});  // the constant; its prior is its own
  for (std::size_t i = 0; i < p; ++i) {
    base(kBase1, {i});
    base(kBase2, {i, i});
    base(kBase3, {i, i, i});
    for (std::size_t j = 0; j < i; ++j) base(kBase11, {i, j});
  }
  std::set<std::pair<int, int>> together;
  std::vector<bool> simulated(space.effects.size(), false);
  for (const DesignRun& run : runs)
    for (const EffectAt& a : run.at.effects) {
      simulated[a.effect] = true;
      for (const EffectAt& b : run.at.effects)
        if (a.effect < b.effect && acts_[a.effect] && acts_[b.effect])
          together.emplace(static_cast<int>(a.effect), static_cast<int>(b.effect));
    }
  for (std::size_t e = 0; e < space.effects.size(); ++e) {
    if (!acts_[e] || !simulated[e]) continue;
    const int effect = static_cast<int>(e), group = effect + 1;
    const auto add = [&](double prior, int order, int other) {
      terms_.push_back({group, -1, prior, none, effect, order, other});
    };
    add(kEffect1, 1, 0);
    add(kEffect2, 2, 0);
    add(kEffect3, 3, 0);
    for (int knot = -kHats; knot <= kHats; ++knot) {
      if (knot == 0 || (knot < 0 ? space.effects[e].lowest() >= 0 : space.effects[e].highest() <= 0))
        continue;
      add(kHat, 0, 0);
      terms_.back().hat = knot;
      terms_.back().group += static_cast<int>(space.effects.size());
    }
    for (std::size_t i = 0; i < p; ++i) {
      add(kWithBase, 1, 0);
      terms_.back().base_power[i] = 1;
    }
    for (std::size_t k = 1; k < space.effects[e].axes.size(); ++k) {
      add(kWithOther, 1, static_cast<int>(k));
      add(kWithOther2, 2, static_cast<int>(k));
    }
  }
  for (const auto& [a, b] : together) terms_.push_back({a + 1, b + 1, kTogether, none, a, 1, 0, b});
  known_pairs_.assign(together.begin(), together.end());
}

void ResponseSurface::values(const ModelPoint& point, std::vector<Eigen::Index>& which,
                             std::vector<double>& value) const {
  which.clear();
  value.clear();
  std::array<const EffectAt*, 64> there{};
  for (const EffectAt& effect : point.effects)
    if (acts_[effect.effect] && effect.amplitude() != 0) there[effect.effect] = &effect;
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    const Term& term = terms_[t];
    double product = 1;
    if (term.effect >= 0) {
      const EffectAt* effect = there[static_cast<std::size_t>(term.effect)];
      if (effect == nullptr) continue;
      product = term.hat != 0 ? hat(effect->amplitude(), term.hat) : power(effect->amplitude(), term.power);
      if (product == 0) continue;
      if (term.other > 0) product *= effect->at[term.other];
    }
    if (term.second >= 0) {
      const EffectAt* effect = there[static_cast<std::size_t>(term.second)];
      if (effect == nullptr) continue;
      product *= effect->amplitude();
    }
    for (std::size_t i = 0; i < term.base_power.size(); ++i)
      product *= power(point.base[static_cast<Eigen::Index>(i)], term.base_power[i]);
    which.push_back(static_cast<Eigen::Index>(t));
    value.push_back(product);
  }
}

ResponseSurface::Fit ResponseSurface::fit(const Eigen::MatrixXd& features, const Eigen::VectorXd& y) const {
  const Eigen::Index n = features.rows(), k = features.cols();
  const Eigen::MatrixXd square = features.transpose() * features;
  const Eigen::VectorXd product = features.transpose() * y;
  const double yy = y.squaredNorm();
  Eigen::VectorXd size = Eigen::VectorXd::Ones(groups_), prior(k);
  Eigen::LLT<Eigen::MatrixXd> factor;
  double misfit = 0;
  // Logarithm of the marginal likelihood with the scatter's variance at its best, times the prior of sizes.
  const auto evaluate = [&] {
    double log_density = 0;
    for (Eigen::Index t = 0; t < k; ++t) {
      const Term& term = terms_[static_cast<std::size_t>(t)];
      const double first = size[term.group];
      prior[t] = term.prior == 0         ? kConstant
                 : term.second_group < 0 ? term.prior * first
                                         : term.prior * std::sqrt(first * size[term.second_group]);
    }
    Eigen::MatrixXd a = square;
    a.diagonal() += prior.cwiseAbs2().cwiseInverse();
    factor.compute(a);
    misfit = std::max(yy - product.dot(factor.solve(product)), 1e-12 * yy + 1e-300);
    log_density -= prior.array().log().sum();
    log_density -= factor.matrixLLT().diagonal().array().log().sum();
    log_density -= 0.5 * static_cast<double>(n) * std::log(misfit);
    for (Eigen::Index g = 0; g < groups_; ++g) {
      const bool hats = g > static_cast<Eigen::Index>(acts_.size());
      const double z =
          (std::log(size[g]) - (hats ? kLogHatMean : kLogSizeMean)) / (hats ? kLogHatStd : kLogSizeStd);
      log_density -= 0.5 * z * z;
    }
    return log_density;
  };
  std::vector<bool> used(static_cast<std::size_t>(groups_), false);
  for (const Term& term : terms_) used[static_cast<std::size_t>(term.group)] = true;
  double best = evaluate();
  bool moved = true;
  for (int sweep = 0; sweep < kMostSweeps && moved; ++sweep) {
    moved = false;
    for (Eigen::Index g = 0; g < groups_; ++g) {
      if (!used[static_cast<std::size_t>(g)]) continue;
      const double before = size[g];
      double chosen = before;
      for (const double candidate : kSizes) {
        size[g] = candidate;
        const double here = evaluate();
        if (here > best + 1e-9) {
          best = here;
          chosen = candidate;
          moved = moved || candidate != before;
        }
      }
      size[g] = chosen;
    }
  }
  evaluate();
  Fit fit;
  fit.scatter = misfit / static_cast<double>(n);
  fit.mean = factor.solve(product);
  const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(k, k));
  fit.covariance = fit.scatter * inverse;
  fit.size = size;
  fit.residual = y - features * fit.mean;
  const Eigen::VectorXd leverage = (features * inverse).cwiseProduct(features).rowwise().sum();
  fit.freedom = std::max(static_cast<double>(n) - leverage.sum(), 1.0);
  double sum = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    sum += fit.residual[i] * fit.residual[i] / (fit.scatter * std::max(1 - leverage[i], 1e-6));
  fit.leave_one_out = std::sqrt(sum / static_cast<double>(n));
  return fit;
}

ResponseSurface::ResponseSurface(const ModelSpace& space, const std::string& experiment,
                                 const std::vector<DesignRun>& runs) {
  for (const CandidateEffect& effect : space.effects) acts_.push_back(effect.acts_in(experiment));
  if (acts_.size() > 64) throw std::invalid_argument("at most 64 effects");
  groups_ = 1 + 2 * static_cast<int>(space.effects.size());
  const auto n = static_cast<Eigen::Index>(runs.size());
  const auto plain =
      std::count_if(runs.begin(), runs.end(), [](const auto& r) { return r.at.effects.empty(); });
  if (plain < least_base_runs(space.base.size()))
    throw std::invalid_argument(
        fmt::format("{}: {} simulations of the base model gave its observables; {} are needed", experiment,
                    plain, least_base_runs(space.base.size())));
  make_terms(space, runs);
  const Eigen::Index p = runs.front().outputs.size(), k = static_cast<Eigen::Index>(terms_.size());
  Eigen::MatrixXd features = Eigen::MatrixXd::Zero(n, k), y(n, p);
  std::vector<Eigen::Index> which;
  std::vector<double> value;
  for (Eigen::Index i = 0; i < n; ++i) {
    const DesignRun& run = runs[static_cast<std::size_t>(i)];
    values(run.at, which, value);
    for (std::size_t t = 0; t < which.size(); ++t) features(i, which[t]) = value[t];
    y.row(i) = run.outputs.transpose();
  }
  centre_ = y.colwise().mean();
  const Eigen::MatrixXd off = y.rowwise() - centre_.transpose();
  Eigen::VectorXd unit = (off.colwise().squaredNorm() / static_cast<double>(n)).cwiseSqrt();
  for (Eigen::Index j = 0; j < p; ++j) unit[j] = unit[j] > 0 ? unit[j] : 1.0;

  // Correlation of the scatter, from each output on its own; drawn towards none as far as the data are few.
  Eigen::MatrixXd residual(n, p);
  Eigen::VectorXd freedom(p);
  for (Eigen::Index j = 0; j < p; ++j) {
    const Fit alone = fit(features, off.col(j) / unit[j]);
    residual.col(j) = alone.residual / std::sqrt(alone.freedom);
    freedom[j] = alone.freedom;
  }
  Eigen::MatrixXd covariance = residual.transpose() * residual;
  Eigen::VectorXd deviation = covariance.diagonal().cwiseMax(1e-24).cwiseSqrt();
  Eigen::MatrixXd correlation =
      deviation.cwiseInverse().asDiagonal() * covariance * deviation.cwiseInverse().asDiagonal();
  const double kept = freedom.mean() / (freedom.mean() + static_cast<double>(p));
  for (Eigen::Index i = 0; i < p; ++i)
    for (Eigen::Index j = 0; j < p; ++j) correlation(i, j) = i == j ? 1.0 : kept * correlation(i, j);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(correlation);
  const Eigen::VectorXd root = eigen.eigenvalues().cwiseMax(1e-6).cwiseSqrt();
  const Eigen::VectorXd natural = unit.cwiseProduct(deviation);
  to_outputs_ = natural.asDiagonal() * eigen.eigenvectors() * root.asDiagonal();
  const Eigen::MatrixXd back = root.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose() *
                               natural.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd combinations = off * back.transpose();
  Eigen::VectorXd variance(p);
  leave_one_out_.resize(p);
  for (Eigen::Index j = 0; j < p; ++j) {
    fits_.push_back(fit(features, combinations.col(j)));
    variance[j] = fits_.back().residual.squaredNorm() / fits_.back().freedom;
    fits_.back().covariance *= variance[j] / fits_.back().scatter;
    fits_.back().scatter = variance[j];
    leave_one_out_[j] = fits_.back().leave_one_out;
  }
  scatter_ = to_outputs_ * variance.asDiagonal() * to_outputs_.transpose();
}

// Of products of effects that were never simulated together.
double ResponseSurface::pair_variance(const ModelPoint& point, const Fit& fit) const {
  double variance = 0;
  for (const EffectAt& a : point.effects)
    for (const EffectAt& b : point.effects) {
      if (a.effect >= b.effect || !acts_[a.effect] || !acts_[b.effect]) continue;
      const std::pair<int, int> pair(static_cast<int>(a.effect), static_cast<int>(b.effect));
      if (std::find(known_pairs_.begin(), known_pairs_.end(), pair) != known_pairs_.end()) continue;
      const double product = kTogether * a.amplitude() * b.amplitude();
      variance += fit.scatter * product * product * fit.size[pair.first + 1] * fit.size[pair.second + 1];
    }
  return variance;
}

SurfacePrediction ResponseSurface::at(const ModelPoint& point) const {
  std::vector<Eigen::Index> which;
  std::vector<double> value;
  values(point, which, value);
  const Eigen::Index p = outputs();
  const std::size_t m = which.size();
  Eigen::VectorXd mean(p), variance(p);
  for (Eigen::Index j = 0; j < p; ++j) {
    const Fit& fit = fits_[static_cast<std::size_t>(j)];
    double sum = 0, square = 0;
    for (std::size_t s = 0; s < m; ++s) {
      sum += value[s] * fit.mean[which[s]];
      double row = 0;
      for (std::size_t t = 0; t < s; ++t) row += fit.covariance(which[t], which[s]) * value[t];
      square += value[s] * (2 * row + fit.covariance(which[s], which[s]) * value[s]);
    }
    mean[j] = sum;
    variance[j] = square + pair_variance(point, fit);
  }
  return {centre_ + to_outputs_ * mean, to_outputs_ * variance.asDiagonal() * to_outputs_.transpose()};
}

}  // namespace scree
