#include "analysis/diagnose/diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "analysis/diagnose/blocks.h"
#include "sim/material/in_parallel.h"

namespace scree {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Prior probabilities; the last three are shared by all of their kind.
constexpr double kPriorCalibration = 0.4, kPriorUnknown = 0.1, kPriorOne = 0.4, kPriorTwo = 0.1;
constexpr double kLogUnknownLow = 0,
                 kLogUnknownHigh = 8;   // of the variance of what is unknown, over the data's
constexpr std::uint64_t kSeed = 20177;  // of the integrals
constexpr double kWider = 1.5;          // spread of points to be learnt from, over that of what is open
constexpr double kWithin = 0.9;         // probability of the intervals
constexpr double kStep = 0.05;          // of a numerical derivative by a coordinate

// Base coordinates, then those of each effect's parameters.
ModelPoint point_of(const ModelSpace& space, const Hypothesis& h, const Eigen::VectorXd& x) {
  const auto p = static_cast<Eigen::Index>(space.base.size());
  ModelPoint point{x.head(p), {}};
  Eigen::Index next = p;
  for (const std::size_t e : h.effects) {
    const auto count = static_cast<Eigen::Index>(space.effects[e].axes.size());
    point.effects.push_back({e, x.segment(next, count)});
    next += count;
  }
  return point;
}

// Where the parameters of a hypothesis may lie.
ParameterBox box_of(const ModelSpace& space, const Hypothesis& h) {
  std::vector<double> low(space.base.size(), -1.0), high(space.base.size(), 1.0);
  for (const std::size_t e : h.effects) {
    const CandidateEffect& effect = space.effects[e];
    low.push_back(effect.lowest());
    high.push_back(effect.highest());
    for (std::size_t k = 1; k < effect.axes.size(); ++k) low.push_back(-1), high.push_back(1);
  }
  if (h.unknown) low.push_back(kLogUnknownLow), high.push_back(kLogUnknownHigh);
  const auto n = static_cast<Eigen::Index>(low.size());
  return {Eigen::Map<Eigen::VectorXd>(low.data(), n), Eigen::Map<Eigen::VectorXd>(high.data(), n)};
}

std::vector<Eigen::Index> everything(Eigen::Index n) {
  std::vector<Eigen::Index> all(static_cast<std::size_t>(n));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

// The likelihood of a hypothesis by its parameters, of some of the values.
class Likelihood {
 public:
  Likelihood(const ModelSpace& space, const LearntModel& model, const Measurements& measured,
             const Eigen::MatrixXd& covariance, const std::vector<ScatterBlock>& blocks,
             std::vector<Eigen::Index> which)
      : space_(space), model_(model), which_(std::move(which)), blocks_(blocks_among(blocks, which_)) {
    value_ = measured.vector()(which_);
    covariance_ = covariance(which_, which_);
  }

  ModelPoint point(const Hypothesis& h, const Eigen::VectorXd& x) const { return point_of(space_, h, x); }
  Misfit at(const Hypothesis& h, const Eigen::VectorXd& x) const {
    const SurfacePrediction all = model_.at(point(h, x));
    Eigen::MatrixXd covariance = covariance_ + all.covariance(which_, which_);
    if (h.unknown) covariance.diagonal() += std::exp(x[x.size() - 1]) * covariance_.diagonal();
    return misfit(value_ - all.mean(which_), covariance, blocks_);
  }
  Evidence evidence(const Hypothesis& h) const {
    return integrate([&](const Eigen::VectorXd& x) { return at(h, x).log_density; }, box_of(space_, h),
                     kSeed);
  }
  const std::vector<ScatterBlock>& blocks() const { return blocks_; }

 private:
  const ModelSpace& space_;
  const LearntModel& model_;
  std::vector<Eigen::Index> which_;
  std::vector<ScatterBlock> blocks_;
  Eigen::VectorXd value_;
  Eigen::MatrixXd covariance_;
};

Judgement judge(const ModelSpace& space, const Likelihood& likelihood, const Hypothesis& hypothesis) {
  Judgement j;
  j.hypothesis = hypothesis;
  j.evidence = likelihood.evidence(hypothesis);
  j.best = likelihood.point(hypothesis, j.evidence.most_likely);
  const int fitted = static_cast<int>(j.evidence.most_likely.size()) - (hypothesis.unknown ? 1 : 0);
  Hypothesis known = hypothesis;
  known.unknown = false;
  j.gap = gap_of(likelihood.at(known, j.evidence.most_likely), likelihood.blocks(), fitted);
  Eigen::Index next = 0;
  const auto interval = [&](auto&& value) {
    const Evidence::Range range = j.evidence.shortest(next, kWithin);
    Judgement::Interval i{value(range.low), value(j.evidence.quantile(next, 0.5)), value(range.high)};
    if (i.low > i.high) std::swap(i.low, i.high);
    ++next;
    return i;
  };
  for (const BaseAxis& axis : space.base) j.base.push_back(interval([&](double x) { return axis.value(x); }));
  for (const std::size_t e : hypothesis.effects) {
    j.effects.emplace_back();
    for (std::size_t k = 0; k < space.effects[e].axes.size(); ++k)
      j.effects.back().push_back(interval([&](double x) { return space.effects[e].value(k, x); }));
  }
  return j;
}

// Changes of the values in standard uncertainties, and without what the base parameters about a point can
// make up for (to first order).
class Compensation {
 public:
  Compensation(const LearntModel& model, const Eigen::MatrixXd& covariance, const Eigen::VectorXd& base)
      : scale_(covariance.diagonal().cwiseSqrt()),
        factor_(Eigen::MatrixXd(scale_.cwiseInverse().asDiagonal() * covariance *
                                scale_.cwiseInverse().asDiagonal())),
        slopes_(covariance.rows(), base.size()) {
    for (Eigen::Index k = 0; k < base.size(); ++k) {
      ModelPoint up{base, {}}, down = up;
      up.base[k] += kStep;
      down.base[k] -= kStep;
      slopes_.col(k) = whitened((model.at(up).mean - model.at(down).mean) / (2 * kStep));
    }
    made_up_for_.compute(slopes_);
  }
  /// Columns of changes.
  Eigen::MatrixXd left(const Eigen::MatrixXd& changes) const {
    const Eigen::MatrixXd white = whitened(changes);
    return white - slopes_ * made_up_for_.solve(white);
  }

 private:
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& x) const {
    return factor_.matrixL().solve(scale_.cwiseInverse().asDiagonal() * x);
  }
  Eigen::VectorXd scale_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::MatrixXd slopes_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> made_up_for_;
};

// What the effects do at a point, as the surfaces have it; `compensation`: about its base parameters.
Eigen::VectorXd signature(const LearntModel& model, const Compensation& compensation,
                          const ModelPoint& point) {
  return compensation.left(model.at(point).mean - model.at({point.base, {}}).mean);
}

double rms(const Eigen::VectorXd& x) {
  return x.size() > 0 ? x.norm() / std::sqrt(static_cast<double>(x.size())) : 0.0;
}

// Numbers, and parts of them, at the nominal parameters.
void find(const ModelSpace& space, const LearntModel& model, Diagnosis& d) {
  const SurfacePrediction here = model.at({space.nominal(), {}});
  const Eigen::VectorXd difference = d.measured.vector() - here.mean;
  const Eigen::MatrixXd covariance = d.covariance + here.covariance;
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt();
  const auto gap = [&](const std::vector<Eigen::Index>& which) {
    const std::vector<ScatterBlock> blocks = blocks_among(d.blocks, which);
    return gap_of(misfit(difference(which), covariance(which, which), blocks), blocks, 0);
  };
  d.nominal = gap(everything(difference.size()));
  std::map<std::string, std::vector<Eigen::Index>> parts;
  for (Eigen::Index k = 0; k < difference.size(); ++k) {
    const MeasuredValue& value = d.measured.values[static_cast<std::size_t>(k)];
    const double z = difference[k] / scale[k];
    d.numbers.push_back({value.label, difference[k], z, gap({k}), false});
    parts["experiment " + d.measured.experiments[value.experiment]].push_back(k);
    if (const std::string section = section_of_output(value.output); !section.empty())
      parts["section " + section].push_back(k);
    parts["quantity " + quantity_of_output(value.output)].push_back(k);
  }
  for (const auto& [name, which] : parts) d.parts.push_back({name, nan, nan, gap(which), false});
  const auto mark = [](std::vector<Disagreement>& all) {
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.gap.p < b.gap.p; });
    double harmonic = 0;
    for (std::size_t k = 1; k <= all.size(); ++k) harmonic += 1.0 / static_cast<double>(k);
    std::size_t last = 0;
    for (std::size_t k = 1; k <= all.size(); ++k)
      if (all[k - 1].gap.p <=
          kFalseDiscoveries * static_cast<double>(k) / (static_cast<double>(all.size()) * harmonic))
        last = k;
    for (std::size_t k = 0; k < last; ++k) all[k].significant = true;
  };
  mark(d.numbers);
  mark(d.parts);
  std::sort(d.numbers.begin(), d.numbers.end(),
            [](const auto& a, const auto& b) { return std::abs(a.z) > std::abs(b.z); });
}

