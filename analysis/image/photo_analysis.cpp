#include "analysis/image/photo_analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace scree {
namespace {

// Where a label is.
struct Outline {
  cv::Rect box;
  bool within = false, beyond = false;  // the region, in part at least
};

// Of all labels, in one go.
std::vector<Outline> outlines_of(const Labels& labels, const PhotoRegion& region) {
  std::vector<Outline> outlines(labels.count + 1);
  std::vector<cv::Point> low(outlines.size(), {labels.of.cols, labels.of.rows}),
      high(outlines.size(), {-1, -1});
  for (int y = 0; y < labels.of.rows; ++y)
    for (int x = 0; x < labels.of.cols; ++x)
      if (const int label = labels.of(y, x); label > 0) {
        low[label] = {std::min(low[label].x, x), std::min(low[label].y, y)};
        high[label] = {std::max(high[label].x, x), std::max(high[label].y, y)};
        (region.mask()(y, x) != 0 ? outlines[label].within : outlines[label].beyond) = true;
      }
  for (std::size_t i = 1; i < outlines.size(); ++i) outlines[i].box = {low[i], high[i] + cv::Point(1, 1)};
  return outlines;
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

PhotoRegion region_of(const cv::Mat3b& picture, const std::vector<cv::Point>& polygon,
                      std::vector<std::string>& notes) {
  PhotoRegion region(picture.size(), polygon);
  if (polygon.empty()) return region;
  const cv::Rect whole = cv::boundingRect(polygon);  // reaches one beyond the last corner
  if (whole.x < 0 || whole.y < 0 || whole.br().x > picture.cols + 1 || whole.br().y > picture.rows + 1)
    notes.push_back(
        fmt::format("the region reaches beyond the picture of {} x {} pixels; sections are those of the part "
                    "within",
                    picture.cols, picture.rows));
  return region;
}

}  // namespace

int section_of(double y, const PhotoRegion& region, int sections) {
  const double down = (y - region.box().y) / region.box().height;
  return std::clamp(static_cast<int>(down * sections), 0, sections - 1);
}

PhotoAnalysis analyse_photo(const cv::Mat3b& picture, const PhotoAnalysisSettings& settings) {
  PhotoAnalysis out;
  cv::Mat1b ignore;
  out.targets = find_targets(picture, ignore);
  out.scale = scale_for(picture, settings, out);
  out.region = region_of(picture, settings.region, out.notes);
  const cv::Mat1b& region = out.region.mask();
  const double middle = out.scale.at(out.region.middle_y());
  ForegroundSettings foreground;
  foreground.threshold = settings.threshold;
  foreground.edges = settings.edges;
  foreground.local_window_px = settings.local_window_px;
  foreground.largest_hole_px = settings.detection_area / (middle * middle);
  const Foreground found = find_rock(picture, ignore, region, foreground);
  out.rock_share =
      static_cast<double>(cv::countNonZero(found.rock & region)) / std::max(1, cv::countNonZero(region));
  out.labels = split_grains(found.rock, found.edges, settings.neck);
  if (settings.border_reach > 0)
    out.labels = settle_borders(out.labels, found.grey, ignore, settings.border_reach);

  const std::vector<Outline> outlines = outlines_of(out.labels, out.region);
  for (int label = 1; label <= out.labels.count; ++label) {
    if (!outlines[label].within) continue;
    const cv::Rect& box = outlines[label].box;
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
    if (outlines[label].beyond || box.x == 0 || box.y == 0 || box.br().x == picture.cols ||
        box.br().y == picture.rows) {
      out.cut.push_back(label);
      continue;
    }
    grain.section = section_of(grain.shape.y, out.region, settings.sections);
    grain.weight = out.region.weight({box.size(), grain.shape.feret_max, grain.shape.feret_min},
                                     settings.rock_within_frame);
    for (std::size_t i = 0; i < grain.size.size(); ++i)
      grain.size[i] = size_of(grain.shape, m_per_px, kSizeModels[i], settings.shape_factor, settings.density);
    out.grains.push_back(grain);
  }
  if (out.grains.empty())
    throw std::runtime_error(
        fmt::format("no grain above the detection limit of {:.3g} cm2 is found ({} outlines below it, {} cut "
                    "by the border)",
                    1e4 * settings.detection_area, out.below_limit, out.cut.size()));
  const double limit_px = std::sqrt(settings.detection_area) / out.scale.at(picture.rows / 2.0);
  if (limit_px < 3)
    out.notes.push_back(
        fmt::format("the detection limit is {:.1f} pixels wide: outlines of so few pixels are coarse; take a "
                    "picture with more",
                    limit_px));
  return out;
}

}  // namespace scree
