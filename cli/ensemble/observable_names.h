#pragma once
// Whether a scenario gives an output.
#include <string>

#include "sim/scene/scenario.h"

namespace scree {

/// Empty if runs of this scenario have an output of this name (analysis/outputs.h); else what is wrong with
/// it: beside the experiment's type, its sections, other numbers of sections and the loads after which it is
/// analysed are looked at.
std::string why_not_given_by(const Scenario& scenario, const std::string& output);

}  // namespace scree
