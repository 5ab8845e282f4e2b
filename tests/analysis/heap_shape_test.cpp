// Rings, form and runout of heaps whose shape is known.
#include "analysis/pile/heap_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "analysis/results/outputs.h"
#include "sim/material/random.h"

namespace scree {
namespace {

constexpr double kPi = std::numbers::pi;

double volume_of(double diameter) {
  return kPi / 6 * diameter * diameter * diameter;
}

// Grains with centres evenly in a cone of radius R and height H over z = 0; `diameter(r)` by distance from
// the axis at (x0, y0).
template <typename Diameter>
std::vector<Grain> cone(double radius, double height, int count, Diameter diameter, double x0 = 0,
                        double y0 = 0) {
  Random random(11, 0, RandomPurpose::positions);
  std::vector<Grain> heap;
  while (static_cast<int>(heap.size()) < count) {
    const double x = random.uniform(-radius, radius), y = random.uniform(-radius, radius),
                 z = random.uniform(0, height), r = std::hypot(x, y);
    if (z > height * (1 - r / radius)) continue;
    Grain grain;
    grain.id = static_cast<std::int64_t>(heap.size());
    grain.diameter = diameter(r);
    grain.position = Vec3(x + x0, y + y0, z);
    grain.mass = 2760 * volume_of(grain.diameter);
    grain.dump = 1;
    heap.push_back(grain);
  }
  return heap;
}

// What measure_repose would say of a perfect cone.
ReposeAngle perfect(double radius, double height, double x0 = 0, double y0 = 0) {
  ReposeAngle read;
  read.radius = radius;
  read.height = height;
  read.axis[0] = x0, read.axis[1] = y0;
  read.surface_step = radius / 50;
  for (int k = 0; k < 60; ++k)
    read.surface.push_back(std::max(0.0, height * (1 - (k + 0.5) * read.surface_step / radius)));
  return read;
}

TEST(HeapShape, ConeHasItsRingsFormAndRunout) {
  const double radius = 0.6, height = 0.3, d = 0.01;
  const auto heap = cone(
      radius, height, 20000, [&](double) { return d; }, 3, -2);
  const HeapShape shape = measure_heap_shape(heap, heap, perfect(radius, height, 3, -2));
  // Mass within r of a cone: 3 s^2 - 2 s^3, s = r / R; at thirds 7/27 and 20/27.
  EXPECT_NEAR(shape.mass_share[0], 7.0 / 27, 0.01);
  EXPECT_NEAR(shape.mass_share[1], 13.0 / 27, 0.01);
  EXPECT_NEAR(shape.mass_share[2], 7.0 / 27, 0.01);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(shape.profile[k], 1 - kProfilePlaces[k], 1e-12);
  // 3 s^2 - 2 s^3 = 0.95 at s = 0.8646.
  EXPECT_NEAR(shape.spread_95, 0.8646 * radius / std::cbrt(20000 * volume_of(d)), 0.01);
  // One size: nothing to segregate.
  EXPECT_TRUE(std::isnan(shape.rings.sections[0].chi));
  EXPECT_EQ(shape.rings.sections[2].d50_rel, 1);
}

TEST(HeapShape, CoarseRimShowsInTheOuterRing) {
  const double radius = 0.6;
  const auto heap = cone(radius, 0.3, 5000, [&](double r) { return r > radius * 2 / 3 ? 0.02 : 0.01; });
  const HeapShape shape = measure_heap_shape(heap, heap, perfect(radius, 0.3));
  EXPECT_EQ(shape.rings.sections[0].name, "ring1");
  EXPECT_EQ(shape.rings.sections[0].chi, shape.rings.sections[1].chi);
  EXPECT_LT(shape.rings.sections[0].chi, 0);
  // Grains of the larger size are 7 of 27, 8 times as heavy: 56 / 76 of the mass, so that all of the coarsest
  // quarter is they.
  EXPECT_NEAR(shape.rings.sections[2].chi, 1, 1e-12);
  EXPECT_NEAR(shape.rings.sections[2].mass / (shape.rings.sections[0].mass + shape.rings.sections[1].mass),
              56.0 / 20, 0.15);
}

TEST(HeapShape, GrainsBeyondTheRadiusAreOutside) {
  auto heap = cone(0.6, 0.3, 1000, [](double) { return 0.01; });
  Grain far = heap.front();
  far.position = Vec3(2, 0, 0.005);
  heap.push_back(far);
  const HeapShape shape = measure_heap_shape(heap, heap, perfect(0.6, 0.3));
  EXPECT_NEAR(shape.rings.mass_outside, far.mass, 1e-12);
  EXPECT_NEAR(shape.mass_share[0] + shape.mass_share[1] + shape.mass_share[2], 1000.0 / 1001, 1e-12);
}

TEST(HeapShape, OfAHeapThatIsRead) {
  // Lattice cone: the surface is known to a grain.
  std::vector<Grain> heap;
  const double d = 0.02, step = 0.75 * d, radius = 0.5, slope = std::tan(kPi / 6);
  for (int i = -40; i <= 40; ++i)
    for (int j = -40; j <= 40; ++j)
      for (int k = 0; k < 40; ++k) {
        Grain grain;
        grain.position = Vec3(i * step, j * step, 0.5 * d + k * step);
        grain.diameter = d, grain.mass = 1, grain.dump = 1;
        if (k * step <= slope * (radius - grain.position.head<2>().norm())) heap.push_back(grain);
      }
  const ReposeAngle read = measure_repose(heap);
  const HeapShape shape = measure_heap_shape(heap, heap, read);
  const double grain_share = d / read.height;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(shape.profile[k], 1 - kProfilePlaces[k], 1.5 * grain_share);
  EXPECT_GT(shape.profile[0], shape.profile[1]);
}

TEST(HeapShape, GivesOutputsOfARepose) {
  const auto heap = cone(0.6, 0.3, 2000, [](double r) { return 0.01 + 0.01 * r; });
  SeedResult seed;
  seed.repose = perfect(0.6, 0.3);
  seed.heap = measure_heap_shape(heap, heap, *seed.repose);
  const Outputs outputs = outputs_of(seed);
  for (const char* name : {"chi_ring1", "chi_ring3", "d50_rel_ring2", "mass_share_ring3", "profile_25",
                           "profile_50", "profile_75", "spread_95"}) {
    EXPECT_TRUE(outputs.contains(name)) << name;
    EXPECT_EQ(why_not_given({"repose_lift", 6, {}, {}}, name), "") << name;
    EXPECT_NE(why_not_given({"end_dump", 6, {}, {}}, name), "") << name;
  }
  EXPECT_NE(why_not_given({"repose_lift", 6, {}, {}}, "chi_ring4"), "");
}

TEST(HeapShape, WithoutARadiusOnlyTheRunoutIsKnown) {
  const double nan = std::nan("");
  const auto heap = cone(0.6, 0.3, 500, [](double) { return 0.01; });
  SeedResult seed;
  seed.repose = ReposeAngle{nan, nan, nan, nan, nan, nan, {nan, nan, nan, nan}, nan, {0, 0}, {}, 0};
  seed.heap = measure_heap_shape(heap, heap, *seed.repose);
  EXPECT_TRUE(std::isnan(of_ring(*seed.heap, 0, [](const Section& ring) { return ring.mass; })));
  EXPECT_TRUE(std::isnan(of_ring(*seed.heap, 0, [](const Section& ring) { return 1.0 * ring.grains; })));
  const Outputs outputs = outputs_of(seed);
  EXPECT_TRUE(outputs.contains("spread_95"));
  for (const char* name : {"radius_m", "runaways", "height_m", "mass_share_ring1", "mass_share_ring3",
                           "chi_ring1", "d50_rel_ring2", "profile_25"})
    EXPECT_FALSE(outputs.contains(name)) << name;
}

TEST(HeapShape, NothingIsRefused) {
  EXPECT_THROW(measure_heap_shape({}, {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace scree
