#include "analysis/diagnose/forecast.h"

#include <cmath>

namespace scree {
namespace {

constexpr double kUsual = 1.5, kFactor = 2;  // a priori; surfaces of small dumps had 0.9 to 2.8
constexpr double kLogMost = 4, kLogStep = 0.02;

}  // namespace

double widening(const std::vector<Forecast>& forecasts) {
  double best = 0, chosen = 1;
  for (int k = 0; kLogStep * k <= kLogMost; ++k) {
    const double log_factor = kLogStep * k, factor = std::exp(log_factor);
    const double z = (log_factor - std::log(kUsual)) / std::log(kFactor);
    double log_density = -0.5 * z * z;
    for (const Forecast& each : forecasts) {
      const double expected = 1 + factor * each.variance;
      log_density -= 0.5 * (std::log(expected) + each.square / expected);
    }
    if (k == 0 || log_density > best) {
      best = log_density;
      chosen = factor;
    }
  }
  return chosen;
}

}  // namespace scree
