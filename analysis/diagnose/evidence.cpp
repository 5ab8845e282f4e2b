#include "analysis/diagnose/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "sim/material/random.h"

namespace scree {
namespace {

constexpr int kFirst = 768, kStage = 384;  // samples: of the prior, of each stage
constexpr int kLastStages = 3;             // at full temperature; the evidence is theirs
constexpr int kMostStages = 30;            // until then
constexpr int kMostLastStages = 15;
constexpr double kEnough = 150;       // samples that count, at full temperature; fewer: more stages
constexpr double kLeastShare = 0.15;  // of samples that must count, for a step of temperature
constexpr double kWiden = 1.3;        // covariance of the proposal over that of the samples
constexpr double kDefensive = 0.1;    // share of the proposal that is the prior
constexpr double kFreedom = 5;        // of Student's t
constexpr double kNever = -1e300;

// std::lgamma writes the sign to a place that all threads share.
double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

double log_sum(const std::vector<double>& logs) {
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0;
  for (const double x : logs) sum += std::exp(x - most);
  return most + std::log(sum);
}

// Samples that count.
double effective(const std::vector<double>& log_weights) {
  const double all = log_sum(log_weights);
  double square = 0;
  for (const double w : log_weights) square += std::exp(2 * (w - all));
  return 1 / square;
}

// The highest temperature at which so many samples count.
template <class LogWeights>
double temperature_for(double least, const LogWeights& log_weights) {
  double low = 1e-6, high = 1;
  if (effective(log_weights(1.0)) >= least) return 1;
  for (int k = 0; k < 30; ++k) {
    const double middle = 0.5 * (low + high);
    (effective(log_weights(middle)) >= least ? low : high) = middle;
  }
  return low;
}

// Student's t about a mean, mixed with the prior; normal numbers by Box and Muller.
class Proposal {
 public:
  Proposal(const ParameterBox& box, Eigen::VectorXd mean, const Eigen::MatrixXd& covariance)
      : box_(box), mean_(std::move(mean)), factor_(covariance) {
    const double d = static_cast<double>(mean_.size());
    log_scale_ = log_gamma(0.5 * (kFreedom + d)) - log_gamma(0.5 * kFreedom) -
                 0.5 * d * std::log(kFreedom * std::numbers::pi) -
                 factor_.matrixLLT().diagonal().array().log().sum();
    log_prior_ = -(box.high - box.low).array().log().sum();
  }
  Eigen::VectorXd draw(Random& random) const {
    const Eigen::Index d = mean_.size();
    Eigen::VectorXd x(d);
    if (random.uniform() < kDefensive) {
      for (Eigen::Index k = 0; k < d; ++k)
        x[k] = box_.low[k] + random.uniform() * (box_.high[k] - box_.low[k]);
      return x;
    }
    for (Eigen::Index k = 0; k < d; ++k) x[k] = random.normal();
    double chi2 = 0;
    for (int k = 0; k < static_cast<int>(kFreedom); ++k) {
      const double z = random.normal();
      chi2 += z * z;
    }
    return mean_ + factor_.matrixL() * x * std::sqrt(kFreedom / chi2);
  }
  double log_density(const Eigen::VectorXd& x) const {
    const double d = static_cast<double>(mean_.size());
    const double square = factor_.matrixL().solve(x - mean_).squaredNorm();
    const double t = log_scale_ - 0.5 * (kFreedom + d) * std::log1p(square / kFreedom);
    return log_sum({std::log(1 - kDefensive) + t, std::log(kDefensive) + log_prior_});
  }

 private:
  const ParameterBox& box_;
  Eigen::VectorXd mean_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double log_scale_ = 0, log_prior_ = 0;
};

struct Sample {
  Eigen::VectorXd at;
  double log_likelihood;
  double log_proposal;  // density it was drawn from
};

bool inside(const Eigen::VectorXd& x, const ParameterBox& box) {
  return (x.array() >= box.low.array()).all() && (x.array() <= box.high.array()).all();
}

std::vector<double> log_weights(const std::vector<Sample>& samples, double temperature, double log_prior) {
  std::vector<double> logs;
  for (const Sample& s : samples)
    logs.push_back(s.log_likelihood <= kNever ? kNever
                                              : temperature * s.log_likelihood + log_prior - s.log_proposal);
  return logs;
}

Proposal proposal_of(const std::vector<Sample>& samples, const std::vector<double>& logs,
                     const ParameterBox& box) {
  const double all = log_sum(logs);
  const Eigen::Index d = box.low.size();
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(d);
  for (std::size_t k = 0; k < samples.size(); ++k) mean += std::exp(logs[k] - all) * samples[k].at;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(d, d);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Eigen::VectorXd off = samples[k].at - mean;
    covariance += std::exp(logs[k] - all) * off * off.transpose();
  }
  covariance *= kWiden;
  for (Eigen::Index k = 0; k < d; ++k) {
    const double width = box.high[k] - box.low[k];
    covariance(k, k) += 1e-8 * width * width;
  }
  return {box, mean, covariance};
}

// Indices of samples, by rising parameter.
std::vector<Eigen::Index> by_parameter(const Evidence& evidence, Eigen::Index parameter) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(evidence.samples.rows()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return evidence.samples(a, parameter) < evidence.samples(b, parameter);
  });
  return order;
}

}  // namespace

