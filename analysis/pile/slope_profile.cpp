#include "analysis/pile/slope_profile.h"

#include <cmath>
#include <map>
#include <numbers>

namespace scree {

std::vector<std::array<double, 2>> slope_profile(const std::vector<Grain>& pile, double half_band,
                                                 double bin) {
  std::map<long, double> top;
  for (const Grain& g : pile) {
    if (std::abs(g.position.y()) > half_band) continue;
    const auto [at, fresh] = top.try_emplace(std::lround(std::floor(g.position.x() / bin)), -1e300);
    at->second = std::max(at->second, g.position.z() + 0.5 * g.diameter);
  }
  std::vector<std::array<double, 2>> profile;
  for (const auto& [k, z] : top) profile.push_back({(static_cast<double>(k) + 0.5) * bin, z});
  return profile;
}

std::optional<double> slope_angle(const std::vector<std::array<double, 2>>& profile, double height) {
  double n = 0, sx = 0, sz = 0, sxx = 0, sxz = 0;
  for (const auto& [x, z] : profile) {
    if (z < 0.15 * height || z > 0.85 * height) continue;
    n += 1, sx += x, sz += z, sxx += x * x, sxz += x * z;
  }
  const double spread = n * sxx - sx * sx;
  if (n < 4 || spread <= 0) return std::nullopt;
  return -std::atan((n * sxz - sx * sz) / spread) * 180.0 / std::numbers::pi;
}

}  // namespace scree
