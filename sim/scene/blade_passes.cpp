#include "sim/scene/blade_passes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {
namespace {

constexpr double kClear = 0.1;  // m between blade and rock when a pass begins

bool pushed(const Grain& grain, double edge, double end) {
  return grain.position.x() < end && grain.position.z() > edge;
}

}  // namespace

BladeReach reach_of(const TriangleMesh& blade) {
  constexpr double kMost = std::numeric_limits<double>::max();
  BladeReach reach{kMost, -kMost, -kMost};
  for (const Vec3& vertex : blade.vertices) {
    reach.low_y = std::min(reach.low_y, vertex.y());
    reach.high_y = std::max(reach.high_y, vertex.y());
    reach.front = std::max(reach.front, vertex.x());
  }
  return reach;
}

double rock_before_blade(const std::vector<Grain>& grains, double edge, double end) {
  double mass = 0;
  for (const Grain& grain : grains)
    if (pushed(grain, edge, end)) mass += grain.mass;
  return mass;
}

BladePass next_pass(const std::vector<Grain>& grains, const BladeReach& blade, double edge, double end,
                    double half_width) {
  BladePass best;
  const double step = 0.25 * (blade.high_y - blade.low_y);
  const int most = static_cast<int>(2 * half_width / step);
  for (int k = 0; k <= 2 * most; ++k) {
    const double y = step * (k % 2 == 0 ? -(k / 2) : (k + 1) / 2);
    const double low = y + blade.low_y, high = y + blade.high_y;
    if (low < -half_width || high > half_width) continue;
    double mass = 0;
    for (const Grain& grain : grains)
      if (pushed(grain, edge, end) && grain.position.y() > low && grain.position.y() < high)
        mass += grain.mass;
    if (mass > best.mass) best = {y, end, mass};
  }
  for (const Grain& grain : grains) {
    const double r = 0.5 * grain.diameter, beside = grain.position.y() - best.y;
    if (beside > blade.low_y - r && beside < blade.high_y + r && grain.position.z() + r > edge)
      best.start = std::min(best.start, grain.position.x() - r - blade.front - kClear);
  }
  return best;
}

double rock_under(const std::vector<Grain>& grains, double x, double y, const Vec3& box, double ground) {
  double lift = 0;
  for (const Grain& grain : grains) {
    const double r = 0.5 * grain.diameter, before = grain.position.x() - x;
    if (before < r && before > -box.x() - r && std::abs(grain.position.y() - y) < 0.5 * box.y() + r)
      lift = std::max(lift, grain.position.z() + r - ground);
  }
  return lift;
}

double rock_in(const std::vector<Grain>& grains, const std::vector<Eigen::AlignedBox3d>& boxes) {
  double mass = 0;
  for (const Grain& grain : grains)
    if (std::any_of(boxes.begin(), boxes.end(), [&](const Eigen::AlignedBox3d& box) {
          return box.exteriorDistance(grain.position) < 0.5 * grain.diameter;
        }))
      mass += grain.mass;
  return mass;
}

}  // namespace scree
