#pragma once
// Whether values scatter like a normal distribution.
#include <vector>

namespace scree {

/// Anderson and Darling's test of a normal distribution whose mean and deviation are those of the sample.
struct NormalityTest {
  double statistic = 0;  ///< A2, for a sample of this size (Stephens's A2*)
  double p = 1;          ///< probability of one as large or larger if the values are normal
  bool known = false;    ///< eight values at least, that scatter; else p is 1
};

/// A2* = A2 (1 + 0.75 / n + 2.25 / n^2) and its p by Stephens, in D'Agostino and Stephens, Goodness-of-Fit
/// Techniques (1986), table 4.9. NaN values are left out.
NormalityTest anderson_darling(const std::vector<double>& values);

}  // namespace scree
