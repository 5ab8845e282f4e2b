#include "analysis/diagnose/measurements.h"

#include <algorithm>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>
#include <limits>
#include <regex>

namespace scree {
namespace {

constexpr double kPriorRepeats = 10;  // what the simulation's scatter counts, in repeats; m in the header
constexpr double kEnoughTests = 20;   // more than values: their covariance needs no help
constexpr double kAllOfIt = 1.2;      // of a stated variance over that of repeats
constexpr double kLeastRatio = 0.05;  // of a measured variance to the simulation's: repeats that were rounded

// Expected logarithm of chi-square of so many degrees of freedom, over them.
double expected_log(double freedom) {
  return boost::math::digamma(0.5 * freedom) - std::log(0.5 * freedom);
}

// Degrees of freedom of a variance that is known as well as from that logarithm.
double freedom_of_log(double freedom) {
  return 2 / boost::math::trigamma(0.5 * freedom);
}

// Values of one experiment whose scatter is known from repeats: those that say nothing of correlations, and
// those that are correlated with each other, group by group.
struct Repeated {
  std::vector<Eigen::Index> uncorrelated;
  std::vector<std::vector<Eigen::Index>> correlated;
  std::vector<std::vector<Eigen::Index>> with_shared_errors;  // correlated, and by more than scatter
};

bool has_repeats(const MeasuredValue& value) {
  return value.std && value.repeats && *value.repeats >= 2 && *value.std > 0;
}

// All values that are correlated with this one, directly or through others; itself first.
std::vector<Eigen::Index> correlated_with(const Eigen::MatrixXd& covariance, Eigen::Index k) {
  std::vector<Eigen::Index> group{k};
  for (std::size_t next = 0; next < group.size(); ++next)
    for (Eigen::Index j = 0; j < covariance.cols(); ++j)
      if (covariance(group[next], j) != 0 && std::find(group.begin(), group.end(), j) == group.end())
        group.push_back(j);
  std::sort(group.begin(), group.end());
  return group;
}

Repeated repeated_values(const Measurements& measured, std::size_t experiment,
                         const Eigen::VectorXd& seed_variance) {
  const std::vector<Eigen::Index> all = measured.of(experiment);
  const auto is_scatter = [&](Eigen::Index k) {  // and nothing beyond it, but for rounding
    const MeasuredValue& value = measured.values[static_cast<std::size_t>(k)];
    return value.uncertainty * value.uncertainty <=
           kAllOfIt * *value.std * *value.std / static_cast<double>(*value.repeats);
  };
  const auto repeats = [&](Eigen::Index k) {
    return has_repeats(measured.values[static_cast<std::size_t>(k)]);
  };
  const auto varies = [&](Eigen::Index k) {
    return measured.values[static_cast<std::size_t>(k)].experiment == experiment &&
           seed_variance[k - all.front()] > 0;
  };
  Repeated repeated;
  for (const Eigen::Index k : all) {
    const std::vector<Eigen::Index> group = correlated_with(measured.covariance, k);
    const auto all_are = [&](auto&& is) { return std::all_of(group.begin(), group.end(), is); };
    if (group.front() != k || !all_are(repeats)) continue;
    const bool as_simulated = all_are(varies);
    if (group.size() > 1 && !(as_simulated && all_are(is_scatter)))
      repeated.with_shared_errors.push_back(group);
    else if (group.size() > 1)
      repeated.correlated.push_back(group);
    else if (as_simulated)
      repeated.uncorrelated.push_back(k);
  }
  return repeated;
}

// How much more an experiment's repeats scatter than the simulation: the mean over values of the ratio of
// variances, and the freedom that it is known with.
struct ScatterRatio {
  double ratio = 1, freedom = 0;
};

ScatterRatio scatter_ratio(const Measurements& measured, const std::vector<Eigen::Index>& values,
                           Eigen::Index first, const Eigen::MatrixXd& seeds) {
  double weighted = 0, weight = 0, freedom = 0;
  for (const Eigen::Index k : values) {
    const MeasuredValue& value = measured.values[static_cast<std::size_t>(k)];
    const double nu = *value.repeats - 1;
    const double here = std::max(*value.std * *value.std / seeds(k - first, k - first), kLeastRatio);
    weighted += nu * (std::log(here) - expected_log(nu));
    weight += nu;
    freedom += freedom_of_log(nu);
  }
  return {std::exp(weighted / weight), freedom};  // of logarithms: one odd number moves it little
}

const std::regex& section_pattern() {
  static const std::regex pattern(
      "(.*)_(S[0-9]+(of[0-9]+)?(_dump[0-9]+)?|top|middle|bottom|ring[0-9]|25|50|75)");
  return pattern;
}

}  // namespace

Eigen::VectorXd Measurements::vector() const {
  Eigen::VectorXd all(static_cast<Eigen::Index>(values.size()));
  for (std::size_t k = 0; k < values.size(); ++k) all[static_cast<Eigen::Index>(k)] = values[k].value;
  return all;
}

std::vector<Eigen::Index> Measurements::of(std::size_t experiment) const {
  std::vector<Eigen::Index> which;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (values[k].experiment == experiment) which.push_back(static_cast<Eigen::Index>(k));
  return which;
}

namespace {

// Puts the scatter of such values in place of what is stated, and says with which freedom its scale is known;
// `of_scatter`: between repeats, of the means.
ScatterBlock put_scatter(const Measurements& measured, const std::vector<Eigen::Index>& values,
                         const Eigen::MatrixXd& of_scatter, double freedom, Eigen::MatrixXd& covariance) {
  double squares = 0;
  for (std::size_t a = 0; a < values.size(); ++a) {
    for (std::size_t b = 0; b < values.size(); ++b)
      covariance(values[a], values[b]) =
          of_scatter(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
    const MeasuredValue& value = measured.values[static_cast<std::size_t>(values[a])];
    const double variance = covariance(values[a], values[a]);
    const double beyond =
        std::max(0.0, value.uncertainty * value.uncertainty - *value.std * *value.std / *value.repeats);
    covariance(values[a], values[a]) += beyond;
    squares += std::pow(variance / (variance + beyond), 2);
  }
  return {values, freedom * static_cast<double>(values.size()) / squares};
}

// Of the means of values: `of_one(i, j)` is the covariance of two in one test.
template <class OfOne>
Eigen::MatrixXd of_means(const Measurements& measured, const std::vector<Eigen::Index>& values,
                         OfOne of_one) {
  const auto repeats = [&](Eigen::Index k) {
    return static_cast<double>(*measured.values[static_cast<std::size_t>(k)].repeats);
  };
  const auto size = std::ssize(values);
  Eigen::MatrixXd covariance(size, size);
  for (Eigen::Index a = 0; a < size; ++a)
    for (Eigen::Index b = 0; b < size; ++b) {
      const Eigen::Index i = values[static_cast<std::size_t>(a)], j = values[static_cast<std::size_t>(b)];
      covariance(a, b) = of_one(i, j) / std::sqrt(repeats(i) * repeats(j));
    }
  return covariance;
}

// Of values of which no correlation is stated.
Eigen::MatrixXd scatter_by_simulation(const Measurements& measured, const std::vector<Eigen::Index>& values,
                                      double ratio, Eigen::Index first, const Eigen::MatrixXd& seeds) {
  return of_means(measured, values, [&](Eigen::Index i, Eigen::Index j) {
    const double of_seeds = seeds(i - first, j - first), correlated = of_seeds * std::min(ratio, 1.0);
    if (i != j) return correlated;
    const MeasuredValue& value = measured.values[static_cast<std::size_t>(i)];
    const double nu = *value.repeats - 1, s2 = *value.std * *value.std;
    const double variance = (kPriorRepeats * ratio * of_seeds + nu * s2) / (kPriorRepeats + nu);
    // A correlation above 1 cannot come of it: the diagonal is at least that of the correlated part.
    return std::max(variance, 1.02 * of_seeds * std::min(ratio, 1.0));
  });
}

int fewest_repeats(const Measurements& measured, const std::vector<Eigen::Index>& values) {
  int repeats = std::numeric_limits<int>::max();
  for (const Eigen::Index k : values)
    repeats = std::min(repeats, *measured.values[static_cast<std::size_t>(k)].repeats);
  return repeats;
}

// How many tests the simulation's scatter counts beside those of values whose correlations are stated.
double like_the_simulation(std::size_t values, int repeats) {
  const double p = static_cast<double>(values);
  return repeats >= p + kEnoughTests ? 0.0 : p + kPriorRepeats;
}

// The scale of Student's t of such values; `freedom` is its degrees of freedom.
Eigen::MatrixXd scatter_as_stated(const Measurements& measured, const std::vector<Eigen::Index>& values,
                                  double ratio, int repeats, double freedom, Eigen::Index first,
                                  const Eigen::MatrixXd& seeds) {
  const double like = like_the_simulation(values.size(), repeats);
  return of_means(measured, values, [&](Eigen::Index i, Eigen::Index j) {
    const auto std_of = [&](Eigen::Index k) { return *measured.values[static_cast<std::size_t>(k)].std; };
    const double correlation =
        measured.covariance(i, j) / std::sqrt(measured.covariance(i, i) * measured.covariance(j, j));
    const double sample = correlation * std_of(i) * std_of(j);
    return (like * ratio * seeds(i - first, j - first) + (repeats - 1) * sample) / freedom;
  });
}

}  // namespace

WorkingCovariance working_covariance(const Measurements& measured,
                                     const std::vector<const ResponseSurface*>& surfaces) {
  WorkingCovariance working{measured.covariance, {{}}};
  std::vector<bool> scatters(measured.values.size());
  for (std::size_t e = 0; e < measured.experiments.size(); ++e) {
    const std::vector<Eigen::Index> of_experiment = measured.of(e);
    if (of_experiment.empty()) continue;
    const Eigen::Index first = of_experiment.front();
    const Eigen::MatrixXd& seeds = surfaces[e]->scatter();
    const Repeated repeated = repeated_values(measured, e, seeds.diagonal());
    for (const auto& values : repeated.with_shared_errors) {
      const int n = fewest_repeats(measured, values);
      const double freedom = std::max(n - static_cast<double>(values.size()), 1.0);
      working.matrix(values, values) *= (n - 1) / freedom;
      working.blocks.push_back({values, freedom});
      for (const Eigen::Index k : values) scatters[static_cast<std::size_t>(k)] = true;
    }
    std::vector<Eigen::Index> all = repeated.uncorrelated;
    for (const auto& group : repeated.correlated) all.insert(all.end(), group.begin(), group.end());
    if (all.empty()) continue;
    for (const Eigen::Index k : all) scatters[static_cast<std::size_t>(k)] = true;
    const ScatterRatio known = scatter_ratio(measured, all, first, seeds);
    if (const auto& values = repeated.uncorrelated; !values.empty())
      working.blocks.push_back(
          put_scatter(measured, values, scatter_by_simulation(measured, values, known.ratio, first, seeds),
                      scatter_ratio(measured, values, first, seeds).freedom, working.matrix));
    for (const auto& values : repeated.correlated) {
      const int repeats = fewest_repeats(measured, values);
      const double freedom =
          repeats + like_the_simulation(values.size(), repeats) - static_cast<double>(values.size());
      working.blocks.push_back(put_scatter(
          measured, values, scatter_as_stated(measured, values, known.ratio, repeats, freedom, first, seeds),
          freedom, working.matrix));
    }
  }
  for (std::size_t k = 0; k < scatters.size(); ++k)
    if (!scatters[k]) working.blocks.front().values.push_back(static_cast<Eigen::Index>(k));
  if (working.blocks.front().values.empty()) working.blocks.erase(working.blocks.begin());
  return working;
}

std::string section_of_output(const std::string& output) {
  std::smatch parts;
  return std::regex_match(output, parts, section_pattern()) ? parts[2].str() : std::string();
}

std::string quantity_of_output(const std::string& output) {
  std::smatch parts;
  return std::regex_match(output, parts, section_pattern()) ? parts[1].str() : output;
}

}  // namespace scree
