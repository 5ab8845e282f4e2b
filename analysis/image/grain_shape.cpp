#include "analysis/image/grain_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace scree {
namespace {

using std::numbers::pi;

// Ellipse of equal second moments. A pixel is a square with moments of its own, a twelfth.
void fit_ellipse(const cv::Mat1b& region, GrainShape& shape) {
  double n = 0, sx = 0, sy = 0;
  for (int y = 0; y < region.rows; ++y)
    for (int x = 0; x < region.cols; ++x)
      if (region(y, x)) {
        ++n;
        sx += x;
        sy += y;
      }
  shape.area = n;
  shape.x = sx / n;
  shape.y = sy / n;
  double xx = 0, yy = 0, xy = 0;
  for (int y = 0; y < region.rows; ++y)
    for (int x = 0; x < region.cols; ++x)
      if (region(y, x)) {
        xx += (x - shape.x) * (x - shape.x);
        yy += (y - shape.y) * (y - shape.y);
        xy += (x - shape.x) * (y - shape.y);
      }
  xx = xx / n + 1.0 / 12;
  yy = yy / n + 1.0 / 12;
  xy /= n;
  const double middle = (xx + yy) / 2, half = std::hypot((xx - yy) / 2, xy);
  const double major = 4 * std::sqrt(middle + half), minor = 4 * std::sqrt(std::max(middle - half, 1e-12));
  const double to_area = std::sqrt(shape.area / (pi / 4 * major * minor));
  shape.major = major * to_area;
  shape.minor = minor * to_area;
  // Rows count downwards: a turn that is anticlockwise to the eye has the other sign.
  shape.angle_deg = -0.5 * std::atan2(2 * xy, xx - yy) * 180 / pi;
  if (shape.angle_deg < 0) shape.angle_deg += 180;
}

// Crofton: a curve's length is pi/2 times the mean over directions of crossings per spacing of lines. Lines
// along rows, columns and both diagonals.
double crofton(const cv::Mat1b& region) {
  cv::Mat1b framed;
  cv::copyMakeBorder(region, framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, 0);
  std::int64_t straight = 0, diagonal = 0;
  for (int y = 0; y + 1 < framed.rows; ++y)
    for (int x = 0; x < framed.cols; ++x) {
      const bool here = framed(y, x) != 0;
      straight += here != (framed(y + 1, x) != 0);
      if (x + 1 < framed.cols) {
        straight += here != (framed(y, x + 1) != 0);
        diagonal += here != (framed(y + 1, x + 1) != 0);
      }
      if (x > 0) diagonal += here != (framed(y + 1, x - 1) != 0);
    }
  // Lines are 1 px apart along rows and columns, 1 / sqrt(2) along diagonals.
  return pi / 2 * (static_cast<double>(straight) + static_cast<double>(diagonal) / std::numbers::sqrt2) / 4;
}

// Largest and smallest width of the convex hull. The smallest lies square to a side of it.
void measure_ferets(const cv::Mat1b& region, GrainShape& shape) {
  std::vector<cv::Point> rim;
  for (int y = 0; y < region.rows; ++y) {
    int left = 0, right = region.cols - 1;
    while (left <= right && !region(y, left)) ++left;
    while (right > left && !region(y, right)) --right;
    if (left > right) continue;
    rim.push_back({left, y});
    rim.push_back({right, y});
  }
  std::vector<cv::Point> hull;
  cv::convexHull(rim, hull);
  double largest = 0, smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const cv::Point side = hull[(i + 1) % hull.size()] - hull[i];
    const double length = std::hypot(side.x, side.y);
    double across = 0;
    for (const cv::Point& p : hull) {
      const cv::Point to = p - hull[i];
      largest = std::max(largest, std::hypot(to.x, to.y));
      if (length > 0)
        across = std::max(
            across,
            std::abs(static_cast<double>(side.x) * to.y - static_cast<double>(side.y) * to.x) / length);
    }
    smallest = std::min(smallest, across);
  }
  // From the middles of the outermost pixels to their outer sides.
  shape.feret_max = largest + 1;
  shape.feret_min = smallest + 1;
}

}  // namespace

double GrainShape::equal_area_diameter() const {
  return std::sqrt(4 * area / pi);
}
double GrainShape::circularity() const {
  return 4 * pi * area / (perimeter * perimeter);
}
double GrainShape::elongation() const {
  return minor / major;
}
double GrainShape::roundness() const {
  return 4 * area / (pi * feret_max * feret_max);
}

GrainShape shape_of(const cv::Mat1b& region) {
  GrainShape shape;
  fit_ellipse(region, shape);
  shape.perimeter = crofton(region);
  measure_ferets(region, shape);
  return shape;
}

}  // namespace scree
