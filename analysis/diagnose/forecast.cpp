#include "analysis/diagnose/forecast.h"

#include <cmath>

namespace scree {
namespace {

// A priori: median, and the factor that is one standard deviation. Surfaces of small dumps had covariances
// wrong by 0.9 to 2.8, scatter by 0.9 to 2.
struct Prior {
  double median, factor;
  double log_density(double log_value) const {
    const double z = (log_value - std::log(median)) / std::log(factor);
    return -0.5 * z * z;
  }
};
constexpr Prior kScatter{1, 1.5}, kCovariance{1.5, 2};
constexpr double kLogMost = 4, kLogStep = 0.02;
constexpr double kNothingUnknown = 1e-9, kSure = 0.5;  // variances

// The most probable factor; `expected`: of a forecast, by the factor.
template <class Expected>
double most_probable(const Prior& prior, const std::vector<Forecast>& forecasts, const Expected& expected) {
  double best = 0, chosen = 1;
  for (int k = 0; kLogStep * k <= kLogMost; ++k) {
    const double factor = std::exp(kLogStep * k);
    double log_density = prior.log_density(kLogStep * k);
    for (const Forecast& each : forecasts) {
      const double here = expected(each, factor);
      log_density -= 0.5 * (std::log(here) + each.square / here);
    }
    if (k == 0 || log_density > best) {
      best = log_density;
      chosen = factor;
    }
  }
  return chosen;
}

}  // namespace

Widening widening(const std::vector<Forecast>& forecasts) {
  std::vector<Forecast> known, unknown;
  for (const Forecast& each : forecasts)
    if (each.variance < kSure) (each.variance < kNothingUnknown ? known : unknown).push_back(each);
  const double g = most_probable(kScatter, known, [](const Forecast&, double factor) { return factor; });
  const double f = most_probable(kCovariance, unknown, [&](const Forecast& each, double factor) {
    return g * (1 + factor * each.variance);
  });
  return {g, g * f};
}

}  // namespace scree