void sort_by_probability(std::vector<Judgement>& judgements) {
  std::stable_sort(judgements.begin(), judgements.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
}

bool holds(const Hypothesis& larger, const Hypothesis& smaller) {
  return std::includes(larger.effects.begin(), larger.effects.end(), smaller.effects.begin(),
                       smaller.effects.end());
}

DiagnosisVerdict verdict_of(const Diagnosis& d) {
  using Kind = DiagnosisVerdict::Kind;
  if (d.nominal.p > kNothingAbove) return {Kind::nothing, {}};
  if (d.calibration.explains()) return {Kind::calibration, {}};
  const auto& all = d.judgements;
  std::size_t first = all.size();
  double unknown = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k].hypothesis.unknown) unknown = all[k].probability;
    if (first == all.size() && all[k].hypothesis.is_effect() && all[k].explains()) first = k;
  }
  // What re-calibration leaves may still be chance: anything else must be much more probable.
  const double leading = std::max(unknown, first < all.size() ? all[first].probability : 0);
  if (d.calibration.simulated == Judgement::Simulated::open && d.calibration.probability * kApartBy > leading)
    return {Kind::calibration, {}};
  if (first == all.size() || unknown > all[first].probability) return {Kind::unknown, {}};
  DiagnosisVerdict verdict{Kind::effect, {first}};
  for (std::size_t k = 0; k < all.size(); ++k)
    if (k != first && all[k].hypothesis.is_effect() && all[k].explains() &&
        !holds(all[k].hypothesis, all[first].hypothesis) &&
        all[k].probability * kApartBy > all[first].probability)
      verdict.named.push_back(k);
  if (verdict.named.size() > 1) verdict.kind = Kind::group;
  return verdict;
}

}  // namespace

