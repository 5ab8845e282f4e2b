#pragma once
// Whether a number has a sign, and whether it rises or falls over ordered groups: what seeds can say.
#include <vector>

#include "analysis/statistics/mean_std.h"

namespace scree {

/// Student's t test of one sample, one-sided: the probability that a sample whose true mean is 0 has a mean
/// as far to the side of `sign` (+1 or -1) as this one. t = sign mean / (std / sqrt n) with n - 1 degrees of
/// freedom. NaN with fewer than two values or no scatter.
double p_of_sign(const MeanStd& sample, int sign);

/// Least squares of y over x.
struct Slope {
  double slope = 0;
  double low = 0, high = 0;  ///< 95 % interval, with n - 2 degrees of freedom; NaN when p is
  double p = 0;              ///< two-sided, of no slope; NaN with fewer than three values or no scatter
};
/// NaN throughout unless there are two different x. Throws std::invalid_argument for different lengths.
Slope slope_of(const std::vector<double>& x, const std::vector<double>& y);

/// Jonckheere-Terpstra test of groups in order (Biometrika 41 (1954) 133): how many pairs of values of
/// different groups rise, ties counted half.
struct JonckheereTerpstra {
  double statistic = 0, expected = 0;
  double variance = 0;  ///< if there is no order, with ties
  double p = 0;         ///< two-sided, normal approximation; NaN without variance
};
JonckheereTerpstra jonckheere_terpstra(const std::vector<std::vector<double>>& groups);

}  // namespace scree
