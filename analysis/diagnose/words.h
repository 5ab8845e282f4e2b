#pragma once
// Words of a diagnosis that its report and its answer share.
#include <string>
#include <vector>

#include "analysis/diagnose/outcome.h"

namespace scree {

/// "cohesion", "cohesion and twisting", "no effect (re-calibration alone)", "something unknown".
std::string name_of(const ModelSpace& space, const Hypothesis& hypothesis);
/// "cohesion.bond_number": the effect, and the last part of the parameter's key.
std::string label_of(const CandidateEffect& effect, std::size_t axis);
/// "cohesion.bond_number 0.62 (0.51 to 0.78)" of every parameter of its effects: the middle of the interval,
/// and the interval.
std::string values_in_words(const ModelSpace& space, const Judgement& judgement);
/// What was simulated in full and is handed over as scenarios, beside the intervals: "cohesion.bond_number
/// 0.59 (middle of its interval 0.62, 0.51 to 0.78)" of every parameter, base parameters first; empty if
/// nothing was.
std::vector<std::string> simulated_in_words(const DiagnosisOutcome& outcome);
/// "chi-square 25.1 on 22, p = 0.290"; that there is no test where there is none.
std::string gap_in_words(const Gap& gap);

}  // namespace scree
