#pragma once
// Whether two means differ by more than their samples scatter.
#include "analysis/statistics/mean_std.h"

namespace scree {

/// Probability below which a difference is taken to be no accident.
inline constexpr double kSignificant = 0.05;

/// Student's t of the two-sided 95 % interval with this many degrees of freedom.
double t_95(double freedom);

/// Welch's t test, Biometrika 34 (1947) 28.
struct Welch {
  double difference = 0;  ///< a - b
  double error = 0;       ///< standard error of the difference
  double t_95 = 0;        ///< t of the two-sided 95 % interval: difference +- t_95 error
  double p = 1;           ///< two-sided probability that equal means differ so much
  bool known = false;     ///< both samples have two values or more, and scatter; else p is 1
};
Welch welch(const MeanStd& a, const MeanStd& b);

}  // namespace scree
