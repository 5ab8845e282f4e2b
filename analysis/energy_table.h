#pragma once
#include <string>

#include "analysis/results.h"

namespace scree {

/// Largest error of the seeds' energy balances by size, with its sign; NaN if no seed has one.
double largest_energy_error(const RunResult& result);

/// The energy balance, mean over seeds, as HTML; empty if no seed has one (impulse).
std::string energy_table(const RunResult& result);

}  // namespace scree
