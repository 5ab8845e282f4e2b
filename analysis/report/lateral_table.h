#pragma once
// The table of strips across a slope in the report of a run.
#include <string>

#include "analysis/results/results.h"

namespace scree {

/// chi and D50 ratio of every strip of every section, and how much they differ across, as means over seeds
/// (of the seeds in which the strip has enough rock), as HTML; empty unless it was a dump over a bench.
std::string lateral_table(const RunResult& result);

}  // namespace scree
