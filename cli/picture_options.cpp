#include "cli/picture_options.h"

#include <fmt/format.h>

#include <sstream>

#include "cli/option_values.h"

std::optional<std::vector<cv::Point>> polygon_in(const std::string& option, const std::string& text) {
  std::vector<cv::Point> corners;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto at = pair_in(option, word, ',');
    if (!at) return std::nullopt;
    if (!(std::abs(at->first) < 1e6 && std::abs(at->second) < 1e6)) {
      fmt::print(stderr, "{} {}: corners are pixels, at most a million\n", option, text);
      return std::nullopt;
    }
    corners.emplace_back(static_cast<int>(at->first), static_cast<int>(at->second));
  }
  if (corners.size() < 2) {
    fmt::print(stderr, "{} {}: corners in pixels, \"x,y x,y x,y\", or two opposite ones of a rectangle\n",
               option, text);
    return std::nullopt;
  }
  if (corners.size() == 2) {
    const cv::Point a = corners[0], b = corners[1];
    corners = {a, {b.x, a.y}, b, {a.x, b.y}};
  }
  return corners;
}
