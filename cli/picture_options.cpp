#include "cli/picture_options.h"

#include <fmt/format.h>

#include <sstream>

#include "analysis/results/output_units.h"
#include "sim/io/input_text.h"

namespace {

constexpr double kLongest = 1e4;  // m, or m/px

std::optional<double> length_of(std::string_view text) {
  const auto unit_at = text.find_first_not_of("0123456789.eE+-");
  if (unit_at == std::string_view::npos) return std::nullopt;
  const auto value = scree::number_in(text.substr(0, unit_at));
  const auto factor = scree::unit_factor(std::string(scree::trimmed(text.substr(unit_at))), "m");
  if (!value || !factor || !(*value > 0) || *value * *factor > kLongest) return std::nullopt;
  return *value * *factor;
}

}  // namespace

std::optional<double> length_in(const std::string& option, const std::string& text) {
  const auto length = length_of(text);
  if (!length)
    fmt::print(stderr, "{} {}: a length above 0 with its unit, like 0.5m, 50cm, 500mm\n", option, text);
  return length;
}

std::optional<double> scale_in(const std::string& option, const std::string& text) {
  const std::string_view given = text;
  const auto slash = given.find("/px");
  const auto length = slash == std::string_view::npos || slash + 3 != given.size()
                          ? std::nullopt
                          : length_of(given.substr(0, slash));
  if (!length) fmt::print(stderr, "{} {}: a length a pixel, like 1.2cm/px or 12mm/px\n", option, text);
  return length;
}

std::optional<std::pair<double, double>> pair_in(const std::string& option, const std::string& text,
                                                 char separator) {
  const std::string_view given = text;
  const auto at = given.find(separator);
  if (at != std::string_view::npos) {
    const auto first = scree::number_in(given.substr(0, at)), second = scree::number_in(given.substr(at + 1));
    if (first && second) return std::pair(*first, *second);
  }
  fmt::print(stderr, "{} {}: two numbers, A{}B\n", option, text, separator);
  return std::nullopt;
}

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
