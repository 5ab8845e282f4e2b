#include "analysis/diagnose/response_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include "sim/material/in_parallel.h"

namespace scree {
namespace {

// Prior standard deviations of coefficients, over the size of their group.
constexpr double kBase1 = 1, kBase2 = 0.5, kBase11 = 0.5, kBase3 = 0.3;
constexpr double kEffect1 = 1, kEffect2 = 0.6, kEffect3 = 0.4, kWithBase = 0.5, kWithBase2 = 0.5,
                 kWithOther = 0.5, kWithOther2 = 0.3;
constexpr double kTogether = 0.5, kTogether2 = 0.3, kTogetherWithBase = 0.3, kTogetherHat = 0.3;
constexpr double kHat = 1, kHatWithBase = 0.5, kHatWithBase2 = 0.3;
constexpr int kHats = 8;           // along an amplitude, each an eighth of the range wide to either side
constexpr double kConstant = 1e4;  // of the scatter

// Sizes that a group may have, over the scatter; normal prior on their logarithm. Of the product of two
// effects its mean is that of theirs.
constexpr std::array<double, 11> kSizes{0.02, 0.1, 0.3, 0.7, 1.5, 3, 6, 15, 50, 200, 1000};
constexpr double kLogSizeMean = 0, kLogSizeStd = 2;
constexpr double kLogHatMean = -1, kLogHatStd = 1.5;  // hats are for what polynomials cannot do
constexpr int kMostSweeps = 6;
constexpr double kTiny = 1e-12;  // against rounding: of what is above 0 by its nature

// Correlation of the scatter of two readings of one pile. They differ by what an effect on measurement does
// to this pile and not to others of its kind.
constexpr double kSamePile = 0.9;

// Turns rows that are correlated as readings of the same piles are into uncorrelated ones.
class Whitening {
 public:
  explicit Whitening(const std::vector<DesignRun>& runs) {
    const auto n = static_cast<Eigen::Index>(runs.size());
    Eigen::MatrixXd correlation = Eigen::MatrixXd::Identity(n, n);
    first_ = Eigen::VectorXd::Ones(n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < i; ++j) {
        const std::string& pile = runs[static_cast<std::size_t>(i)].pile;
        if (!pile.empty() && pile == runs[static_cast<std::size_t>(j)].pile)
          correlation(i, j) = correlation(j, i) = kSamePile, first_[i] = 0;
      }
    factor_.compute(correlation);
  }
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& rows) const { return factor_.matrixL().solve(rows); }
  /// 1 of the first reading of a pile, which stays as it is; 0 of further ones, of which there is left what
  /// they add to those before.
  const Eigen::VectorXd& first() const { return first_; }

