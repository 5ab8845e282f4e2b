#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "analysis/image/image_tables.h"

namespace scree {
namespace {

/// A section's name in a dark box, its upper left corner at `corner`: over outlines and rock of any colour it
/// can be read, also where a report shows the picture smaller. `room`: pixels from this section to the next.
void write_name(cv::Mat3b& picture, const std::string& name, cv::Point corner, double room) {
  const double letters = std::clamp(picture.cols / 60.0, 10.0, std::max(10.0, 0.5 * room));  // height, pixels
  const double scale = letters / 22;  // of this font, whose capitals are 22 pixels high
  const int thick = std::max(1, static_cast<int>(letters / 8));
  const int edge = std::max(2, static_cast<int>(letters / 3));
  int below = 0;
  const cv::Size size = cv::getTextSize(name, cv::FONT_HERSHEY_SIMPLEX, scale, thick, &below);
  const cv::Rect box(corner, cv::Size(size.width + 2 * edge, size.height + 2 * edge));
  cv::rectangle(picture, box, {30, 30, 30}, cv::FILLED);
  cv::putText(picture, name, corner + cv::Point(edge, edge + size.height), cv::FONT_HERSHEY_SIMPLEX, scale,
              {255, 255, 255}, thick, cv::LINE_AA);
}

}  // namespace

cv::Mat3b overlay(const cv::Mat3b& picture, const PhotoAnalysis& found, int sections, int longest_side) {
  const cv::Scalar blue(255, 160, 0), green(60, 220, 60);
  const double shrink =
      std::min(1.0, static_cast<double>(longest_side) / std::max(picture.cols, picture.rows));
  cv::Mat3b out;
  cv::resize(picture, out, {}, shrink, shrink, cv::INTER_AREA);
  std::vector<char> counted(found.labels.count + 1, 0);
  for (const ImageGrain& grain : found.grains) counted[grain.label] = 1;
  const cv::Mat1i& labels = found.labels.of;
  const auto label_at = [&](int x, int y) {
    const int label = labels(std::min(static_cast<int>(y / shrink), labels.rows - 1),
                             std::min(static_cast<int>(x / shrink), labels.cols - 1));
    return counted[label] ? label : 0;
  };
  for (int y = 0; y + 1 < out.rows; ++y)
    for (int x = 0; x + 1 < out.cols; ++x) {
      const int here = label_at(x, y);
      if (here != label_at(x + 1, y) || here != label_at(x, y + 1)) out(y, x) = {0, 230, 255};
    }
  const int thick = std::max(1, longest_side / 900);
  const cv::Rect& box = found.region.box();
  for (int k = 0; k <= sections; ++k) {
    const int y = static_cast<int>((box.y + static_cast<double>(box.height) * k / sections) * shrink);
    const int left = static_cast<int>(box.x * shrink), right = static_cast<int>(box.br().x * shrink);
    cv::line(out, {left, y}, {right, y}, blue, 2 * thick);
    if (k < sections) write_name(out, fmt::format("S{}", k + 1), {left, y}, box.height * shrink / sections);
  }
  for (const ScaleTarget& target : found.targets)
    cv::circle(out, cv::Point(static_cast<int>(target.x * shrink), static_cast<int>(target.y * shrink)),
               static_cast<int>(target.diameter_px / 2 * shrink) + 3, green, 2 * thick, cv::LINE_AA);
  return out;
}

}  // namespace scree
