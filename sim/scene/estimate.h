#pragma once
// What a scenario will cost, before anything is made.
#include "sim/material/grading.h"
#include "sim/scene/scenario.h"

namespace scree {

/// Most spheres a scenario may ask for.
inline constexpr double kMaxSpheres = 2e6;

/// Mass (kg) of all loads together.
double total_mass(const Scenario& scenario);

/// Expected number of spheres of all loads, with what effects change of rock and grading.
double estimated_spheres(const Scenario& scenario);

}  // namespace scree