LearntModel::LearntModel(const ModelSpace& space, const std::vector<std::string>& experiments,
                         const DesignRuns& runs, std::vector<Widening> widening, int threads)
    : widening_(std::move(widening)) {
  widening_.resize(experiments.size());
  for (std::size_t e = 0; e < experiments.size(); ++e)
    surfaces_.emplace_back(space, experiments[e], runs[e], threads);
}

SurfacePrediction LearntModel::at(const ModelPoint& point) const {
  std::vector<double> means;
  std::vector<Eigen::MatrixXd> covariances;
  for (std::size_t e = 0; e < surfaces_.size(); ++e) {
    const SurfacePrediction here = surfaces_[e].at(point);
    means.insert(means.end(), here.mean.begin(), here.mean.end());
    covariances.push_back(widening_[e].covariance * here.covariance);
  }
  return {Eigen::Map<Eigen::VectorXd>(means.data(), std::ssize(means)), block_diagonal(covariances)};
}

Eigen::MatrixXd LearntModel::scatter() const {
  std::vector<Eigen::MatrixXd> scatters;
  for (std::size_t e = 0; e < surfaces_.size(); ++e)
    scatters.push_back(widening_[e].scatter * surfaces_[e].scatter());
  return block_diagonal(scatters);
}

std::vector<const ResponseSurface*> LearntModel::surfaces() const {
  std::vector<const ResponseSurface*> all;
  for (const ResponseSurface& surface : surfaces_) all.push_back(&surface);
  return all;
}

