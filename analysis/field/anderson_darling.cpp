#include "analysis/field/anderson_darling.h"

#include <algorithm>
#include <boost/math/statistics/anderson_darling.hpp>
#include <cmath>

namespace scree {
namespace {

constexpr std::size_t kFewest = 8;  // below, table 4.9 does not hold

double p_of(double a) {
  if (a >= 0.6) return std::exp(1.2937 - 5.709 * a + 0.0186 * a * a);
  if (a >= 0.34) return std::exp(0.9177 - 4.279 * a - 1.38 * a * a);
  if (a >= 0.2) return 1 - std::exp(-8.318 + 42.796 * a - 59.938 * a * a);
  return 1 - std::exp(-13.436 + 101.14 * a - 223.73 * a * a);
}

}  // namespace

NormalityTest anderson_darling(const std::vector<double>& values) {
  std::vector<double> sorted;
  for (const double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  std::sort(sorted.begin(), sorted.end());
  NormalityTest test;
  if (sorted.size() < kFewest || !(sorted.back() > sorted.front())) return test;
  const double n = static_cast<double>(sorted.size());
  test.statistic =
      boost::math::statistics::anderson_darling_normality_statistic(sorted) * (1 + 0.75 / n + 2.25 / (n * n));
  // Beyond 13 the parabola of the tail turns back up; p is 0 to any digit long before.
  test.p = test.statistic < 13 ? p_of(test.statistic) : 0;
  test.known = true;
  return test;
}

}  // namespace scree
