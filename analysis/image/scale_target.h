#pragma once
// The scale of a picture, from magenta discs of known size that lie in it.
#include <opencv2/core.hpp>
#include <vector>

namespace scree {

/// A disc that was found.
struct ScaleTarget {
  double x = 0, y = 0;     ///< px
  double diameter_px = 0;  ///< the larger axis: a disc seen at an angle keeps it
  double tilt = 0;         ///< smaller over larger axis
};

/// Finds magenta discs: red and blue well above green, which neither rock nor plants nor sky have, in sun and
/// in shadow; at least 10 pixels across, filling its ellipse by 85 % and not flatter than 2 : 1. Ordered from
/// the top of the picture down. `mask` gets 255 where they and their rims are.
std::vector<ScaleTarget> find_targets(const cv::Mat3b& picture, cv::Mat1b& mask);

/// Metres a pixel at each height of the picture: the same everywhere, or rising evenly from top to bottom,
/// where targets at different heights say so.
struct ImageScale {
  double at_top = 0;   ///< m/px in row 0
  double per_row = 0;  ///< m/px more each row
  double at(double y) const { return at_top + per_row * y; }
};

/// The scale that targets of `diameter` (m) give: their mean, or, where the highest and the lowest lie at
/// least a third of the picture's height (`rows`) apart, the straight line of least squares. `targets` not
/// empty.
ImageScale scale_of(const std::vector<ScaleTarget>& targets, double diameter, int rows);

}  // namespace scree