std::vector<ModelPoint> where_to_learn(const ModelSpace& space, const Diagnosis& d, const LearntModel& model,
                                       const Hypothesis& hypothesis, int count,
                                       const std::vector<SimulatedPoints>& simulated) {
  const Likelihood likelihood(space, model, d.measured, d.covariance, d.blocks,
                              everything(static_cast<Eigen::Index>(d.measured.values.size())));
  // The density of amplitudes that are even along a root is one over it; near absence as it is there.
  const auto log_evenly = [&](const ModelPoint& at) {
    double sum = 0;
    for (const EffectAt& each : at.effects)
      if (const CandidateEffect& effect = space.effects[each.effect]; effect.one_sign())
        sum -= std::log(std::max(std::abs(effect.along(each.amplitude())), 0.1));
    return sum;
  };
  const Evidence evidence = integrate(
      [&](const Eigen::VectorXd& x) {
        return likelihood.at(hypothesis, x).log_shape / (kWider * kWider) +
               log_evenly(point_of(space, hypothesis, x));
      },
      box_of(space, hypothesis), kSeed);
  const auto nearest = [&](const ModelPoint& at, const std::vector<ModelPoint>& among) {
    double least = std::numeric_limits<double>::max();
    for (const ModelPoint& each : among) least = std::min(least, space.distance(at, each));
    return least;
  };
  Eigen::VectorXd weights = evidence.weights;
  for (Eigen::Index s = 0; s < weights.size(); ++s) {
    const ModelPoint at = point_of(space, hypothesis, evidence.samples.row(s));
    for (const SimulatedPoints& of_one : simulated)
      if (nearest(at, of_one.gave_nothing) < nearest(at, of_one.measured)) weights[s] = 0;
  }
  const double all = weights.sum();
  std::vector<ModelPoint> points;
  double sum = 0;
  for (Eigen::Index s = 0; s < weights.size() && all > 0; ++s) {  // systematic sampling by weight
    sum += weights[s] / all;
    while (static_cast<int>(points.size()) < count && sum * count > static_cast<double>(points.size()) + 0.5)
      points.push_back(point_of(space, hypothesis, evidence.samples.row(s)));
  }
  return points;
}

std::vector<std::pair<const Judgement*, int>> shared_by_rivals(const std::vector<const Judgement*>& among,
                                                               const Judgement& leading, int count) {
  double all = 0, sum = 0;
  for (const Judgement* j : among) all += std::sqrt(j->probability);
  std::vector<std::pair<const Judgement*, int>> shares;
  int given = 0;
  for (const Judgement* j : among) {
    if (j == &leading || !(j->probability > 0)) continue;
    sum += std::sqrt(j->probability) / all;
    const int share = static_cast<int>(sum * count + 0.5) - given;
    if (share > 0) shares.emplace_back(j, share);
    given += share;
  }
  return shares;
}

