#pragma once
// A straight line through the origin.
#include <vector>

namespace scree {

/// Least squares of y = slope x.
struct OriginFit {
  double slope = 0;
  double error = 0;       ///< standard error of the slope
  double r2 = 0;          ///< about zero, 1 - sum (y - slope x)^2 / sum y^2: what spreadsheets print
  double r2_of_mean = 0;  ///< about the mean of y: below 0 where a constant fits better than the line
  int n = 0;
};

/// Pairs with a NaN are left out; NaN for fewer than two pairs. The two R2 answer different questions, see
/// Eisenhauer, Teaching Statistics 25 (2003) 76. Throws std::invalid_argument for samples of different
/// length.
OriginFit fit_through_origin(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace scree