 private:
  Eigen::VectorXd first_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

// 1 at the knot, 0 from its neighbours on; knots of negative amplitudes are negative.
double hat(double along, int knot) {
  return std::max(0.0, 1 - std::abs(kHats * along - knot));
}

std::vector<int> knots(const CandidateEffect& effect) {
  std::vector<int> all;
  for (int knot = -kHats; knot <= kHats; ++knot)
    if (knot < 0 ? effect.lowest() < 0 : knot > 0 && effect.highest() > 0) all.push_back(knot);
  return all;
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
  const std::size_t p = base_axes_ = space.base.size();
  const std::vector<int> none(p, 0);
  const auto base = [&](double prior, std::initializer_list<std::size_t> axes) {
    Term term{0, prior, none};
    for (const std::size_t axis : axes) ++term.base_power[axis];
    terms_.push_back(std::move(term));
  };
  base(kConstant, {});
  terms_.back().group = -1;
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
    first_of_effect_.push_back(terms_.size());
    if (!acts_[e] || !simulated[e]) continue;
    const int effect = static_cast<int>(e), group = effect + 1;
    const auto add = [&](double prior, int order, int other) {
      terms_.push_back({group, prior, none, effect, order, other});
    };
    add(kEffect1, 1, 0);
    add(kEffect2, 2, 0);
    add(kEffect3, 3, 0);
    for (std::size_t i = 0; i < p; ++i) {
      add(kWithBase, 1, 0);
      terms_.back().base_power[i] = 1;
      add(kWithBase2, 2, 0);
      terms_.back().base_power[i] = 1;
    }
    for (std::size_t k = 1; k < space.effects[e].axes.size(); ++k) {
      add(kWithOther, 1, static_cast<int>(k));
      add(kWithOther2, 2, static_cast<int>(k));
    }
    for (const int knot : knots(space.effects[e])) {  // what belongs to one knot stands together
      const auto add_hat = [&](double prior) -> Term& {
        terms_.push_back({group + static_cast<int>(space.effects.size()), prior, none, effect});
        terms_.back().hat = knot;
        return terms_.back();
      };
      add_hat(kHat);
      for (std::size_t i = 0; i < p; ++i) {
        add_hat(kHatWithBase).base_power[i] = 1;
        add_hat(kHatWithBase2).base_power[i] = 2;
      }
    }
  }
  groups_ = 1 + 2 * static_cast<int>(space.effects.size());
  first_of_pairs_ = terms_.size();
  for (const auto& [a, b] : together) {
    first_of_pair_.push_back(terms_.size());
    const std::vector<Term> pair = terms_of_pair(a, b, groups_++);
    terms_.insert(terms_.end(), pair.begin(), pair.end());
  }
  known_pairs_.assign(together.begin(), together.end());
  for (int b = 0; b < std::ssize(effects_); ++b)
    for (int a = 0; a < b; ++a)
      if (acts_[static_cast<std::size_t>(a)] && acts_[static_cast<std::size_t>(b)] &&
          !together.contains({a, b}))
        unknown_pairs_.emplace(std::pair(a, b), terms_of_pair(a, b, -1));
}

std::vector<ResponseSurface::Term> ResponseSurface::terms_of_pair(int effect, int second, int group) const {
  std::vector<Term> terms;
  const auto add = [&](double prior, int order, int order_of_second) -> Term& {
    Term term{group, prior, std::vector<int>(base_axes_, 0), effect, order};
    term.second = second;
    term.second_power = order_of_second;
    return terms.emplace_back(std::move(term));
  };
  add(kTogether, 1, 1);
  add(kTogether2, 2, 1);
  add(kTogether2, 1, 2);
  for (std::size_t i = 0; i < base_axes_; ++i) add(kTogetherWithBase, 1, 1).base_power[i] = 1;
  for (const int knot : knots(effects_[static_cast<std::size_t>(effect)])) add(kTogetherHat, 0, 1).hat = knot;
  for (const int knot : knots(effects_[static_cast<std::size_t>(second)]))
    add(kTogetherHat, 1, 0).second_hat = knot;
  return terms;
}

ResponseSurface::PresentEffect ResponseSurface::present(const EffectAt& effect) const {
  return {&effect, effects_[effect.effect].along(effect.amplitude())};
}

double ResponseSurface::value_of(const Term& term, const Eigen::VectorXd& base, const PresentEffect& effect,
                                 const PresentEffect& second) {
  double product = 1;
  if (term.effect >= 0)
    product = term.hat != 0 ? hat(effect.along, term.hat) : power(effect.along, term.power);
  if (term.other > 0) product *= effect.effect->at[term.other];
  if (term.second >= 0)
    product *=
        term.second_hat != 0 ? hat(second.along, term.second_hat) : power(second.along, term.second_power);
  if (product == 0) return 0;
  for (std::size_t i = 0; i < term.base_power.size(); ++i)
    product *= power(base[static_cast<Eigen::Index>(i)], term.base_power[i]);
  return product;
}

ResponseSurface::Values ResponseSurface::values(const ModelPoint& point) const {
  Values all;
  std::array<PresentEffect, 64> there{};
  for (const EffectAt& effect : point.effects)
    if (acts_[effect.effect] && effect.amplitude() != 0) there[effect.effect] = present(effect);
  const PresentEffect absent;
  const auto of = [&](int effect) -> const PresentEffect& {
    return effect < 0 ? absent : there[static_cast<std::size_t>(effect)];
  };
  const auto add = [&](std::size_t t) {
    const Term& term = terms_[t];
    const PresentEffect &effect = of(term.effect), &second = of(term.second);
    const double product = value_of(term, point.base, effect, second);
    if (product == 0) return;
    const auto here = static_cast<Eigen::Index>(t);
    if (all.which.empty() || all.which.back() != here - 1)
      all.stretches.push_back({here, std::ssize(all.which), 0});
    ++all.stretches.back().count;
    all.which.push_back(here);
    all.value.push_back(product);
  };
  const std::size_t first = first_of_effect_.empty() ? first_of_pairs_ : first_of_effect_.front();
  for (std::size_t t = 0; t < first; ++t) add(t);
  for (std::size_t e = 0; e < first_of_effect_.size(); ++e) {
    if (there[e].effect == nullptr) continue;
    const std::size_t end = e + 1 < first_of_effect_.size() ? first_of_effect_[e + 1] : first_of_pairs_;
    for (std::size_t t = first_of_effect_[e]; t < end; ++t) add(t);
  }
  for (std::size_t k = 0; k < known_pairs_.size(); ++k) {
    const auto& [a, b] = known_pairs_[k];
    if (of(a).effect == nullptr || of(b).effect == nullptr) continue;
    const std::size_t end = k + 1 < first_of_pair_.size() ? first_of_pair_[k + 1] : terms_.size();
    for (std::size_t t = first_of_pair_[k]; t < end; ++t) add(t);
  }
  return all;
}

// The size of one group after the other is put to its best. With V the group's terms at the runs times their
// priors and Q the inverse of the runs' covariance, a change d of the size's square changes that covariance
// by d V V': its determinant by the product of 1 + d l over the eigenvalues l of V' Q V, and what the
// likelihood has of y the same way.
ResponseSurface::Fit ResponseSurface::fit(const Features& features, const Eigen::VectorXd& y,
                                          bool whole) const {
  const Eigen::Index n = features.all.rows(), k = features.all.cols();
  Eigen::VectorXd size = Eigen::VectorXd::Ones(groups_);
  const auto factor = [&] {
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index t = 0; t < k; ++t)
      if (terms_[static_cast<std::size_t>(t)].group < 0)
        covariance.selfadjointView<Eigen::Lower>().rankUpdate(features.all.col(t), kConstant * kConstant);
    for (Eigen::Index g = 0; g < groups_; ++g) {
      const Group& group = features.groups[static_cast<std::size_t>(g)];
      if (group.terms.empty()) continue;
      covariance(group.runs, group.runs) += size[g] * size[g] * group.at_runs * group.at_runs.transpose();
    }
    return Eigen::LLT<Eigen::MatrixXd>(covariance);
  };
  const double least = kTiny * y.squaredNorm() + 1e-300;
  bool moved = true;
  for (int sweep = 0; sweep < kMostSweeps && moved; ++sweep) {
    moved = false;
    Eigen::MatrixXd q = factor().solve(Eigen::MatrixXd::Identity(n, n));
    Eigen::VectorXd qy = q * y;
    double misfit = y.dot(qy);
    for (Eigen::Index g = 0; g < groups_; ++g) {
      const Group& group = features.groups[static_cast<std::size_t>(g)];
      if (group.terms.empty()) continue;
      const Eigen::MatrixXd& v = group.at_runs;
      Eigen::MatrixXd qv = q(Eigen::all, group.runs) * v;
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(v.transpose() * qv(group.runs, Eigen::all));
      const Eigen::ArrayXd roots = eigen.eigenvalues().cwiseMax(0.0),
                           along =
                               (eigen.eigenvectors().transpose() * (v.transpose() * qy(group.runs))).array();
      const auto shrunk = [&](double change) -> Eigen::ArrayXd {
        return change / (1 + change * roots).max(kTiny);
      };
      const auto misfit_at = [&](double change) {
        return std::max(misfit - (shrunk(change) * along.square()).sum(), least);
      };
      const double before = size[g];
      const Eigen::Index effects = static_cast<Eigen::Index>(acts_.size()), pair = g - 1 - 2 * effects;
      const bool hats = pair < 0 && g > effects;
      double usual = hats ? kLogHatMean : kLogSizeMean;
      if (pair >= 0) {
        const auto& [a, b] = known_pairs_[static_cast<std::size_t>(pair)];
        usual = 0.5 * std::log(size_of(size, a) * size_of(size, b));
      }
      const double spread = hats ? kLogHatStd : kLogSizeStd;
      // Logarithm of the marginal likelihood with the scatter's variance at its best, times the size's prior.
      const auto log_density = [&](double here) {
        const double change = here * here - before * before, z = (std::log(here) - usual) / spread;
        return -0.5 * ((1 + change * roots).max(kTiny).log().sum() +
                       static_cast<double>(n) * std::log(misfit_at(change)) + z * z);
      };
      double best = log_density(before), chosen = before;
      for (const double candidate : kSizes)
        if (const double here = log_density(candidate); here > best + 1e-9) {
          best = here;
          chosen = candidate;
        }
      if (chosen == before) continue;
      moved = true;
      size[g] = chosen;
      const double change = chosen * chosen - before * before;
      misfit = misfit_at(change);
      qv = (qv * eigen.eigenvectors()).eval();
      const Eigen::MatrixXd lost = qv * shrunk(change).matrix().asDiagonal();
      q.noalias() -= lost * qv.transpose();
      qy.noalias() -= lost * along.matrix();
    }
  }
  // With C the runs' covariance, F the terms there and P the coefficients' prior: mean P F' C^-1 y,
  // covariance P - P F' C^-1 F P; what a run weighs in its own prediction is 1 - (C^-1)_ii. All over the
  // scatter.
  const Eigen::LLT<Eigen::MatrixXd> last = factor();
  const Eigen::MatrixXd root = last.matrixL().solve(Eigen::MatrixXd::Identity(n, n));  // C^-1 = root' root
  Fit fit;
  fit.scatter = std::max(y.dot(last.solve(y)), least) / static_cast<double>(n);
  const Eigen::VectorXd own = root.colwise().squaredNorm().transpose();
  fit.residual = last.solve(y);  // F times the mean is y - C^-1 y
  double sum = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    sum += fit.residual[i] * fit.residual[i] / (fit.scatter * std::max(own[i], 1e-6));
  fit.leave_one_out = std::sqrt(sum / static_cast<double>(n));
  fit.freedom = std::max(features.counts.dot(own), 1.0);
  fit.size = size;
  if (whole) {
    Eigen::VectorXd prior(k);
    for (Eigen::Index t = 0; t < k; ++t)
      if (terms_[static_cast<std::size_t>(t)].group < 0) prior[t] = kConstant;
    for (Eigen::Index g = 0; g < groups_; ++g) {
      const Group& group = features.groups[static_cast<std::size_t>(g)];
      prior(group.terms) = size[g] * group.prior;
    }
    const Eigen::MatrixXd with_runs =
        root.triangularView<Eigen::Lower>() * (features.all * prior.cwiseAbs2().asDiagonal());
    fit.mean = with_runs.transpose() * last.matrixL().solve(y);
    fit.covariance = Eigen::MatrixXd::Zero(k, k);
    fit.covariance.diagonal() = prior.cwiseAbs2();
    fit.covariance.selfadjointView<Eigen::Lower>().rankUpdate(with_runs.transpose(), -1.0);
    fit.covariance.triangularView<Eigen::StrictlyUpper>() = fit.covariance.transpose();
    fit.covariance *= fit.scatter;
  }
  fit.residual = fit.residual.cwiseProduct(features.counts);
  return fit;
}

