// Volumes of spheres in boxes against formulae.
#include "analysis/pile/sphere_box.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace scree {
namespace {

constexpr double kR = 0.7;
const double kWhole = 4.0 / 3 * std::numbers::pi * kR * kR * kR;
const Vec3 kFar(9, 9, 9);

TEST(SphereBox, WholeHalfQuarterEighthNone) {
  const Vec3 c(1, -2, 0.5);
  EXPECT_NEAR(sphere_in_box(c, kR, c - kFar, c + kFar), kWhole, 1e-12);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 low = c - kFar;
    low[axis] = c[axis];
    EXPECT_NEAR(sphere_in_box(c, kR, low, c + kFar), kWhole / 2, 1e-8 * kWhole);
    low[(axis + 1) % 3] = c[(axis + 1) % 3];
    EXPECT_NEAR(sphere_in_box(c, kR, low, c + kFar), kWhole / 4, 1e-8 * kWhole);
  }
  EXPECT_NEAR(sphere_in_box(c, kR, c, c + kFar), kWhole / 8, 1e-8 * kWhole);
  EXPECT_EQ(sphere_in_box(c, kR, c + Vec3(kR, 0, 0), c + kFar), 0);
}

TEST(SphereBox, CapsAlongEachAxis) {
  for (const double h : {0.01, 0.2, 0.9, 1.3}) {  // V = pi h^2 (3 r - h) / 3
    const double cap = std::numbers::pi * h * h * (3 * kR - h) / 3;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 low = -kFar;
      low[axis] = kR - h;
      EXPECT_NEAR(sphere_in_box(Vec3::Zero(), kR, low, kFar), cap, 1e-8 * kWhole);
    }
  }
}

TEST(SphereBox, ABoxInsideTheSphereIsItsOwnVolume) {
  const Vec3 half(0.3, 0.4, 0.35);  // corner at 0.61 of the centre
  EXPECT_NEAR(sphere_in_box(Vec3::Zero(), kR, -half, half), 8 * 0.3 * 0.4 * 0.35, 1e-8 * kWhole);
}

TEST(SphereBox, CellsOfALatticeAddUpToTheSphere) {
  const Vec3 c(0.137, 0.411, -0.293);
  for (const double cell : {0.23, 0.5, 1.1}) {
    double sum = 0;
    const int n = static_cast<int>(std::ceil(1.5 / cell)) + 1;
    for (int i = -n; i < n; ++i)
      for (int j = -n; j < n; ++j)
        for (int k = -n; k < n; ++k)
          sum += sphere_in_box(c, kR, cell * Vec3(i, j, k), cell * Vec3(i + 1, j + 1, k + 1));
    EXPECT_NEAR(sum, kWhole, 1e-8 * kWhole) << cell;
  }
}

TEST(SphereBox, RefusesWhatIsNoSphereOrBox) {
  EXPECT_THROW(sphere_in_box(Vec3::Zero(), 0, -kFar, kFar), std::invalid_argument);
  EXPECT_THROW(sphere_in_box(Vec3::Zero(), 1, kFar, -kFar), std::invalid_argument);
}

}  // namespace
}  // namespace scree
