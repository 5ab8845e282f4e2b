#pragma once
// The half cone of the laboratory segregation test, cut as in the laboratory.
#include "analysis/pile/repose_angle.h"
#include "analysis/pile/segregation.h"

namespace scree {

/// A half cone against a wall at x = 0, on a floor at z = 0.
struct HalfCone {
  SectionTable surface;  ///< cells at its surface: top, middle, bottom
  ReposeAngle shape;     ///< of the whole cone that it is one half of
};

/// Cuts the half cone into three parts by height and three by distance from its axis, which leaves six cells
/// in the triangle of its section, and analyses the three at the surface against `original` (every grain as
/// dumped). Height and radius are those of the cone fitted to its flank; the outermost cell reaches on to
/// where grains no longer overlap; runaways and the inner cells count as mass_outside. Throws
/// std::invalid_argument when there is no original or the heap is no cone.
HalfCone analyse_half_cone(const std::vector<Grain>& pile, const std::vector<Grain>& original,
                           const Measurement& measured = {});

}  // namespace scree
