#pragma once
// The runs of a case or an option: what of them can be used, and how many cannot.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/results/results.h"

namespace scree {

/// The runs of one scenario that can be used, and how many cannot.
struct FinishedRuns {
  std::vector<Outputs> seeds;  ///< of the runs that are done and came to rest
  int failed = 0, missing = 0;
  int restless = 0;         ///< done, but a load still moved at its time limit
  double wall_seconds = 0;  ///< of those that can be used

  /// All that were asked for can be used.
  bool complete() const { return missing + failed + restless == 0; }
};

/// "a1: 2 runs done, 3 not run, 0 failed, 0 left out because they did not come to rest"
std::string runs_in_words(const std::string& name, const FinishedRuns& runs);

/// Mean and deviation of a number over the seeds that have it.
MeanStd spread_of(const std::vector<Outputs>& seeds,
                  const std::function<std::optional<double>(const Outputs&)>& number);
MeanStd spread_of(const std::vector<Outputs>& seeds, const std::string& output);

}  // namespace scree