ResponseSurface::ResponseSurface(const ModelSpace& space, const std::string& experiment,
                                 const std::vector<DesignRun>& runs, int threads) {
  effects_ = space.effects;
  for (const CandidateEffect& effect : effects_) acts_.push_back(effect.acts_in(experiment));
  if (acts_.size() > 64) throw std::invalid_argument("at most 64 effects");
  const auto n = static_cast<Eigen::Index>(runs.size());
  const auto plain =
      std::count_if(runs.begin(), runs.end(), [](const auto& r) { return r.at.effects.empty(); });
  if (plain < least_base_runs(space.base.size()))
    throw std::invalid_argument(
        fmt::format("{}: {} simulations of the base model gave its observables; {} are needed", experiment,
                    plain, least_base_runs(space.base.size())));
  make_terms(space, runs);
  const Eigen::Index p = runs.front().outputs.size(), k = static_cast<Eigen::Index>(terms_.size());
  Features features{Eigen::MatrixXd::Zero(n, k), {}, {}};
  Eigen::MatrixXd y(n, p);
  for (Eigen::Index i = 0; i < n; ++i) {
    const DesignRun& run = runs[static_cast<std::size_t>(i)];
    const Values here = values(run.at);
    for (std::size_t t = 0; t < here.which.size(); ++t) features.all(i, here.which[t]) = here.value[t];
    y.row(i) = run.outputs.transpose();
  }
  const Whitening white(runs);
  features.all = white(features.all);
  features.counts = white.first();
  for (int g = 0; g < groups_; ++g) {
    std::vector<double> prior;
    Group group;
    for (Eigen::Index t = 0; t < k; ++t)
      if (const Term& term = terms_[static_cast<std::size_t>(t)]; term.group == g) {
        group.terms.push_back(t);
        prior.push_back(term.prior);
      }
    group.prior = Eigen::Map<Eigen::VectorXd>(prior.data(), static_cast<Eigen::Index>(prior.size()));
    for (Eigen::Index i = 0; i < n; ++i)
      if ((features.all(i, group.terms).array() != 0).any()) group.runs.push_back(i);
    group.at_runs = features.all(group.runs, group.terms) * group.prior.asDiagonal();
    features.groups.push_back(std::move(group));
  }
  centre_ = y.colwise().mean();
  const Eigen::MatrixXd about = y.rowwise() - centre_.transpose(), off = white(about);
  Eigen::VectorXd unit = (about.colwise().squaredNorm() / static_cast<double>(n)).cwiseSqrt();
  for (Eigen::Index j = 0; j < p; ++j) unit[j] = unit[j] > 0 ? unit[j] : 1.0;

  // Correlation of the scatter, from each output on its own; drawn towards none as far as the data are few.
  Eigen::MatrixXd residual(n, p);
  Eigen::VectorXd freedom(p);
  in_parallel(static_cast<std::size_t>(p), threads, [&](std::size_t output) {
    const auto j = static_cast<Eigen::Index>(output);
    const Fit alone = fit(features, off.col(j) / unit[j], false);
    residual.col(j) = alone.residual / std::sqrt(alone.freedom);
    freedom[j] = alone.freedom;
  });
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
  to_combinations_ = root.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose() *
                     natural.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd combinations = off * to_combinations_.transpose();
  Eigen::VectorXd variance(p);
  leave_one_out_.resize(p);
  fits_.resize(static_cast<std::size_t>(p));
  in_parallel(fits_.size(), threads, [&](std::size_t combination) {
    const auto j = static_cast<Eigen::Index>(combination);
    Fit& here = fits_[combination];
    here = fit(features, combinations.col(j), true);
    variance[j] = here.residual.squaredNorm() / here.freedom;
    here.covariance *= variance[j] / here.scatter;
    here.scatter = variance[j];
    leave_one_out_[j] = here.leave_one_out;
  });
  scatter_ = to_outputs_ * variance.asDiagonal() * to_outputs_.transpose();
}

