#include "sim/material/grading.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sim/material/input_bytes.h"

namespace scree {

namespace {

constexpr std::uintmax_t kMostFileBytes = 1'000'000;
constexpr std::size_t kMostPoints = 10'000;             // a measured curve has some twenty
constexpr double kLeastMm = 1e-3, kMostMm = 1'000'000;  // dust; more than any block

/// Passing at `diameter` between two points of a curve linear in log d.
double passing_between(const Grading::Point& a, const Grading::Point& b, double diameter) {
  return a.passing +
         (b.passing - a.passing) * std::log(diameter / a.diameter) / std::log(b.diameter / a.diameter);
}

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// The number that `text` is, all of it; false when it is none or not finite.
bool parse_number(std::string_view text, double& value) {
  text = trimmed(text);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
}

}  // namespace

Grading::Grading(std::string name, std::vector<Point> points)
    : name_(std::move(name)), points_(std::move(points)) {
  if (points_.size() < 2) throw std::invalid_argument("a grading needs at least two points");
  for (const Point& point : points_) {
    if (!(std::isfinite(point.diameter) && point.diameter > 0))
      throw std::invalid_argument(fmt::format("diameter {} m must be above 0", point.diameter));
    if (!(point.passing >= 0 && point.passing <= 1))
      throw std::invalid_argument(fmt::format("passing {} must be between 0 and 1", point.passing));
  }
  for (std::size_t i = 1; i < points_.size(); ++i) {
    if (!(points_[i].diameter > points_[i - 1].diameter))
      throw std::invalid_argument(fmt::format("diameters must rise: {} m follows {} m", points_[i].diameter,
                                              points_[i - 1].diameter));
    if (!(points_[i].passing > points_[i - 1].passing))
      throw std::invalid_argument(fmt::format("passing must rise: {} at {} m follows {}", points_[i].passing,
                                              points_[i].diameter, points_[i - 1].passing));
  }
  if (points_.front().passing != 0)
    throw std::invalid_argument(
        fmt::format("the smallest diameter must have passing 0, not {}", points_.front().passing));
  if (points_.back().passing != 1)
    throw std::invalid_argument(
        fmt::format("the largest diameter must have passing 1, not {}", points_.back().passing));
}

double Grading::passing(double diameter) const {
  if (diameter <= min_diameter()) return 0;
  if (diameter >= max_diameter()) return 1;
  const auto above = std::upper_bound(points_.begin(), points_.end(), diameter,
                                      [](double d, const Point& point) { return d < point.diameter; });
  return passing_between(*(above - 1), *above, diameter);
}

double Grading::diameter(double passing) const {
  if (!(passing >= 0 && passing <= 1))
    throw std::invalid_argument(fmt::format("passing {} must be between 0 and 1", passing));
  if (passing == 1) return max_diameter();
  const auto above = std::upper_bound(points_.begin(), points_.end(), passing,
                                      [](double p, const Point& point) { return p < point.passing; });
  const Point &a = *(above - 1), &b = *above;
  return a.diameter * std::pow(b.diameter / a.diameter, (passing - a.passing) / (b.passing - a.passing));
}

double Grading::cu() const {
  return diameter(0.60) / diameter(0.10);
}

double Grading::cc() const {
  const double d30 = diameter(0.30);
  return d30 * d30 / (diameter(0.10) * diameter(0.60));
}

double Grading::mean_log_diameter() const {
  double sum = 0;  // exact, as the curve is linear in log d between points
  for (std::size_t i = 1; i < points_.size(); ++i)
    sum += (points_[i].passing - points_[i - 1].passing) * 0.5 *
           std::log10(points_[i].diameter * points_[i - 1].diameter);
  return sum;
}

Grading Grading::scalped(double low, double high) const {
  const double low_passing = passing(low), high_passing = passing(high);
  if (!(low > 0 && low < high && low_passing < high_passing))
    throw std::invalid_argument(
        fmt::format("grading {} has nothing between {} m and {} m", name_, low, high));
  low = std::max(low, min_diameter());
  high = std::min(high, max_diameter());
  std::vector<Point> points{{low, 0}};
  for (const Point& point : points_)
    if (point.diameter > low && point.diameter < high)
      points.push_back({point.diameter, (point.passing - low_passing) / (high_passing - low_passing)});
  points.push_back({high, 1});
  return Grading(name_, std::move(points));
}

Grading Grading::with_fines(double share, double ratio) const {
  if (!(share > 0 && share < 1 && ratio > 1))
    throw std::invalid_argument(
        fmt::format("fines: share {} must be between 0 and 1, ratio {} above 1", share, ratio));
  std::vector<Point> points{{min_diameter() / ratio, 0}};
  for (const Point& point : points_) points.push_back({point.diameter, share + (1 - share) * point.passing});
  return Grading(name_, std::move(points));
}

Grading read_grading(const std::filesystem::path& file) {
  const std::string bytes = read_input_text(file, kMostFileBytes);
  const std::string header = "diameter_mm,passing_pct";
  std::vector<Grading::Point> points;
  int number = 0;
  bool header_seen = false;
  const auto fail = [&](const std::string& what) { throw FileError(file, number, what); };
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    const std::string_view text = trimmed(std::string_view(bytes).substr(at, end - at));
    at = end + 1;
    ++number;
    if (text.empty() || text.front() == '#') continue;
    if (!header_seen) {
      if (text != header) fail(fmt::format("the first line that is no comment must be '{}'", header));
      header_seen = true;
      continue;
    }
    const auto comma = text.find(',');
    double diameter_mm = 0, passing_pct = 0;
    if (comma == std::string_view::npos || !parse_number(text.substr(0, comma), diameter_mm) ||
        !parse_number(text.substr(comma + 1), passing_pct))
      fail(fmt::format("'{:.60}' is not two numbers 'diameter_mm,passing_pct'", text));
    if (diameter_mm <= 0) fail(fmt::format("diameter {} mm must be above 0", diameter_mm));
    if (diameter_mm < kLeastMm || diameter_mm > kMostMm)
      fail(fmt::format("diameter {} mm; allowed {} to {} mm", diameter_mm, kLeastMm, kMostMm));
    if (points.size() == kMostPoints) fail(fmt::format("more than {} points", kMostPoints));
    if (passing_pct < 0 || passing_pct > 100)
      fail(fmt::format("passing {} % must be between 0 and 100", passing_pct));
    if (points.empty() && passing_pct != 0)
      fail(fmt::format("the first (smallest) diameter must have passing 0, not {}", passing_pct));
    if (!points.empty() && diameter_mm / 1000 <= points.back().diameter)
      fail(fmt::format("diameter {} mm must be above the one before", diameter_mm));
    if (!points.empty() && passing_pct / 100 <= points.back().passing)
      fail(fmt::format("passing {} % must be above the one before", passing_pct));
    points.push_back({diameter_mm / 1000, passing_pct / 100});
  }
  ++number;
  if (points.size() < 2) fail("a grading needs at least two points");
  if (points.back().passing != 1) fail("the last (largest) diameter must have passing 100");
  return Grading(file.stem().string(), std::move(points));
}

}  // namespace scree
