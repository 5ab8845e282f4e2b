#include "analysis/pile/slope_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "analysis/pile/mass_quantile.h"
#include "analysis/pile/surface_height.h"

namespace scree {
namespace {

constexpr double kHalfBand = 4;  // m, most of it: half a truck bed
constexpr double kReach = 20;    // heights from the crest beyond which nothing belongs to its slope
constexpr double kGap = 1.5;     // places from one to the next between which the surface ends

}  // namespace

std::vector<std::array<double, 2>> slope_profile(const std::vector<Grain>& pile, double height) {
  if (!(height > 0)) throw std::invalid_argument("a slope must have a height above 0");
  std::vector<Grain> near;
  std::vector<WeighedValue> across;
  double largest = 0, left = INFINITY, right = -INFINITY;
  for (const Grain& grain : pile) {
    if (std::abs(grain.position.x()) > kReach * height) continue;
    near.push_back(grain);
    across.push_back({grain.position.y(), grain.mass});
    largest = std::max(largest, grain.diameter);
    left = std::min(left, grain.position.x()), right = std::max(right, grain.position.x());
  }
  if (near.empty()) return {};
  const double middle = mass_quantile(std::move(across), 0.5);
  const double half_band = std::max(std::min(height / 5, kHalfBand), 1.5 * largest),
               bin = std::max(height / 20, largest / 10);
  const SurfaceHeight surface(near, middle - half_band, middle + half_band, bin);
  std::vector<std::array<double, 2>> profile;
  const auto last = std::lround(std::floor((right + largest) / bin));
  for (auto k = std::lround(std::floor((left - largest) / bin)); k <= last; ++k) {
    const double from = static_cast<double>(k) * bin;
    if (const auto z = surface.reached_by(from, from + bin, 0.5)) profile.push_back({from + 0.5 * bin, *z});
  }
  return profile;
}

std::optional<SlopeLine> slope_line(const std::vector<std::array<double, 2>>& profile, double height) {
  if (profile.size() < 2) return std::nullopt;
  double step = INFINITY;
  for (std::size_t k = 1; k < profile.size(); ++k) step = std::min(step, profile[k][0] - profile[k - 1][0]);
  // From the last place at the crest's height, or from the highest where the pile does not come up to it.
  auto crest = std::max_element(profile.begin(), profile.end(),
                                [](const auto& a, const auto& b) { return a[1] < b[1]; });
  for (auto at = profile.begin(); at != profile.end(); ++at)
    if ((*at)[1] > kSlopeHigh * height) crest = at;

  double n = 0, sx = 0, sz = 0, sxx = 0, sxz = 0;
  for (auto at = crest; at != profile.end() && (*at)[1] >= kSlopeLow * height; ++at) {
    const auto [x, z] = *at;
    if (at != crest && x - (*(at - 1))[0] > kGap * step) break;
    if (z > kSlopeHigh * height) continue;
    n += 1, sx += x, sz += z, sxx += x * x, sxz += x * z;
  }
  const double spread = n * sxx - sx * sx;
  if (n < 4 || spread <= 0) return std::nullopt;
  return SlopeLine{-std::atan((n * sxz - sx * sz) / spread) * 180.0 / std::numbers::pi, sx / n, sz / n};
}

double cover_on_face(const std::vector<std::array<double, 2>>& profile, const BenchOutline& bench) {
  double sum = 0;
  int places = 0;
  for (const auto& [x, z] : profile) {
    if (x < 0 || x > bench.toe() || z < kSlopeLow * bench.height || z > kSlopeHigh * bench.height) continue;
    sum += (z - bench.ground(x)) * std::cos(bench.slope_deg * std::numbers::pi / 180);
    ++places;
  }
  return places > 0 ? sum / places : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace scree