double ResponseSurface::size_of(const Eigen::VectorXd& size, int effect) const {
  return std::hypot(size[effect + 1], size[effect + 1 + std::ssize(acts_)]);
}

std::vector<ResponseSurface::Product> ResponseSurface::unknown_products(const ModelPoint& point) const {
  std::vector<Product> all;
  for (const EffectAt& a : point.effects)
    for (const EffectAt& b : point.effects) {
      const std::pair<int, int> pair(static_cast<int>(a.effect), static_cast<int>(b.effect));
      const auto terms = unknown_pairs_.find(pair);
      if (terms == unknown_pairs_.end()) continue;
      const PresentEffect first = present(a), second = present(b);
      Product product{pair, {}};
      for (const Term& term : terms->second)
        product.values.push_back(term.prior * value_of(term, point.base, first, second));
      all.push_back(std::move(product));
    }
  return all;
}

double ResponseSurface::pair_covariance(const std::vector<Product>& first, const std::vector<Product>& second,
                                        const Fit& fit) const {
  double sum = 0;
  for (const Product& one : first)
    for (const Product& other : second)
      if (one.pair == other.pair)
        sum += std::inner_product(one.values.begin(), one.values.end(), other.values.begin(), 0.0) *
               size_of(fit.size, one.pair.first) * size_of(fit.size, one.pair.second);
  return sum;
}

