#include "analysis/pile/surface_height.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace scree {

SurfaceHeight::SurfaceHeight(const std::vector<Grain>& pile, double y_low, double y_high, double pitch)
    : y0_(y_low), pitch_x_(pitch) {
  if (!(pitch > 0)) throw std::invalid_argument("the pitch of a surface must be above 0");
  if (!(y_low < y_high)) throw std::invalid_argument("the band of a surface must have a width");
  rows_ = std::lround(std::ceil((y_high - y_low) / pitch - 1e-9));
  pitch_y_ = (y_high - y_low) / static_cast<double>(rows_);
  double left = INFINITY, right = -INFINITY;
  for (const Grain& grain : pile) {
    const double reach = grain.diameter / std::numbers::sqrt2;
    left = std::min(left, grain.position.x() - reach), right = std::max(right, grain.position.x() + reach);
  }
  if (!(left < right)) return;
  x0_ = std::floor(left / pitch) * pitch;
  columns_ = std::lround(std::ceil((right - x0_) / pitch));
  heights_.assign(static_cast<std::size_t>(columns_ * rows_), std::numeric_limits<double>::lowest());

  for (const Grain& grain : pile) {
    const double r = grain.diameter / 2, reach = r * std::numbers::sqrt2;
    const auto first = [&](double from, double origin, double step) {
      return std::max(0L, std::lround(std::ceil((from - origin) / step - 0.5)));
    };
    const auto last = [&](double to, double origin, double step, long n) {
      return std::min(n - 1, std::lround(std::floor((to - origin) / step - 0.5)));
    };
    const double x = grain.position.x(), y = grain.position.y();
    const long i1 = last(x + reach, x0_, pitch_x_, columns_), j1 = last(y + reach, y0_, pitch_y_, rows_);
    for (long i = first(x - reach, x0_, pitch_x_); i <= i1; ++i)
      for (long j = first(y - reach, y0_, pitch_y_); j <= j1; ++j) {
        const double dx = x0_ + (static_cast<double>(i) + 0.5) * pitch_x_ - x;
        const double dy = y0_ + (static_cast<double>(j) + 0.5) * pitch_y_ - y;
        const double off = dx * dx + dy * dy;
        if (off > reach * reach) continue;
        double& height = heights_[static_cast<std::size_t>(i * rows_ + j)];
        height = std::max(height, grain.position.z() + std::sqrt(std::max(0.0, r * r - off)));
      }
  }
}

// Indices of the columns there, the last excluded; some may lie beyond the rock.
std::pair<long, long> SurfaceHeight::columns(double x_low, double x_high) const {
  return {std::lround(std::ceil((x_low - x0_) / pitch_x_ - 0.5)),
          std::lround(std::ceil((x_high - x0_) / pitch_x_ - 0.5))};
}

double SurfaceHeight::share_above(double x_low, double x_high, double height) const {
  const auto [from, to] = columns(x_low, x_high);
  if (to <= from) return 0;
  long above = 0;
  for (long i = std::max(0L, from); i < std::min(to, columns_); ++i)
    for (long j = 0; j < rows_; ++j) above += heights_[static_cast<std::size_t>(i * rows_ + j)] >= height;
  return static_cast<double>(above) / static_cast<double>((to - from) * rows_);
}

std::optional<double> SurfaceHeight::reached_by(double x_low, double x_high, double share) const {
  const auto [from, to] = columns(x_low, x_high);
  std::vector<double> heights;
  for (long i = std::max(0L, from); i < std::min(to, columns_); ++i)
    for (long j = 0; j < rows_; ++j)
      if (const double z = heights_[static_cast<std::size_t>(i * rows_ + j)];
          z > std::numeric_limits<double>::lowest())
        heights.push_back(z);
  const auto needed = std::lround(std::ceil(share * static_cast<double>((to - from) * rows_)));
  if (needed < 1 || static_cast<long>(heights.size()) < needed) return std::nullopt;
  const auto at = heights.begin() + needed - 1;
  std::nth_element(heights.begin(), at, heights.end(), std::greater<>());
  return *at;
}

}  // namespace scree
