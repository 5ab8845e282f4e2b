#include "analysis/statistics/ordered_trend.h"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "analysis/statistics/welch.h"

namespace scree {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double above(double t, double freedom) {
  return boost::math::cdf(boost::math::complement(boost::math::students_t(freedom), t));
}

}  // namespace

double p_of_sign(const MeanStd& sample, int sign) {
  if (sample.n < 2 || !(sample.std > 0)) return nan;
  return above(sign * sample.mean / (sample.std / std::sqrt(sample.n)), sample.n - 1);
}

Slope slope_of(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() != y.size()) throw std::invalid_argument("a slope needs as many y as x");
  const double n = static_cast<double>(x.size());
  const double mean_x = mean_std(x).mean, mean_y = mean_std(y).mean;
  double xx = 0, xy = 0;
  for (std::size_t k = 0; k < x.size(); ++k)
    xx += (x[k] - mean_x) * (x[k] - mean_x), xy += (x[k] - mean_x) * (y[k] - mean_y);
  Slope result{nan, nan, nan, nan};
  if (!(xx > 0)) return result;
  result.slope = xy / xx;
  double rest = 0;
  for (std::size_t k = 0; k < x.size(); ++k)
    rest += std::pow(y[k] - mean_y - result.slope * (x[k] - mean_x), 2);
  if (n < 3 || !(rest > 0)) return result;
  const double error = std::sqrt(rest / (n - 2) / xx);
  const double half = t_95(n - 2) * error;
  result.low = result.slope - half, result.high = result.slope + half;
  result.p = 2 * above(std::abs(result.slope) / error, n - 2);
  return result;
}

JonckheereTerpstra jonckheere_terpstra(const std::vector<std::vector<double>>& groups) {
  JonckheereTerpstra test;
  std::map<double, double> ties;  // how often each value is there
  double total = 0;
  // Sums over groups and over ties of c(c-1)(2c+5), c(c-1)(c-2), c(c-1): the variance of Kendall's S with
  // ties in both rankings (Kendall, Rank Correlation Methods), over 4.
  double order[2] = {}, triples[2] = {}, pairs[2] = {};
  const auto count = [&](int side, double c) {
    order[side] += c * (c - 1) * (2 * c + 5);
    triples[side] += c * (c - 1) * (c - 2);
    pairs[side] += c * (c - 1);
  };
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (std::size_t j = i + 1; j < groups.size(); ++j)
      for (const double a : groups[i])
        for (const double b : groups[j]) test.statistic += a < b ? 1 : a == b ? 0.5 : 0, test.expected += 0.5;
    for (const double value : groups[i]) ++ties[value];
    const double n = static_cast<double>(groups[i].size());
    count(0, n);
    total += n;
  }
  for (const auto& [value, times] : ties) count(1, times);
  if (total > 1) {
    test.variance = (total * (total - 1) * (2 * total + 5) - order[0] - order[1]) / 72 +
                    pairs[0] * pairs[1] / (8 * total * (total - 1));
    if (total > 2) test.variance += triples[0] * triples[1] / (36 * total * (total - 1) * (total - 2));
  }
  if (!(test.variance > 0)) {
    test.p = nan;
    return test;
  }
  const double z = std::abs(test.statistic - test.expected) / std::sqrt(test.variance);
  test.p = 2 * boost::math::cdf(boost::math::complement(boost::math::normal(), z));
  return test;
}

}  // namespace scree
