#include "analysis/image/slope_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "analysis/pile/slope_profile.h"

namespace scree {
namespace {

constexpr int kLeastHeight = 10;  // px, of a PhotoRegion

std::optional<PileSlope> slope_below(const std::vector<std::array<double, 2>>& profile, double fitted_to,
                                     double crest) {
  const auto line = slope_line(profile, fitted_to);
  if (!line || !(line->angle > 0)) return std::nullopt;
  const double fall = std::tan(line->angle * std::numbers::pi / 180);
  return PileSlope{line->angle, line->x - (crest - line->z) / fall, crest, line->x + line->z / fall};
}

}  // namespace

std::optional<PileSlope> slope_of_pile(const std::vector<Grain>& pile, std::optional<double> bench_height) {
  if (bench_height)
    if (const auto slope = slope_below(slope_profile(pile, *bench_height), *bench_height, *bench_height))
      return slope;
  double top = 0;
  for (const Grain& grain : pile) top = std::max(top, grain.position.z());
  if (!(top > 0)) return std::nullopt;
  const auto profile = slope_profile(pile, top);
  double surface = 0;
  for (const auto& [x, z] : profile) surface = std::max(surface, z);
  return slope_below(profile, top, bench_height.value_or(surface));
}

std::optional<std::array<int, 4>> slope_region(const RockScene& scene, const PileSlope& slope,
                                               double m_per_px) {
  const double angle = scene.slope_deg * std::numbers::pi / 180;
  const auto row = [&](double x, double z) {
    const double down = x * std::cos(angle) - z * std::sin(angle) + scene.origin_down;
    return static_cast<int>(std::lround(std::clamp(down, 0.0, scene.height) / m_per_px));
  };
  const int top = row(slope.crest_x, slope.crest_z), bottom = row(slope.toe_x, 0) - 1;
  if (bottom - top < kLeastHeight) return std::nullopt;
  return std::array{0, top, static_cast<int>(std::lround(scene.width / m_per_px)) - 1, bottom};
}

std::string region_text(const std::array<int, 4>& corners) {
  return fmt::format("{},{} {},{}", corners[0], corners[1], corners[2], corners[3]);
}

}  // namespace scree