Diagnosis diagnose(const ModelSpace& space, const Measurements& measured, const LearntModel& model,
                   const Contradicted& contradicted, Pairs pairs_when, const Diagnosis* before, int threads) {
  Diagnosis d;
  d.measured = measured;
  const WorkingCovariance working = working_covariance(measured, model.surfaces());
  d.covariance = working.matrix;
  d.blocks = working.blocks;
  const Likelihood likelihood(space, model, measured, d.covariance, d.blocks,
                              everything(static_cast<Eigen::Index>(measured.values.size())));
  find(space, model, d);
  const auto judged = [&](const std::vector<Hypothesis>& hypotheses) {
    std::vector<Judgement> all(hypotheses.size());
    in_parallel(all.size(), threads, [&](std::size_t k) {
      const Hypothesis& h = hypotheses[k];
      if (before != nullptr)
        for (const Judgement& j : before->judgements)
          if (j.hypothesis.effects == h.effects && j.hypothesis.unknown == h.unknown) {
            all[k] = j;
            return;
          }
      all[k] = judge(space, likelihood, h);
    });
    return all;
  };
  const std::size_t count = space.effects.size();
  std::vector<Hypothesis> singles{{{}, false, kPriorCalibration}, {{}, true, kPriorUnknown}};
  for (std::size_t e = 0; e < count; ++e)
    singles.push_back({{e}, false, kPriorOne / static_cast<double>(count)});
  std::vector<Judgement> ones = judged(singles);
  d.calibration = ones[0];
  const Judgement unknown = ones[1];
  ones.erase(ones.begin(), ones.begin() + 2);
  const auto weight = [](const Judgement& j) {
    return std::log(j.hypothesis.prior) + j.evidence.log_evidence;
  };
  // Two effects are for what none explains alone, or none better than something unknown does.
  const bool one_explains = std::any_of(ones.begin(), ones.end(), [&](const Judgement& j) {
    return j.gap.p > kNothingAbove && !contradicted.contains(j.hypothesis.effects) &&
           weight(j) > weight(unknown);
  });
  const bool calibration_explains = d.calibration.gap.p > kFitsAbove && !contradicted.contains({});
  if (pairs_when == Pairs::always || (!calibration_explains && !one_explains)) {
    // Those that exclude each other take their part of the prior with them.
    const double all_pairs = 0.5 * static_cast<double>(count) * (static_cast<double>(count) - 1);
    std::vector<Hypothesis> pairs;
    for (std::size_t b = 0; b < count; ++b)
      for (std::size_t a = 0; a < b; ++a)
        if (space.effects[a].goes_with(space.effects[b]))
          pairs.push_back({{a, b}, false, kPriorTwo / all_pairs});
    d.judgements = judged(pairs);
  }
  d.judgements.insert(d.judgements.end(), ones.begin(), ones.end());
  d.judgements.push_back(d.calibration);
  d.judgements.push_back(unknown);

  double most = -std::numeric_limits<double>::infinity(), sum = 0;
  for (const Judgement& j : d.judgements) most = std::max(most, weight(j));
  for (const Judgement& j : d.judgements) sum += std::exp(weight(j) - most);
  for (Judgement& j : d.judgements) {
    j.probability = std::exp(weight(j) - most) / sum;
    j.signature = rms(signature(model, Compensation(model, d.covariance, j.best.base), j.best));
    if (j.hypothesis.effects.empty() && !j.hypothesis.unknown) d.calibration.probability = j.probability;
  }
  sort_by_probability(d.judgements);

  std::vector<Eigen::VectorXd> signatures;
  const Compensation about_calibration(model, d.covariance, d.calibration.best.base);
  for (const Judgement& one : ones) {
    Eigen::VectorXd s = signature(model, about_calibration, {d.calibration.best.base, one.best.effects});
    signatures.push_back(s.norm() > 0 ? Eigen::VectorXd(s.normalized()) : s);
  }
  const auto n = static_cast<Eigen::Index>(count);
  d.cosine = Eigen::MatrixXd::Constant(n, n, nan);
  for (Eigen::Index a = 0; a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b) {
      const auto &first = signatures[static_cast<std::size_t>(a)],
                 &second = signatures[static_cast<std::size_t>(b)];
      if (first.norm() > 0 && second.norm() > 0) d.cosine(a, b) = first.dot(second);
    }
  d.verdict = verdict_of(d);
  return d;
}

