#pragma once
// What a heap of a repose test says beside its angle: gradings of rings, form of its surface, runout.
#include <functional>

#include "analysis/pile/repose_angle.h"
#include "analysis/pile/segregation.h"

namespace scree {

inline constexpr int kHeapRings = 3;
inline constexpr double kProfilePlaces[] = {0.25, 0.50, 0.75};  // r / R

/// Rings in plan about the heap's axis, of equal steps of radius out to its radius R, and its surface.
struct HeapShape {
  SectionTable rings;      ///< ring1 (the middle) to ring3; x_over_l is r / R of the ring's middle;
                           ///< mass_outside is what lies beyond R; no rings where there is no R
  double mass_share[3]{};  ///< of each ring, of all mass of the heap; NaN where there is no R
  double profile[3]{};     ///< height of the mean surface over the heap's height at r / R = 0.25, 0.5, 0.75;
                           ///< NaN where there is no R
  double spread_95 = 0;    ///< radius that holds 95 % of the mass over the cube root of the solid's volume
};

/// Shape of a heap whose angle was read (`read`, of the same grains); gradings against `original` (every
/// grain as filled). A cone of radius R and height H has the profile 1 - r / R. Throws std::invalid_argument
/// when `heap` or `original` is empty.
HeapShape measure_heap_shape(const std::vector<Grain>& heap, const std::vector<Grain>& original,
                             const ReposeAngle& read, const Measurement& measured = {});

/// A number of ring k (0 in the middle); NaN where the heap has no rings.
double of_ring(const HeapShape& heap, std::size_t k, const std::function<double(const Section&)>& value);

}  // namespace scree
