#pragma once
// The volume that a sphere and a box have in common.
#include "sim/material/vector.h"

namespace scree {

/// Volume (m3) of the part of a sphere of `radius` (m) at `centre` that lies inside the box between the
/// corners `low` and `high` (m). Areas of slices are exact; their sum along z is a Gauss rule on pieces that
/// end where a slice meets another face or edge, good to 1e-8 of the sphere. Throws std::invalid_argument for
/// a radius that is not above 0 or a box with low above high.
double sphere_in_box(const Vec3& centre, double radius, const Vec3& low, const Vec3& high);

}  // namespace scree