void refute(Diagnosis& d, std::size_t judgement, const std::optional<Gap>& gap) {
  Judgement& refuted = d.judgements[judgement];
  if (gap) refuted.gap = *gap;
  refuted.simulated = gap ? Judgement::Simulated::refuted : Judgement::Simulated::failed;
  refuted.probability = 0;
  double rest = 0;  // summed: one minus what is nearly one has lost its digits
  for (const Judgement& j : d.judgements) rest += j.probability;
  for (Judgement& j : d.judgements) {
    if (rest > 0) j.probability /= rest;
    if (j.hypothesis.effects.empty() && !j.hypothesis.unknown) d.calibration = j;
  }
  sort_by_probability(d.judgements);
  d.verdict = verdict_of(d);
}

HeldOut held_out(const ModelSpace& space, const Diagnosis& d, const LearntModel& model,
                 const Hypothesis& hypothesis) {
  const auto n = static_cast<Eigen::Index>(d.measured.values.size());
  std::map<std::string, std::vector<Eigen::Index>> parts;
  for (Eigen::Index k = 0; k < n; ++k) {
    const MeasuredValue& value = d.measured.values[static_cast<std::size_t>(k)];
    if (d.measured.experiments.size() > 1)
      parts["experiment " + d.measured.experiments[value.experiment]].push_back(k);
    else if (const std::string section = section_of_output(value.output); !section.empty())
      parts["section " + section].push_back(k);
    else
      parts[value.label].push_back(k);
  }
  HeldOut result;
  const Eigen::VectorXd values = d.measured.vector();
  for (const auto& [name, which] : parts) {
    std::vector<Eigen::Index> rest;
    for (Eigen::Index k = 0; k < n; ++k)
      if (std::find(which.begin(), which.end(), k) == which.end()) rest.push_back(k);
    if (rest.empty()) continue;
    const Likelihood likelihood(space, model, d.measured, d.covariance, d.blocks, rest);
    const Evidence evidence = likelihood.evidence(hypothesis);
    // Mean and covariance over the posterior of the rest.
    const auto m = static_cast<Eigen::Index>(which.size());
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(m);
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(m, m), within = square;
    for (Eigen::Index s = 0; s < evidence.samples.rows(); ++s) {
      const double w = evidence.weights[s];
      if (w < 1e-6) continue;
      const SurfacePrediction here = model.at(likelihood.point(hypothesis, evidence.samples.row(s)));
      const Eigen::VectorXd at = here.mean(which);
      mean += w * at;
      square += w * at * at.transpose();
      within += w * here.covariance(which, which);
    }
    const Eigen::MatrixXd covariance = d.covariance(which, which) + within + square - mean * mean.transpose();
    const std::vector<ScatterBlock> blocks = blocks_among(d.blocks, which);
    const Misfit here = misfit(values(which) - mean, covariance, blocks);
    result.parts.push_back(name);
    result.gaps.push_back(gap_of(here, blocks, 0));
    result.chi2 += here.chi2;
    result.count += static_cast<int>(m);
  }
  return result;
}

Gap simulated_gap(const Diagnosis& d, const LearntModel& model, const Eigen::VectorXd& mean, int runs) {
  const Eigen::MatrixXd covariance = d.covariance + model.scatter() / runs;
  return gap_of(misfit(d.measured.vector() - mean, covariance, d.blocks), d.blocks, 0);
}

double detectability(const LearntModel& model, const Eigen::MatrixXd& covariance, const Eigen::VectorXd& base,
                     const Eigen::VectorXd& change, const Eigen::MatrixXd& covariance_of_change) {
  const Compensation compensation(model, covariance, base);
  const double unknown = compensation.left(compensation.left(covariance_of_change).transpose()).trace();
  const double square = compensation.left(change).squaredNorm() - unknown;
  return std::sqrt(std::max(square, 0.0) / static_cast<double>(change.size()));
}

}  // namespace scree
