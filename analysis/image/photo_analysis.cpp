#include "analysis/image/photo_analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace scree {
namespace {

// Boxes around all labels, in one go.
std::vector<cv::Rect> boxes_of(const Labels& labels) {
  struct Span {
    int left = 1 << 30, top = 1 << 30, right = -1, bottom = -1;
  };
  std::vector<Span> spans(labels.count + 1);
  for (int y = 0; y < labels.of.rows; ++y)
    for (int x = 0; x < labels.of.cols; ++x)
      if (const int label = labels.of(y, x); label > 0) {
        Span& span = spans[label];
        span.left = std::min(span.left, x);
        span.right = std::max(span.right, x);
        span.top = std::min(span.top, y);
        span.bottom = std::max(span.bottom, y);
      }
  std::vector<cv::Rect> boxes(spans.size());
  for (std::size_t i = 1; i < spans.size(); ++i)
    boxes[i] = {spans[i].left, spans[i].top, spans[i].right - spans[i].left + 1,
                spans[i].bottom - spans[i].top + 1};
  return boxes;
}

ImageScale scale_for(const cv::Mat3b& picture, const PhotoAnalysisSettings& settings, PhotoAnalysis& out) {
  if (settings.m_per_px) return {*settings.m_per_px, 0};
  if (out.targets.empty())
    throw std::runtime_error(
        "no scale target is found, a magenta disc of at least 10 pixels; give the scale, --scale 1.2cm/px");
  const ImageScale scale = scale_of(out.targets, settings.target_diameter, picture.rows);
  if (!(scale.at(0) > 0 && scale.at(picture.rows) > 0))
    throw std::runtime_error("the targets' sizes differ so much that no even scale fits them; give --scale");
  const double first = settings.target_diameter / out.targets.front().diameter_px,
               last = settings.target_diameter / out.targets.back().diameter_px;
  if (scale.per_row == 0 && std::abs(first / last - 1) > 0.05)
    out.notes.push_back(
        fmt::format("the targets differ by {:.0f} % in size: the mean is taken; lay them at the top and the "
                    "foot of the slope",
                    100 * std::abs(first / last - 1)));
  for (const ScaleTarget& target : out.targets)
    if (target.tilt < 0.9)
      out.notes.push_back(
          fmt::format("a target is seen at an angle (axes 1 : {:.2f}): so is the rock, its outlines "
                      "are shorter in that direction",
                      target.tilt));
  return scale;
}

cv::Rect box_of_region(const cv::Mat3b& picture, const std::vector<cv::Point>& region,
                       std::vector<std::string>& notes) {
  const cv::Rect frame(0, 0, picture.cols, picture.rows);
  if (region.empty()) return frame;
  cv::Rect whole = cv::boundingRect(region);  // reaches one beyond the last corner
  const cv::Rect box = whole & frame;
  if (whole.x < 0 || whole.y < 0 || whole.x + whole.width > frame.width + 1 ||
      whole.y + whole.height > frame.height + 1)
    notes.push_back(
        fmt::format("the region reaches beyond the picture of {} x {} pixels; sections are those of the part "
                    "within",
                    picture.cols, picture.rows));
  if (box.width < 10 || box.height < 10)
    throw std::runtime_error(fmt::format("the region has {} x {} pixels within the picture of {} x {}",
                                         box.width, box.height, picture.cols, picture.rows));
  return box;
}

}  // namespace

int section_of(double y, const cv::Rect& box, int sections) {
  const double down = (y - box.y) / box.height;
  if (!(down >= 0 && down <= 1)) return -1;
  return std::min(static_cast<int>(down * sections), sections - 1);
}

PhotoAnalysis analyse_photo(const cv::Mat3b& picture, const PhotoAnalysisSettings& settings) {
  PhotoAnalysis out;
  cv::Mat1b ignore;
  out.targets = find_targets(picture, ignore);
  out.scale = scale_for(picture, settings, out);
  out.region_box = box_of_region(picture, settings.region, out.notes);
  cv::Mat1b region(picture.size(), static_cast<uchar>(settings.region.empty() ? 255 : 0));
  if (!settings.region.empty()) cv::fillPoly(region, std::vector{settings.region}, 255);
  // What lies outside says nothing of how bright rock is.
  ignore.setTo(255, region == 0);

  const double middle = out.scale.at(out.region_box.y + out.region_box.height / 2.0);
  ForegroundSettings foreground;
  foreground.threshold = settings.threshold;
  foreground.edges = settings.edges;
  foreground.local_window_px = settings.local_window_px;
  foreground.largest_hole_px = settings.detection_area / (middle * middle);
  const Foreground found = find_rock(picture, ignore, foreground);
  out.rock_share = static_cast<double>(cv::countNonZero(found.rock)) / std::max(1, cv::countNonZero(region));
  out.labels = split_grains(found.rock, found.edges, settings.neck);
  if (settings.border_reach > 0)
    out.labels = settle_borders(out.labels, found.grey, ignore, settings.border_reach);

  const std::vector<cv::Rect> boxes = boxes_of(out.labels);
  for (int label = 1; label <= out.labels.count; ++label) {
    const cv::Rect& box = boxes[label];
    const double m_per_px = out.scale.at(box.y + box.height / 2.0);
    if (box.area() * m_per_px * m_per_px < settings.detection_area) {
      ++out.below_limit;
      continue;
    }
    ImageGrain grain;
    grain.label = label;
    grain.m_per_px = m_per_px;
    grain.shape = shape_of(out.labels.of(box) == label);
    grain.shape.x += box.x;
    grain.shape.y += box.y;
    if (grain.shape.area * m_per_px * m_per_px < settings.detection_area) {
      ++out.below_limit;
      continue;
    }
    if (box.x == 0 || box.y == 0 || box.br().x == picture.cols || box.br().y == picture.rows) {
      ++out.cut_by_frame;
      continue;
    }
    grain.section = section_of(grain.shape.y, out.region_box, settings.sections);
    if (grain.section < 0) {
      ++out.outside;
      continue;
    }
    grain.weight = static_cast<double>(picture.cols) * picture.rows /
                   (static_cast<double>(picture.cols - box.width) * (picture.rows - box.height));
    for (std::size_t i = 0; i < grain.size.size(); ++i)
      grain.size[i] = size_of(grain.shape, m_per_px, kSizeModels[i], settings.shape_factor, settings.density);
    out.grains.push_back(grain);
  }
  if (out.grains.empty())
    throw std::runtime_error(
        fmt::format("no grain above the detection limit of {:.3g} cm2 is found ({} outlines below it, {} cut "
                    "by the frame)",
                    1e4 * settings.detection_area, out.below_limit, out.cut_by_frame));
  const double limit_px = std::sqrt(settings.detection_area) / out.scale.at(picture.rows / 2.0);
  if (limit_px < 3)
    out.notes.push_back(
        fmt::format("the detection limit is {:.1f} pixels wide: outlines of so few pixels are coarse; take a "
                    "picture with more",
                    limit_px));
  return out;
}

}  // namespace scree
