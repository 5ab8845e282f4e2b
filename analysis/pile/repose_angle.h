#pragma once
// Repose angle of a heap: the slope of its flank, and other readings beside it.
#include "sim/io/snapshot.h"

namespace scree {

/// Readings of the repose angle of one heap (degrees).
///
/// `angle` is the one that is compared and calibrated. The thesis describes `height_over_radius`; the slope
/// of the flank is nearest to its tables (docs/results.md has the three readings against all of them).
struct ReposeAngle {
  double angle = 0;               ///< slope of the mean surface between 20 and 80 % of its height at the axis
  double height_over_radius = 0;  ///< atan(H / R), R the mean of four directions out to where grains no
                                  ///< longer overlap
  double half_coverage = 0;       ///< atan(H / R_h), R_h where half of the ring's plan area is covered
  double flank_height = 0;        ///< m over the floor, where the fitted line meets the axis
  double height = 0;              ///< H, top of the cone, m
  double radius = 0;              ///< mean R, m
  double radii[4] = {0, 0, 0, 0};  ///< +x, +y, -x, -y
  double runaways = 0;             ///< number of grains beyond R, left out
  double axis[2] = {0, 0};         ///< x and y of the axis, m
  std::vector<double> surface;  ///< mean height of what is seen from above, m over the floor, of rings about
                                ///< the axis, `surface_step` m wide
  double surface_step = 0;
};

/// Heap on a floor at z = `floor`; the axis is found from the heap (mass-weighted median of x and y). What
/// cannot be read is NaN: everything but the axis where it lies in a gap between grains, so that there is no
/// R.
ReposeAngle measure_repose(const std::vector<Grain>& heap, double floor = 0.0);

}  // namespace scree
