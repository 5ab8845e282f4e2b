#pragma once
// Height of the surface of a pile over a plan.
#include <optional>
#include <utility>
#include <vector>

#include "sim/io/snapshot.h"

namespace scree {

/// Highest rock over each point of a lattice in plan, within a band of y.
///
/// A grain covers the points up to its radius with its upper side, and those up to sqrt(2) of it at the
/// height of its centre: so touching equal grains leave no open shafts between them, not even on a square
/// lattice.
class SurfaceHeight {
 public:
  /// Grains that reach into y_low to y_high (m); points about `pitch` (m) apart. Throws std::invalid_argument
  /// unless pitch > 0 and y_low < y_high.
  SurfaceHeight(const std::vector<Grain>& pile, double y_low, double y_high, double pitch);
  /// Share (0 to 1) of the points with x_low <= x < x_high whose rock reaches up to `height` (m) or above;
  /// points without rock count as not reaching it.
  double share_above(double x_low, double x_high, double height) const;
  /// The height (m) that this share (above 0) of the points with x_low <= x < x_high reaches; none if less of
  /// them have rock, or there are none.
  std::optional<double> reached_by(double x_low, double x_high, double share) const;

 private:
  std::pair<long, long> columns(double x_low, double x_high) const;
  double x0_ = 0, y0_ = 0, pitch_x_ = 0, pitch_y_ = 0;  // the first point lies half a pitch from (x0, y0)
  long columns_ = 0, rows_ = 0;
  std::vector<double> heights_;  // a column along y after the other
};

}  // namespace scree
