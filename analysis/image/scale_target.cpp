#include "analysis/image/scale_target.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "analysis/image/grain_shape.h"

namespace scree {
namespace {

// Shares of the brightest colour, so that the light does not matter.
bool is_magenta(const cv::Vec3b& pixel) {
  const int blue = pixel[0], green = pixel[1], red = pixel[2];
  const int bright = std::max(blue, red);
  return bright >= 50 && std::min(blue, red) * 2 >= bright &&
         10 * (std::min(blue, red) - green) >= 3 * bright;
}

// How much magenta a pixel has, in light: blur mixes light, and cameras store about its 2.2th root.
double magenta_light(const cv::Vec3b& pixel) {
  const auto light = [](uchar value) { return std::pow(value / 255.0, 2.2); };
  return std::min(light(pixel[0]), light(pixel[2])) - light(pixel[1]);
}

// Area of a disc, px2, with the shares of its blurred rim: `inside` and what is around it, in the same box.
double area_with_rim(const cv::Mat3b& picture, const cv::Mat1b& inside) {
  cv::Mat1b core, around;
  cv::erode(inside, core, cv::getStructuringElement(cv::MORPH_ELLIPSE, {7, 7}), {-1, -1}, 1,
            cv::BORDER_CONSTANT, 0);
  cv::dilate(inside, around, cv::getStructuringElement(cv::MORPH_ELLIPSE, {9, 9}));
  double full = 0, sum = 0;
  for (int y = 0; y < inside.rows; ++y)
    for (int x = 0; x < inside.cols; ++x) {
      if (!around(y, x)) continue;
      const double light = magenta_light(picture(y, x));
      if (core(y, x)) full += light;
      sum += std::max(light, 0.0);
    }
  return sum / (full / std::max(1, cv::countNonZero(core)));
}

}  // namespace

std::vector<ScaleTarget> find_targets(const cv::Mat3b& picture, cv::Mat1b& mask) {
  cv::Mat1b magenta(picture.size(), 0);
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (is_magenta(picture(y, x))) magenta(y, x) = 255;
  mask = cv::Mat1b(picture.size(), 0);
  cv::Mat1i labels, stats;
  cv::Mat1d centroids;
  const int n = cv::connectedComponentsWithStats(magenta, labels, stats, centroids, 8, CV_32S);
  std::vector<ScaleTarget> targets;
  for (int label = 1; label < n; ++label) {
    if (stats(label, cv::CC_STAT_AREA) < 50) continue;
    const cv::Rect box(stats(label, cv::CC_STAT_LEFT), stats(label, cv::CC_STAT_TOP),
                       stats(label, cv::CC_STAT_WIDTH), stats(label, cv::CC_STAT_HEIGHT));
    const cv::Mat1b region = labels(box) == label;
    const GrainShape shape = shape_of(region);
    // What covers a part of the disc changes its outline more than its ellipse.
    const double filled = shape.area / (std::numbers::pi / 4 * shape.feret_max * shape.feret_min);
    if (shape.minor < 10 || filled < 0.85 || filled > 1.1 || shape.minor < 0.5 * shape.major) continue;
    const double tilt = shape.minor / shape.major;
    const cv::Rect wide = cv::Rect(box.x - 6, box.y - 6, box.width + 12, box.height + 12) &
                          cv::Rect(0, 0, picture.cols, picture.rows);
    const double area = area_with_rim(picture(wide), labels(wide) == label);
    targets.push_back(
        {box.x + shape.x, box.y + shape.y, std::sqrt(4 * area / (std::numbers::pi * tilt)), tilt});
    mask(box).setTo(255, region);
  }
  if (!targets.empty())
    cv::dilate(mask, mask, cv::getStructuringElement(cv::MORPH_ELLIPSE, {9, 9}));  // its blurred rim
  std::sort(targets.begin(), targets.end(),
            [](const ScaleTarget& a, const ScaleTarget& b) { return a.y < b.y; });
  return targets;
}

ImageScale scale_of(const std::vector<ScaleTarget>& targets, double diameter, int rows) {
  assert(!targets.empty());
  double mean_y = 0, mean = 0;
  for (const ScaleTarget& target : targets) {
    mean_y += target.y / static_cast<double>(targets.size());
    mean += diameter / target.diameter_px / static_cast<double>(targets.size());
  }
  if (targets.back().y - targets.front().y < rows / 3.0) return {mean, 0};
  double yy = 0, ys = 0;
  for (const ScaleTarget& target : targets) {
    yy += (target.y - mean_y) * (target.y - mean_y);
    ys += (target.y - mean_y) * (diameter / target.diameter_px - mean);
  }
  return {mean - ys / yy * mean_y, ys / yy};
}

}  // namespace scree
