#pragma once
// What a run must keep to count as one. What breaks it is a failure with an exit code of its own, never a
// warning: the numbers of such a run say nothing.
//
//   energy   what was put in is still there or was taken out, to kMostEnergyError (world/energy_balance.h)
//   numbers  every place and velocity is finite; during the run RockWorld::check_spheres() looks, too
//   mass     at most kMostLost of the rock left the model
//
// `engine: impulse` keeps no account of energy; numbers and mass are watched. A large overlap is a warning.
#include <string>
#include <vector>

#include "sim/scene/run.h"

namespace scree {

inline constexpr double kMostEnergyError = 0.01;  ///< of the energy that was put in
inline constexpr double kMostLost = 0.01;         ///< of the mass that was put in

/// Whether a balance is closed well enough for the run to count; not for NaN.
bool closes(const EnergyBalance& balance);

/// What is wrong with a run, a line each; empty for one that counts.
std::vector<std::string> watch_failures(const RunOutcome& outcome);

}  // namespace scree
