#pragma once
// Which outputs a scenario gives, known before it is simulated.
#include <string>
#include <vector>

#include "analysis/results/outputs.h"
#include "cli/ensemble/sweep_file.h"

namespace scree {

OutputScope output_scope(const Scenario& scenario);

/// How a slope that was measured in some number of sections is found among a scenario's outputs.
struct MeasuredSections {
  std::vector<std::string>
      overrides;   ///< cut the pile alike; that changes how it is looked at, not how it is made
  std::string of;  ///< behind S1: "of3" where the scenario cuts that way beside its own
};
MeasuredSections measured_sections(const Scenario& scenario, int sections);

/// Empty if the scenario, or any point of the sweep, gives this output; else why not.
std::string why_not_given(const Scenario& scenario, const std::string& output);
std::string why_not_given(const Sweep& sweep, const std::string& output);
/// Empty if the scenario gives this output and it can be measured; else why not.
std::string why_not_measured(const Scenario& scenario, const std::string& output);

}  // namespace scree
