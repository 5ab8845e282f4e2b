#pragma once
#include <vector>

namespace scree {

/// Mean and standard deviation (n - 1) over seeds; std is NaN for one value. NaN values are left out.
struct MeanStd {
  double mean = 0, std = 0;
  int n = 0;
};
MeanStd mean_std(const std::vector<double>& values);

}  // namespace scree
