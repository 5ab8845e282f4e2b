// Readings of the repose angle.
//
// The angle is the slope of the heap's surface, seen from above and averaged over all directions: a straight
// line is fitted between 20 and 80 % of the height that this averaged surface has at the axis. It needs no
// decision where a heap ends, and no single block on its top moves it.
//
// The thesis describes atan(H / R): H the top of the cone, R the mean over four directions of the distance
// from the centre to where particles no longer overlap, runaways left out. Here: a ray from the axis in each
// direction leaves the heap at the first gap between grains. (A strip as wide as the largest grain follows
// single grains out of the heap and reads 3 to 7 degrees less.)
#include "analysis/pile/repose_angle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace scree {

namespace {

constexpr double kAxisShare = 0.1;  // of R, about the axis, over which the surface's height there is averaged
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double degrees(double radians) {
  return radians * 180 / std::numbers::pi;
}

double weighted_median(const std::vector<Grain>& heap, int axis) {
  std::vector<const Grain*> order;
  double total = 0;
  for (const Grain& grain : heap) {
    order.push_back(&grain);
    total += grain.mass;
  }
  std::sort(order.begin(), order.end(),
            [axis](const Grain* a, const Grain* b) { return a->position[axis] < b->position[axis]; });
  double sum = 0;
  for (const Grain* grain : order) {
    sum += grain->mass;
    if (sum >= 0.5 * total) return grain->position[axis];
  }
  return order.back()->position[axis];
}

/// A grain in plan, the axis of the heap at the origin.
struct Circle {
  double x, y, radius;
};

/// How far from the axis the ray in direction (ux, uy) stays over grains: to the first gap between their
/// circles.
double reach(const std::vector<Circle>& circles, double ux, double uy) {
  std::vector<std::array<double, 2>> covered;  // from, to
  for (const Circle& c : circles) {
    const double along = c.x * ux + c.y * uy, across = c.x * uy - c.y * ux;
    if (std::abs(across) >= c.radius) continue;
    const double half = std::sqrt(c.radius * c.radius - across * across);
    if (along + half > 0) covered.push_back({along - half, along + half});
  }
  std::sort(covered.begin(), covered.end());
  double farthest = 0;
  for (const auto& [from, to] : covered) {
    if (from > farthest) break;
    farthest = std::max(farthest, to);
  }
  return farthest;
}

/// Radius of the heap at an angle, linear between the four directions.
double radius_at(const double (&radii)[4], double x, double y) {
  double quarter = std::atan2(y, x) / (0.5 * std::numbers::pi);
  if (quarter < 0) quarter += 4;
  const int k = std::min(static_cast<int>(quarter), 3);
  return radii[k] + (quarter - k) * (radii[(k + 1) % 4] - radii[k]);
}

/// Highest point of the cone over the floor. A grain perched on the heap, more than its own radius higher
/// than any other, is not the cone's top.
double top_of(const std::vector<const Grain*>& grains, double floor) {
  std::vector<std::array<double, 2>> tops;  // height, radius
  for (const Grain* grain : grains)
    tops.push_back({grain->position.z() + 0.5 * grain->diameter - floor, 0.5 * grain->diameter});
  std::sort(tops.rbegin(), tops.rend());
  for (std::size_t i = 0; i + 1 < tops.size(); ++i)
    if (tops[i][0] - tops[i + 1][0] <= tops[i][1]) return tops[i][0];
  return tops.empty() ? nan : tops.back()[0];
}

/// Rings about the axis: mean height of what is seen from above, and covered share of the plan area.
struct Rings {
  double width = 0;
  std::vector<double> height, covered;
  double centre(std::size_t k) const { return (static_cast<double>(k) + 0.5) * width; }
};

Rings rings_of(const std::vector<Grain>& heap, double x0, double y0, double floor, double extent) {
  constexpr int half = 400;  // cells from the axis to `extent`
  constexpr int rings = 80;
  constexpr int side = 2 * half;
  const double cell = extent / half;
  std::vector<double> top(static_cast<std::size_t>(side) * side, -1.0);  // m over the floor; -1: floor seen
  const auto centre = [cell](int i) { return (i - half + 0.5) * cell; };
  const auto first_cell = [cell](double x) { return static_cast<int>(std::ceil(x / cell + half - 0.5)); };
  for (const Grain& grain : heap) {
    const double x = grain.position.x() - x0, y = grain.position.y() - y0, r = 0.5 * grain.diameter;
    if (!(std::abs(x) < extent + r && std::abs(y) < extent + r)) continue;
    const int j_end = std::min(side, first_cell(y + r)), i_end = std::min(side, first_cell(x + r));
    for (int j = std::max(0, first_cell(y - r)); j < j_end; ++j)
      for (int i = std::max(0, first_cell(x - r)); i < i_end; ++i) {
        const double dx = centre(i) - x, dy = centre(j) - y, rest = r * r - dx * dx - dy * dy;
        if (rest < 0) continue;
        double& here = top[static_cast<std::size_t>(j) * side + i];
        here = std::max({here, 0.0, grain.position.z() - floor + std::sqrt(rest)});
      }
  }
  Rings result;
  result.width = extent / rings;
  result.height.assign(rings, 0);
  result.covered.assign(rings, 0);
  std::vector<int> cells(rings, 0);
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const auto k = static_cast<int>(std::hypot(centre(i), centre(j)) / result.width);
      if (k >= rings) continue;
      const double here = top[static_cast<std::size_t>(j) * side + i];
      ++cells[k];
      if (here < 0) continue;
      result.height[k] += here;
      result.covered[k] += 1;
    }
  for (int k = 0; k < rings; ++k) {
    result.height[k] /= std::max(cells[k], 1);
    result.covered[k] /= std::max(cells[k], 1);
  }
  return result;
}

