#include "analysis/field/spread.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace scree {
namespace {

// A value that was printed on a border is there but for the rounding of its binary form.
constexpr double kOnBorder = 1e-9;

int bin_of(double value, double width) {
  return static_cast<int>(std::floor(value / width + kOnBorder));
}

std::vector<double> finite(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  return values;
}

}  // namespace

double sample_quantile(std::vector<double> values, double share) {
  values = finite(std::move(values));
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const std::size_t below = static_cast<std::size_t>(at), above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

Spread spread_over(const std::vector<double>& values) {
  const std::vector<double> known = finite(values);
  Spread spread;
  spread.moments = mean_std(known);
  spread.median = sample_quantile(known, 0.5);
  spread.low68 = sample_quantile(known, 0.16);
  spread.high68 = sample_quantile(known, 0.84);
  spread.low95 = sample_quantile(known, 0.025);
  spread.high95 = sample_quantile(known, 0.975);
  spread.min = sample_quantile(known, 0);
  spread.max = sample_quantile(known, 1);
  spread.normal = anderson_darling(known);
  if (spread.min > 0) {
    std::vector<double> logarithms;
    for (const double value : known) logarithms.push_back(std::log(value));
    spread.lognormal = anderson_darling(logarithms);
  }
  return spread;
}

double Histogram::share_at(double value) const {
  const int bin = bin_of(value, width) - first;
  return bin < 0 || bin >= static_cast<int>(shares.size()) ? 0 : shares[static_cast<std::size_t>(bin)];
}

std::size_t Histogram::mode() const {
  return static_cast<std::size_t>(std::max_element(shares.begin(), shares.end()) - shares.begin());
}

Histogram histogram(const std::vector<double>& values, double width) {
  if (!(width > 0)) throw std::invalid_argument("bins must have a width above 0");
  const std::vector<double> known = finite(values);
  if (known.empty()) throw std::invalid_argument("a histogram needs values");
  const auto [low, high] = std::minmax_element(known.begin(), known.end());
  Histogram out{width, bin_of(*low, width), {}};
  out.shares.assign(static_cast<std::size_t>(bin_of(*high, width) - out.first) + 1, 0);
  for (const double value : known)
    out.shares[static_cast<std::size_t>(bin_of(value, width) - out.first)] +=
        1 / static_cast<double>(known.size());
  return out;
}

double bin_width(const std::vector<double>& values) {
  const MeanStd both = mean_std(values);
  if (both.n < 2 || !(both.std > 0)) return 1;
  const double scott = 3.49 * both.std / std::cbrt(both.n);
  const double decade = std::pow(10, std::floor(std::log10(scott)));
  return (scott >= 5 * decade ? 5 : scott >= 2 * decade ? 2 : 1) * decade;
}

}  // namespace scree
