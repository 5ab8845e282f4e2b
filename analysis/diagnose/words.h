#pragma once
// Words of a diagnosis that its report and its answer share.
#include <string>

#include "analysis/diagnose/outcome.h"

namespace scree {

/// "cohesion", "cohesion and twisting", "no effect (re-calibration alone)", "something unknown".
std::string name_of(const ModelSpace& space, const Hypothesis& hypothesis);
/// "bond_number 0.62 (0.51 to 0.78)" of every parameter of its effects.
std::string values_in_words(const ModelSpace& space, const Judgement& judgement);
/// "chi-square 25.1 on 22 degrees of freedom, p 0.29".
std::string gap_in_words(const Gap& gap);

}  // namespace scree
