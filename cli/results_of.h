#pragma once
// From what the simulation ends with to what analysis makes of it.
#include <string>

#include "analysis/results/results.h"
#include "sim/scene/run.h"
#include "sim/scene/scenario.h"

namespace scree {

/// What records the flow of a dump over a bench through RunHooks::look; none for other experiments.
std::optional<FlowRecorder> make_flow_recorder(const Scenario& scenario);

/// Analyses one seed: sections of the slope, its inside, slope angle and profile, or repose angle. `flow`: of
/// the same run.
SeedResult analyse(const Scenario& scenario, std::uint64_t seed, RunOutcome outcome,
                   std::optional<FlowRecorder> flow);

/// Why a dump over a bench has no slope angle; empty where it has one, and of other experiments.
std::string why_no_slope_angle(const Scenario& scenario, const SeedResult& seed);

/// Puts the seeds together, compares with the reference cases and adds what a reader must know.
RunResult put_together(const Scenario& scenario, std::vector<SeedResult> seeds,
                       std::vector<std::string> notes, const std::vector<ReferenceValue>& reference,
                       double wall_seconds);

}  // namespace scree
