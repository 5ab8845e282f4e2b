#include "analysis/statistics/mean_std.h"

#include <cmath>
#include <limits>

namespace scree {

MeanStd mean_std(const std::vector<double>& values) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  MeanStd result;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    result.mean += value;
    ++result.n;
  }
  result.mean = result.n > 0 ? result.mean / result.n : nan;
  for (const double value : values)
    if (!std::isnan(value)) result.std += (value - result.mean) * (value - result.mean);
  result.std = result.n > 1 ? std::sqrt(result.std / (result.n - 1)) : nan;
  return result;
}

}  // namespace scree
