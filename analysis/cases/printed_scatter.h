#pragma once
// What PFC3D's repeats say of how uncertain its printed means, differences and slopes are.
#include <optional>
#include <vector>

#include "analysis/results/outputs.h"

namespace scree {

/// A mean that is printed of PFC3D, and how its repeats scatter.
struct PrintedMean {
  std::optional<double> mean;
  std::optional<double> std;  ///< printed with the mean, or as the scatter of the quantity (`..._scatter`)
  bool at_most = false;       ///< of `std` a bound is printed, which stands for it
  int repeats = 0;            ///< 0: not stated

  bool scatters() const { return std && *std > 0 && repeats > 1; }
};
/// That of `value` among what was compared of a case.
PrintedMean printed_mean(const std::vector<Comparison>& compared, const PileValue& value);

/// Half of a 95 % interval.
struct PrintedHalf {
  double half = 0;  ///< 0: no scatter is printed
  bool at_most = false;
};
// Student's t with the degrees of freedom of Welch and Satterthwaite; a mean without a printed scatter takes
// the mean of the others' variances.

/// That of a difference a - b, or of (a - b) / |b|, which is `difference`: var(a / b) = va / b^2 + a^2 vb /
/// b^4. `our_b` stands for the scale |b| if neither mean is printed.
PrintedHalf half_of_difference(const PrintedMean& a, const PrintedMean& b, bool relative, double difference,
                               double our_b);
/// That of the least squares slope of printed means over x, sum (x - mean x) y / sum (x - mean x)^2. Those
/// without a mean are there for their scatter.
PrintedHalf half_of_slope(const std::vector<double>& x, const std::vector<PrintedMean>& printed);

}  // namespace scree
