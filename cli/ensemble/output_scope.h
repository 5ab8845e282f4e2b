#pragma once
// Which outputs a scenario gives, known before it is simulated.
#include <string>

#include "analysis/results/outputs.h"
#include "cli/ensemble/sweep_file.h"

namespace scree {

OutputScope output_scope(const Scenario& scenario);

/// Empty if the scenario, or any point of the sweep, gives this output; else why not.
std::string why_not_given(const Scenario& scenario, const std::string& output);
std::string why_not_given(const Sweep& sweep, const std::string& output);
/// Empty if the scenario gives this output and it can be measured; else why not.
std::string why_not_measured(const Scenario& scenario, const std::string& output);

}  // namespace scree
