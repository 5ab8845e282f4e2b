#pragma once
// How values differ from picture to picture.
#include <vector>

#include "analysis/field/anderson_darling.h"
#include "analysis/results/results.h"

namespace scree {

/// What is said of a number over pictures. Quantiles hold 68 and 95 % of the pictures between them, whatever
/// the distribution.
struct Spread {
  MeanStd moments;
  double median = 0, low68 = 0, high68 = 0, low95 = 0, high95 = 0, min = 0, max = 0;  ///< NaN without values
  NormalityTest normal;                                                               ///< of the values
  NormalityTest lognormal;  ///< of their logarithms; not known where one is not above 0
};

/// NaN values are left out.
Spread spread_over(const std::vector<double>& values);

/// Quantile of a sample at a share from 0 to 1, linear between the sorted values (type 7 of Hyndman and Fan,
/// The American Statistician 50 (1996) 361). NaN for none; NaN values are left out.
double sample_quantile(std::vector<double> values, double share);

/// Shares of the values in bins of equal width.
struct Histogram {
  double width = 0;
  int first = 0;               ///< the first bin reaches from first * width
  std::vector<double> shares;  ///< sum 1; the first and the last are not 0
  double middle(std::size_t bin) const { return (first + static_cast<double>(bin) + 0.5) * width; }
  double share_at(double value) const;  ///< of the bin that holds the value
  std::size_t mode() const;             ///< the bin with the largest share, the first of equals
};

/// Bins begin at 0; a value on a border belongs to the bin above it. Throws std::invalid_argument without
/// values or for a width not above 0. NaN values are left out.
Histogram histogram(const std::vector<double>& values, double width);

/// The largest of 1, 2, 5 times a power of ten that is not above Scott's width, 3.49 std / cbrt(n)
/// (Biometrika 66 (1979) 605); 1 if the values do not scatter.
double bin_width(const std::vector<double>& values);

}  // namespace scree
