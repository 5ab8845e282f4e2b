// A half cone with known cells.
#include "analysis/pile/half_cone.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace scree {
namespace {

constexpr double kHeight = 0.3, kRadius = 0.6;  // m; 26.6 degrees

/// Grains of `d` on a lattice inside the half cone x > 0; what lies in each cell has its own size, coarser
/// outwards.
std::vector<Grain> half_cone() {
  constexpr double step = 0.012;
  std::vector<Grain> heap;
  for (double x = step / 2; x < kRadius; x += step)
    for (double y = -kRadius; y < kRadius; y += step)
      for (double z = step / 2; z < kHeight; z += step) {
        const double r = std::hypot(x, y);
        if (z / kHeight + r / kRadius > 1) continue;
        Grain grain;
        grain.position = Vec3(x, y, z);
        grain.velocity = Vec3::Zero();
        const bool top = z > kHeight * 2 / 3, middle = !top && z > kHeight / 3 && r > kRadius / 3;
        const bool bottom = z <= kHeight / 3 && r > kRadius * 2 / 3;
        grain.diameter = top ? 0.014 : middle ? 0.016 : bottom ? 0.020 : 0.015;
        grain.mass = 2760 * std::numbers::pi / 6 * std::pow(grain.diameter, 3);
        grain.id = static_cast<std::int64_t>(heap.size());
        heap.push_back(grain);
      }
  return heap;
}

TEST(HalfCone, ThreeCellsOfItsSurface) {
  const std::vector<Grain> heap = half_cone();
  const HalfCone cone = analyse_half_cone(heap, heap);
  EXPECT_NEAR(cone.shape.angle, std::atan(kHeight / kRadius) * 180 / std::numbers::pi, 1.5);
  ASSERT_EQ(cone.surface.sections.size(), 3u);
  const char* names[] = {"top", "middle", "bottom"};
  const double sizes[] = {0.014, 0.016, 0.020};
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(cone.surface.sections[k].name, names[k]);
    EXPECT_NEAR(cone.surface.sections[k].d50, sizes[k], 1e-9);
  }
  EXPECT_LT(cone.surface.sections[0].chi, 0);
  EXPECT_GT(cone.surface.sections[2].chi, 0);
  double inside = cone.surface.mass_outside, whole = 0;
  for (const Section& section : cone.surface.sections) inside += section.mass;
  for (const Grain& grain : heap) whole += grain.mass;
  EXPECT_NEAR(inside, whole, 1e-9);
}

TEST(HalfCone, StonesThatRolledAwayBelongToNoCell) {
  std::vector<Grain> heap = half_cone();
  const HalfCone before = analyse_half_cone(heap, heap);
  Grain stray = heap.front();
  stray.position = Vec3(1.2, 0.1, 0.02);
  stray.diameter = 0.04;
  stray.mass = 0.1;
  heap.push_back(stray);
  const HalfCone after = analyse_half_cone(heap, heap);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(after.surface.sections[k].grains, before.surface.sections[k].grains, 5);
  EXPECT_GE(after.surface.mass_outside, before.surface.mass_outside + 0.09);
  EXPECT_THROW(analyse_half_cone({}, heap), std::invalid_argument);
}

}  // namespace
}  // namespace scree