SurfacePrediction ResponseSurface::at(const ModelPoint& point) const {
  using Segment = Eigen::Map<const Eigen::VectorXd>;
  const Values here = values(point);
  const Segment value(here.value.data(), std::ssize(here.value));
  const std::vector<Product> unknown = unknown_products(point);
  const Eigen::Index p = outputs();
  Eigen::VectorXd mean(p), variance(p);
  for (Eigen::Index j = 0; j < p; ++j) {
    const Fit& fit = fits_[static_cast<std::size_t>(j)];
    const Eigen::Index rows = fit.covariance.rows();
    double sum = 0, square = 0;
    for (auto a = here.stretches.begin(); a != here.stretches.end(); ++a)
      for (Eigen::Index i = 0; i < a->count; ++i) {
        // The covariance is symmetric: a column as far as its diagonal.
        const double* column = fit.covariance.data() + (a->term + i) * rows;
        double before = column[a->term + i] * value[a->at + i] * 0.5;
        for (auto b = here.stretches.begin(); b != a; ++b)
          before += Segment(column + b->term, b->count).dot(Segment(value.data() + b->at, b->count));
        before += Segment(column + a->term, i).dot(Segment(value.data() + a->at, i));
        square += 2 * value[a->at + i] * before;
        sum += value[a->at + i] * fit.mean[a->term + i];
      }
    mean[j] = sum;
    variance[j] = square + fit.scatter * pair_covariance(unknown, unknown, fit);
  }
  return {centre_ + to_outputs_ * mean, to_outputs_ * variance.asDiagonal() * to_outputs_.transpose()};
}

