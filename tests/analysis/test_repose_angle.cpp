// Repose angle of synthetic cones of known slope.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/pile/repose_angle.h"
#include "sim/material/random.h"

namespace scree {
namespace {

double radians(double degrees) {
  return degrees * std::numbers::pi / 180;
}
double degrees(double radians_) {
  return radians_ * 180 / std::numbers::pi;
}

Grain sphere(double diameter) {
  Grain grain;
  grain.position = grain.velocity = Vec3::Zero();
  grain.diameter = diameter;
  grain.mass = 2760 * std::numbers::pi / 6 * diameter * diameter * diameter;
  return grain;
}

/// Grains of two sizes filling a cone of radius `radius` (m) over z = floor with its axis at (x0, y0):
/// centres on a jittered lattice of spacing 0.75 d, so that neighbours overlap in plan, inside the cone's
/// surface.
std::vector<Grain> cone(double angle, double radius = 0.5, double d = 0.02, double x0 = 0, double y0 = 0,
                        double floor = 0) {
  Random random(7, 0, RandomPurpose::positions);
  std::vector<Grain> heap;
  const double slope = std::tan(radians(angle)), step = 0.75 * d;
  const int n = static_cast<int>(radius / step) + 1;
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = 0; k <= n; ++k) {
        const double size = (i + j + k) % 3 == 0 ? 0.8 * d : d;
        Grain grain = sphere(size);
        grain.position = Vec3((i + random.uniform(-0.03, 0.03)) * step,
                              (j + random.uniform(-0.03, 0.03)) * step, 0.5 * size + k * step);
        if (k * step > slope * (radius - grain.position.head<2>().norm())) continue;
        grain.position += Vec3(x0, y0, floor);
        grain.id = static_cast<std::int64_t>(heap.size());
        heap.push_back(grain);
      }
  return heap;
}

void scatter_runaways(std::vector<Grain>& heap, int count, double from, double to) {
  Random random(8, 0, RandomPurpose::positions);
  for (int i = 0; i < count; ++i) {
    const double r = random.uniform(from, to), a = random.uniform(0, 2 * std::numbers::pi);
    Grain grain = heap.front();
    grain.position = Vec3(r * std::cos(a), r * std::sin(a), 0.5 * grain.diameter);
    heap.push_back(grain);
  }
}

class Cone : public testing::TestWithParam<double> {};

TEST_P(Cone, IsReadWithinAGrain) {
  const double angle = GetParam(), radius = 0.5, d = 0.02;
  const ReposeAngle read = measure_repose(cone(angle));
  EXPECT_NEAR(read.angle, angle, 1.5);
  EXPECT_NEAR(read.flank_height, 0.5 * std::tan(radians(angle)), 0.03);
  // H and R are each known to one grain: d(atan(H / R)) = sin(2 theta) / 2 (dH / H + dR / R).
  const double height = radius * std::tan(radians(angle));
  const double tolerance = degrees(0.5 * std::sin(2 * radians(angle)) * (d / height + d / radius));
  EXPECT_NEAR(read.height, height, d);
  EXPECT_NEAR(read.radius, radius, d);
  EXPECT_NEAR(read.height_over_radius, angle, tolerance);
  // The lattice's own steps (0.75 d) add to where half is covered.
  EXPECT_NEAR(read.half_coverage, angle, 1.5 * tolerance);
  EXPECT_EQ(read.radii[0] > 0 && read.radii[1] > 0 && read.radii[2] > 0 && read.radii[3] > 0, true);
}

TEST_P(Cone, RunawaysDoNotCount) {
  auto heap = cone(GetParam());
  const ReposeAngle alone = measure_repose(heap);
  scatter_runaways(heap, 40, 0.6, 1.5);  // covers 0.2 % of that ring
  const ReposeAngle read = measure_repose(heap);
  EXPECT_EQ(read.runaways, alone.runaways + 40);
  EXPECT_NEAR(read.height_over_radius, alone.height_over_radius, 0.5);
  EXPECT_NEAR(read.half_coverage, alone.half_coverage, 0.5);
  EXPECT_NEAR(read.angle, alone.angle, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Angles, Cone, testing::Values(20.0, 25.0, 30.0, 35.0, 40.0));

TEST(ReposeAngle, AxisAndFloorAreFoundAndSubtracted) {
  const ReposeAngle here = measure_repose(cone(30));
  const ReposeAngle there = measure_repose(cone(30, 0.5, 0.02, 12.3, -4.5, 7.0), 7.0);
  EXPECT_NEAR(there.height, here.height, 1e-9);
  EXPECT_NEAR(there.height_over_radius, here.height_over_radius, 1e-6);
  EXPECT_NEAR(there.angle, here.angle, 0.1);
}

TEST(ReposeAngle, RoundedTopAndThinApronDoNotChangeTheFlank) {
  auto heap = cone(35);
  const double height = 0.5 * std::tan(radians(35));
  std::erase_if(heap, [&](const Grain& grain) { return grain.position.z() > 0.9 * height; });
  Random random(9, 0, RandomPurpose::positions);
  for (int i = 0; i < 5000; ++i) {  // one grain high, from 0.49 to 0.7 m
    const double r = std::sqrt(random.uniform(0.24, 0.49)), a = random.uniform(0, 2 * std::numbers::pi);
    Grain grain = sphere(0.02);
    grain.position = Vec3(r * std::cos(a), r * std::sin(a), 0.01);
    heap.push_back(grain);
  }
  const ReposeAngle read = measure_repose(heap);
  EXPECT_NEAR(read.angle, 35, 1.5);
  EXPECT_LT(read.height_over_radius, read.angle - 3);
}

TEST(ReposeAngle, BlockOnTheTopDoesNotChangeTheFlank) {
  auto heap = cone(35);
  const ReposeAngle before = measure_repose(heap);
  Grain block = sphere(0.12);
  block.position = Vec3(0, 0, before.height);
  heap.push_back(block);
  const ReposeAngle after = measure_repose(heap);
  EXPECT_NEAR(after.angle, before.angle, 1.0);
  EXPECT_GT(after.height_over_radius, before.height_over_radius + 3);
}

TEST(ReposeAngle, DirectionsAreTellApart) {
  auto heap = cone(30);
  for (Grain& grain : heap)  // stretched along +x only
    if (grain.position.x() > 0) grain.position.x() *= 1.1;
  const ReposeAngle read = measure_repose(heap);
  EXPECT_NEAR(read.radii[0], 0.55, 0.03);
  EXPECT_NEAR(read.radii[2], 0.5, 0.03);
}

TEST(ReposeAngle, GrainPerchedOnTheConeIsNotItsTop) {
  auto heap = cone(30);
  const ReposeAngle before = measure_repose(heap);
  Grain perched = heap.front();
  perched.diameter = 0.06;
  perched.position = Vec3(0, 0, before.height + 0.02);
  heap.push_back(perched);
  EXPECT_NEAR(measure_repose(heap).height, before.height, 1e-12);
}

TEST(ReposeAngle, NoRadiusWhereTheAxisLiesInAGap) {
  std::vector<Grain> heap(3, sphere(0.1));
  heap[0].position = Vec3(0, 1, 0.05);  // the median of x is the second's, that of y this one's
  heap[1].position = Vec3(1, 3, 0.05);
  heap[2].position = Vec3(2, 0, 0.05);
  const ReposeAngle read = measure_repose(heap);
  EXPECT_EQ(read.axis[0], 1);
  EXPECT_EQ(read.axis[1], 1);
  for (const double unknown : {read.radius, read.radii[0], read.radii[3], read.runaways, read.height,
                               read.angle, read.height_over_radius, read.half_coverage})
    EXPECT_TRUE(std::isnan(unknown)) << unknown;
}

TEST(ReposeAngle, NothingAndOneGrain) {
  EXPECT_TRUE(std::isnan(measure_repose({}).angle));
  EXPECT_TRUE(std::isnan(measure_repose({}).height_over_radius));
  EXPECT_TRUE(std::isnan(measure_repose({}).runaways));
  Grain grain = sphere(0.1);
  grain.position = Vec3(1, 2, 0.05);
  const ReposeAngle read = measure_repose({grain});
  EXPECT_NEAR(read.height, 0.1, 1e-12);
  EXPECT_NEAR(read.radius, 0.05, 1e-12);
}

}  // namespace
}  // namespace scree