/// First radius, from the axis outwards, where `values` (one a ring) falls below `level`; linear between ring
/// centres.
double falls_below(const Rings& rings, const std::vector<double>& values, double level) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (values[k] >= level) continue;
    if (k == 0) return 0;
    const double t = (values[k - 1] - level) / (values[k - 1] - values[k]);
    return rings.centre(k - 1) + t * rings.width;
  }
  return nan;
}

/// Mean height of the surface within `radius` (one ring at least).
double height_within(const Rings& rings, double radius) {
  double area = 0, volume = 0;
  for (std::size_t k = 0; k < rings.height.size() && (k == 0 || rings.centre(k) < radius); ++k) {
    area += rings.centre(k);
    volume += rings.centre(k) * rings.height[k];
  }
  return volume / area;
}

/// The least-squares line through the rings between 80 % and 20 % of `height`: its fall over its length, and
/// its height at the axis.
std::array<double, 2> fitted_flank(const Rings& rings, double height) {
  const double inner = falls_below(rings, rings.height, 0.8 * height);
  const double outer = falls_below(rings, rings.height, 0.2 * height);
  double n = 0, sx = 0, sz = 0, sxx = 0, sxz = 0;
  for (std::size_t k = 0; k < rings.height.size(); ++k) {
    const double x = rings.centre(k), z = rings.height[k];
    if (!(x >= inner && x <= outer)) continue;
    n += 1;
    sx += x;
    sz += z;
    sxx += x * x;
    sxz += x * z;
  }
  if (n < 2) return {nan, nan};
  const double rise = (n * sxz - sx * sz) / (n * sxx - sx * sx);
  return {-rise, (sz - rise * sx) / n};
}

}  // namespace

ReposeAngle measure_repose(const std::vector<Grain>& heap, double floor) {
  ReposeAngle result;
  result.angle = result.height_over_radius = result.half_coverage = result.flank_height = nan;
  result.height = result.radius = result.runaways = nan;
  std::fill(std::begin(result.radii), std::end(result.radii), nan);
  if (heap.empty()) return result;
  const double x0 = weighted_median(heap, 0), y0 = weighted_median(heap, 1);
  result.axis[0] = x0, result.axis[1] = y0;
  std::vector<Circle> circles;
  for (const Grain& grain : heap)
    circles.push_back({grain.position.x() - x0, grain.position.y() - y0, 0.5 * grain.diameter});
  constexpr std::array<std::array<double, 2>, 4> directions{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  double radii[4];
  for (int k = 0; k < 4; ++k) radii[k] = reach(circles, directions[k][0], directions[k][1]);
  const double longest = *std::max_element(std::begin(radii), std::end(radii));
  if (!(longest > 0)) return result;  // the axis lies in a gap: where the heap ends is not known
  std::copy(std::begin(radii), std::end(radii), std::begin(result.radii));
  result.radius = std::accumulate(std::begin(radii), std::end(radii), 0.0) / 4;

  result.runaways = 0;
  std::vector<const Grain*> inside;
  for (std::size_t i = 0; i < heap.size(); ++i) {
    const bool runaway =
        std::hypot(circles[i].x, circles[i].y) > radius_at(result.radii, circles[i].x, circles[i].y);
    runaway ? void(++result.runaways) : inside.push_back(&heap[i]);
  }
  result.height = top_of(inside, floor);
  result.height_over_radius = degrees(std::atan2(result.height, result.radius));

  const Rings rings = rings_of(heap, x0, y0, floor, 1.5 * longest);
  result.half_coverage = degrees(std::atan2(result.height, falls_below(rings, rings.covered, 0.5)));
  const auto [fall, at_axis] = fitted_flank(rings, height_within(rings, kAxisShare * result.radius));
  result.angle = degrees(std::atan(fall));
  result.flank_height = at_axis;
  result.surface = rings.height;
  result.surface_step = rings.width;
  return result;
}

}  // namespace scree
