#pragma once
#include <string>

#include "analysis/results/results.h"

namespace scree {

/// The energy balance, mean over seeds, as HTML; empty if no seed has one (impulse).
std::string energy_table(const RunResult& result);

}  // namespace scree
