#pragma once
// Results as text.
#include "analysis/results/results.h"

namespace scree {

/// Prints what a reader wants first: sections or repose angle, then the comparison.
void print_result(const RunResult& result);
/// Prints the comparison with the reference values as a table.
void print_comparison(const std::vector<Comparison>& comparison);

}  // namespace scree