double Evidence::quantile(Eigen::Index parameter, double share) const {
  const std::vector<Eigen::Index> order = by_parameter(*this, parameter);
  double sum = 0;
  for (const Eigen::Index k : order) {
    sum += weights[k];
    if (sum >= share) return samples(k, parameter);
  }
  return samples(order.back(), parameter);
}

Evidence::Range Evidence::shortest(Eigen::Index parameter, double share) const {
  constexpr double kAtTheEnd = 0.01;  // of the box's width
  const std::vector<Eigen::Index> order = by_parameter(*this, parameter);
  const double first = box.low[parameter], last = box.high[parameter], width = last - first;
  Range range{first, last};
  double within = 0;  // probability of samples from k to before next
  std::size_t next = 0;
  for (const Eigen::Index k : order) {
    while (next < order.size() && within < share) within += weights[order[next++]];
    if (within < share) break;
    const Range here{samples(k, parameter), samples(order[next - 1], parameter)};
    if (here.high - here.low < range.high - range.low) range = here;
    within -= weights[k];
  }
  if (range.low - first < kAtTheEnd * width) range.low = first;
  if (last - range.high < kAtTheEnd * width) range.high = last;
  return range;
}

Evidence integrate(const std::function<double(const Eigen::VectorXd&)>& log_likelihood,
                   const ParameterBox& box, std::uint64_t seed) {
  Random random(seed, 0, RandomPurpose::design);
  const Eigen::Index d = box.low.size();
  const double log_prior = -(box.high - box.low).array().log().sum();
  std::vector<Sample> samples;
  for (int k = 0; k < kFirst; ++k) {  // a Latin line a dimension would gain little: the next stages adapt
    Eigen::VectorXd x(d);
    for (Eigen::Index j = 0; j < d; ++j) x[j] = box.low[j] + random.uniform() * (box.high[j] - box.low[j]);
    samples.push_back({x, log_likelihood(x), log_prior});
  }
  const auto draw = [&](const Proposal& proposal) {
    std::vector<Sample> drawn;
    for (int k = 0; k < kStage; ++k) {
      const Eigen::VectorXd x = proposal.draw(random);
      drawn.push_back({x, inside(x, box) ? log_likelihood(x) : kNever, proposal.log_density(x)});
    }
    return drawn;
  };
  double temperature = 0;
  for (int stage = 0; temperature < 1; ++stage) {
    const auto weights = [&](double t) { return log_weights(samples, t, log_prior); };
    temperature = stage == kMostStages
                      ? 1
                      : std::max(temperature + 1e-6,
                                 temperature_for(kLeastShare * static_cast<double>(samples.size()), weights));
    if (temperature < 1) samples = draw(proposal_of(samples, weights(temperature), box));
  }
  // The last stages: every sample as if drawn from the mixture of their proposals. A peak that they find late
  // asks for more of them.
  std::vector<Sample> last;
  std::vector<Proposal> proposals;
  std::vector<std::vector<double>> densities;  // of each sample by each proposal
  std::vector<double> logs;
  for (int stage = 0; stage < kMostLastStages && (stage < kLastStages || effective(logs) < kEnough);
       ++stage) {
    if (stage < kLastStages) {
      proposals.push_back(proposal_of(samples, log_weights(samples, 1, log_prior), box));
    } else {
      const auto tempered = [&](double t) {
        std::vector<double> all = logs;
        for (std::size_t k = 0; k < all.size(); ++k)
          if (last[k].log_likelihood > kNever) all[k] += (t - 1) * last[k].log_likelihood;
        return all;
      };
      proposals.push_back(proposal_of(last, tempered(temperature_for(kLeastShare * kStage, tempered)), box));
    }
    samples = draw(proposals.back());
    last.insert(last.end(), samples.begin(), samples.end());
    if (stage + 1 < kLastStages) continue;
    logs.clear();
    densities.resize(last.size());
    for (std::size_t k = 0; k < last.size(); ++k) {
      const Sample& s = last[k];
      while (densities[k].size() < proposals.size())
        densities[k].push_back(proposals[densities[k].size()].log_density(s.at));
      const double mixture = log_sum(densities[k]) - std::log(static_cast<double>(proposals.size()));
      logs.push_back(s.log_likelihood <= kNever ? kNever : s.log_likelihood + log_prior - mixture);
    }
  }
  Evidence evidence;
  evidence.box = box;
  double best = -std::numeric_limits<double>::infinity();
  for (const Sample& s : last)
    if (s.log_likelihood > best) {
      best = s.log_likelihood;
      evidence.most_likely = s.at;
    }
  const double all = log_sum(logs), count = static_cast<double>(logs.size());
  evidence.log_evidence = all - std::log(count);
  evidence.samples.resize(static_cast<Eigen::Index>(last.size()), d);
  evidence.weights.resize(static_cast<Eigen::Index>(last.size()));
  for (std::size_t k = 0; k < last.size(); ++k) {
    evidence.samples.row(static_cast<Eigen::Index>(k)) = last[k].at.transpose();
    evidence.weights[static_cast<Eigen::Index>(k)] = std::exp(logs[k] - all);
  }
  evidence.log_error = std::sqrt(std::max(evidence.weights.squaredNorm() - 1 / count, 0.0));
  return evidence;
}

}  // namespace scree
