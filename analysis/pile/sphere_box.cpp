#include "analysis/pile/sphere_box.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace scree {
namespace {

/// Area under min(y, sqrt(r^2 - t^2)) from t = 0 to x, for y >= 0; odd in x.
double area_below(double x, double y, double r) {
  const auto circle = [r](double t) {
    return 0.5 * (t * std::sqrt(std::max(0.0, r * r - t * t)) + r * r * std::asin(std::min(1.0, t / r)));
  };
  const double to = std::min(std::abs(x), r);
  const double corner = y < r ? std::sqrt(r * r - y * y) : 0.0;
  const double area = to <= corner ? y * to : y * corner + circle(to) - circle(corner);
  return x < 0 ? -area : area;
}

/// Area of the disc of radius r about the origin inside a rectangle.
double disc_in_rectangle(double r, double x0, double x1, double y0, double y1) {
  if (r <= 0) return 0;
  // The column over x reaches from max(y0, -w) to min(y1, w), w = sqrt(r^2 - x^2): the difference of y1 and
  // y0, each held between -w and w.
  const auto held = [&](double y) {
    const double area = area_below(x1, std::abs(y), r) - area_below(x0, std::abs(y), r);
    return y < 0 ? -area : area;
  };
  return std::max(0.0, held(y1) - held(y0));
}

}  // namespace

double sphere_in_box(const Vec3& centre, double radius, const Vec3& low, const Vec3& high) {
  if (!(radius > 0)) throw std::invalid_argument(fmt::format("radius {} m must be above 0", radius));
  if (!(low.array() <= high.array()).all())
    throw std::invalid_argument("the lower corner of the box lies above its upper one");
  const Vec3 a = low - centre, b = high - centre;
  if ((a.array() >= radius).any() || (b.array() <= -radius).any()) return 0;
  if ((a.array() <= -radius).all() && (b.array() >= radius).all())
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;

  // Heights at which the slice's circle reaches a face or an edge of the box: its area has a kink there.
  std::array<double, 18> ends{};
  std::size_t n = 0;
  const double from = std::max(a.z(), -radius), to = std::min(b.z(), radius);
  ends[n++] = from;
  const auto kink = [&](double reach_squared) {
    if (reach_squared >= radius * radius) return;
    const double z = std::sqrt(radius * radius - reach_squared);
    for (const double end : {-z, z})
      if (end > from && end < to) ends[n++] = end;
  };
  for (const double x : {a.x(), b.x()}) kink(x * x);
  for (const double y : {a.y(), b.y()}) kink(y * y);
  for (const double x : {a.x(), b.x()})
    for (const double y : {a.y(), b.y()}) kink(x * x + y * y);
  ends[n++] = to;
  std::sort(ends.begin(), ends.begin() + static_cast<std::ptrdiff_t>(n));

  double volume = 0;
  for (std::size_t k = 1; k < n; ++k) {
    const double middle = 0.5 * (ends[k - 1] + ends[k]), half = 0.5 * (ends[k] - ends[k - 1]);
    if (half <= 1e-15 * radius) continue;
    // At its ends the area goes with a power 3/2 of the distance; z = t (3 - t^2) / 2 makes that smooth.
    volume += boost::math::quadrature::gauss<double, 15>::integrate([&](double t) {
      const double z = middle + half * 0.5 * t * (3 - t * t);
      const double r = std::sqrt(std::max(0.0, radius * radius - z * z));
      return half * 1.5 * (1 - t * t) * disc_in_rectangle(r, a.x(), b.x(), a.y(), b.y());
    });
  }
  return volume;
}

}  // namespace scree
