#include "analysis/image/photo_region.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace scree {

PhotoRegion::PhotoRegion(const cv::Size& picture, const std::vector<cv::Point>& polygon)
    : box_({0, 0}, picture), mask_(picture, static_cast<uchar>(polygon.empty() ? 255 : 0)) {
  area_ = static_cast<double>(box_.width) * box_.height;
  if (polygon.empty()) return;
  box_ &= cv::boundingRect(polygon);
  if (box_.width < 10 || box_.height < 10)
    throw std::runtime_error(fmt::format("the region has {} x {} pixels within the picture of {} x {}",
                                         box_.width, box_.height, picture.width, picture.height));
  cv::fillPoly(mask_, std::vector{polygon}, 255);
  area_ = cv::countNonZero(mask_);
  if (is_rectangle()) return;
  cv::integral(mask_ / 255, pixels_, CV_32S);
  // Beyond the picture nothing is seen either.
  cv::Mat1b framed;
  cv::copyMakeBorder(mask_, framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, 0);
  cv::Mat1f distance;
  cv::distanceTransform(framed, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  for (const float d : distance)
    if (d > 0) to_edge_.push_back(d);
  std::sort(to_edge_.begin(), to_edge_.end());
}

bool PhotoRegion::has(double x, double y) const {
  const cv::Point at(static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y)));
  return box_.contains(at) && mask_(at) != 0;
}

double PhotoRegion::middles(double width, double height) const {
  const double left = std::max<double>(box_.x, width / 2), top = std::max<double>(box_.y, height / 2),
               right = std::max(left, std::min<double>(box_.br().x, mask_.cols - width / 2)),
               bottom = std::max(top, std::min<double>(box_.br().y, mask_.rows - height / 2));
  if (is_rectangle()) return (right - left) * (bottom - top);
  const auto upto = [&](double y, double x) {
    return pixels_(std::min<int>(std::lround(y), mask_.rows), std::min<int>(std::lround(x), mask_.cols));
  };
  return upto(bottom, right) - upto(bottom, left) - upto(top, right) + upto(top, left);
}

double PhotoRegion::places_of_disc(double diameter) const {
  return static_cast<double>(
      to_edge_.end() - std::lower_bound(to_edge_.begin(), to_edge_.end(), static_cast<float>(diameter / 2)));
}

double PhotoRegion::weight(const Extent& grain, bool within_frame) const {
  if (is_rectangle()) {
    const double whole = static_cast<double>(std::max(box_.width - grain.box.width, 1)) *
                         std::max(box_.height - grain.box.height, 1);
    return (within_frame ? middles(grain.box.width, grain.box.height) : area_) / whole;
  }
  const double width = (grain.widest + grain.narrowest) / 2;
  const double whole = (places_of_disc(grain.widest) + places_of_disc(grain.narrowest)) / 2;
  return (within_frame ? middles(width, width) : area_) / std::max(whole, 1.0);
}

}  // namespace scree