std::vector<Forecast> ResponseSurface::forecasts(const std::vector<DesignRun>& runs) const {
  if (runs.empty()) return {};
  const auto n = static_cast<Eigen::Index>(runs.size());
  Eigen::MatrixXd features = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(terms_.size()));
  Eigen::MatrixXd found(n, outputs());
  for (Eigen::Index i = 0; i < n; ++i) {
    const DesignRun& run = runs[static_cast<std::size_t>(i)];
    const Values here = values(run.at);
    for (std::size_t t = 0; t < here.which.size(); ++t) features(i, here.which[t]) = here.value[t];
    found.row(i) = (to_combinations_ * (run.outputs - centre_)).transpose();
  }
  std::vector<std::vector<Product>> unknown;
  for (const DesignRun& run : runs) unknown.push_back(unknown_products(run.at));
  std::vector<Forecast> all;
  for (std::size_t j = 0; j < fits_.size(); ++j) {
    const Fit& fit = fits_[j];
    Eigen::MatrixXd unsure = features * fit.covariance * features.transpose() / fit.scatter;
    for (Eigen::Index a = 0; a < n; ++a)
      for (Eigen::Index b = 0; b < n; ++b)
        unsure(a, b) +=
            pair_covariance(unknown[static_cast<std::size_t>(a)], unknown[static_cast<std::size_t>(b)], fit);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unsure);
    const Eigen::VectorXd error = eigen.eigenvectors().transpose() *
                                  (found.col(static_cast<Eigen::Index>(j)) - features * fit.mean) /
                                  std::sqrt(fit.scatter);
    for (Eigen::Index i = 0; i < n; ++i)
      all.push_back({std::max(eigen.eigenvalues()[i], 0.0), error[i] * error[i]});
  }
  return all;
}

}  // namespace scree
