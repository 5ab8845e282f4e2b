#pragma once
// Measured values that cannot be, as far as the scenario tells.
#include "cli/ensemble/dataset_file.h"

namespace scree {

/// Errors, each with the line of its row: D_x of a part of the pile that fall with rising x (of those 20 %
/// and more apart), |chi| above 5, angles beyond 90 degrees, a rebound above the drop; and by more than
/// five standard uncertainties shares outside 0 to 1, other numbers below 0 that have no sign, more mass in a
/// section, a bed or a bucket than is dumped. Uncertainties must be there. A D_x outside the grading by more than a factor of 1.5 becomes a note. `file`: the observables'.
void check_bounds(const std::filesystem::path& file, Dataset& dataset, std::vector<ScenarioError>& errors);

}  // namespace scree
