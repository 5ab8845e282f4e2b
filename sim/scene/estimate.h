#pragma once
// What a scenario will cost, before anything is made.
#include "sim/material/grading.h"
#include "sim/scene/scenario.h"

namespace scree {

/// Most spheres a scenario may ask for.
inline constexpr double kMaxSpheres = 2e6;

/// Mass (kg) of all loads together.
double total_mass(const Scenario& scenario);

/// Expected number of spheres of a mass (kg): the integral of dP * mass / (density * pi/6 * d^3) over the
/// passing curve P, which between two points is linear in log d, so that there the mean of d^-3 is (d1^-3 -
/// d2^-3) / (3 ln(d2/d1)).
double estimated_spheres(const Grading& grading, double mass, double density);
/// The same of all loads of a scenario.
double estimated_spheres(const Scenario& scenario);

}  // namespace scree
