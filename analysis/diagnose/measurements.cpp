#include "analysis/diagnose/measurements.h"

#include <algorithm>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cmath>
#include <limits>
#include <regex>

namespace scree {
namespace {

constexpr double kPriorRepeats = 10;  // what the simulation's scatter counts, in repeats
constexpr double kLeastRatio = 0.05;  // of a measured variance to the simulation's: repeats that were rounded

// Expected logarithm of chi-square of so many degrees of freedom, over them.
double expected_log(double freedom) {
  return boost::math::digamma(0.5 * freedom) - std::log(0.5 * freedom);
}

// Degrees of freedom of a variance that is known as well as from that logarithm.
double freedom_of_log(double freedom) {
  return 2 / boost::math::trigamma(0.5 * freedom);
}

bool scatter_is_stated(const Measurements& measured, Eigen::Index k) {
  const MeasuredValue& value = measured.values[static_cast<std::size_t>(k)];
  if (!value.std || !value.repeats || *value.repeats < 2) return false;
  for (Eigen::Index j = 0; j < measured.covariance.cols(); ++j)
    if (j != k && measured.covariance(k, j) != 0) return false;
  return true;
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

WorkingCovariance working_covariance(const Measurements& measured,
                                     const std::vector<const ResponseSurface*>& surfaces) {
  Eigen::MatrixXd covariance = measured.covariance;
  double freedom = 0;
  for (std::size_t e = 0; e < measured.experiments.size(); ++e) {
    const std::vector<Eigen::Index> all = measured.of(e);
    const Eigen::MatrixXd& seeds = surfaces[e]->scatter();
    std::vector<std::size_t> free;  // columns of the experiment
    double weighted = 0, weight = 0, known = 0;
    for (std::size_t c = 0; c < all.size(); ++c) {
      const auto k = static_cast<Eigen::Index>(c);
      if (!scatter_is_stated(measured, all[c]) || !(seeds(k, k) > 0)) continue;
      const MeasuredValue& value = measured.values[static_cast<std::size_t>(all[c])];
      free.push_back(c);
      const double nu = *value.repeats - 1;
      const double here = std::max(*value.std * *value.std / seeds(k, k), kLeastRatio);
      weighted += nu * (std::log(here) - expected_log(nu));
      weight += nu;
      known += freedom_of_log(nu);
    }
    if (free.empty()) continue;
    const double ratio = std::exp(weighted / weight);  // of logarithms: one odd number moves it little
    freedom += known;
    for (const std::size_t a : free)
      for (const std::size_t b : free) {
        const MeasuredValue& first = measured.values[static_cast<std::size_t>(all[a])];
        const MeasuredValue& second = measured.values[static_cast<std::size_t>(all[b])];
        const double of_seeds = seeds(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
        const double n = std::sqrt(static_cast<double>(*first.repeats) * *second.repeats);
        if (a != b) {
          covariance(all[a], all[b]) = of_seeds * std::min(ratio, 1.0) / n;
          continue;
        }
        const double nu = n - 1, s2 = *first.std * *first.std;
        const double variance = (kPriorRepeats * ratio * of_seeds + nu * s2) / (kPriorRepeats + nu);
        const double beyond = std::max(0.0, first.uncertainty * first.uncertainty - s2 / n);
        // A correlation above 1 cannot come of it: the diagonal is at least that of the correlated part.
        covariance(all[a], all[a]) = std::max(variance, 1.02 * of_seeds * std::min(ratio, 1.0)) / n + beyond;
      }
  }
  return {covariance, freedom > 0 ? freedom : std::numeric_limits<double>::infinity()};
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
