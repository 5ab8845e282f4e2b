#include "analysis/field/origin_fit.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace scree {

OriginFit fit_through_origin(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() != y.size()) throw std::invalid_argument("a fit needs as many x as y");
  const auto both = [&](std::size_t i) { return std::isfinite(x[i]) && std::isfinite(y[i]); };
  OriginFit fit;
  double xx = 0, xy = 0, yy = 0, sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!both(i)) continue;
    xx += x[i] * x[i], xy += x[i] * y[i], yy += y[i] * y[i], sum += y[i];
    ++fit.n;
  }
  if (fit.n < 2 || !(xx > 0)) {
    fit.slope = fit.error = fit.r2 = fit.r2_of_mean = std::numeric_limits<double>::quiet_NaN();
    return fit;
  }
  fit.slope = xy / xx;
  double residual = 0, about_mean = 0;
  const double mean = sum / fit.n;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!both(i)) continue;
    residual += (y[i] - fit.slope * x[i]) * (y[i] - fit.slope * x[i]);
    about_mean += (y[i] - mean) * (y[i] - mean);
  }
  fit.error = std::sqrt(residual / (fit.n - 1) / xx);
  fit.r2 = 1 - residual / yy;
  fit.r2_of_mean = 1 - residual / about_mean;
  return fit;
}

}  // namespace scree
