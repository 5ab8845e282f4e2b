// Spheres that break: when, into what, and what is kept.
#include <numeric>

#include "sim/effects/effect.h"
#include "tests/verification/scene.h"

namespace scree::verification {
namespace {

constexpr double kRadius = 0.05, kDt = 2e-6;
constexpr double kStrength = 2;  // J/kg, of a sphere of D50

WorldSettings brittle(WorldSettings settings, double exponent = 0, double smallest = 0) {
  const EffectUse use{find_effect("breakage"), {1 / kStrength, exponent}};
  settings.breakage = modifications(std::span(&use, 1), {.d50 = 2 * kRadius, .smallest = smallest}).breakage;
  return settings;
}

std::int64_t broken_on_floor(double radius, double speed, const WorldSettings& settings) {
  RrlinearWorld world(settings);
  add_floor(world, {0, 0});
  world.add_spheres({ball({0, 0, 1.001 * radius}, radius, {0, 0, -speed})});
  const double kn = wall_stiffness(settings.material, radius);
  world.advance_to(0.001 * radius / speed +
                   2 * std::sqrt(ball_mass(settings.material, radius) / kn));  // past the largest overlap
  return world.statistics().broken_spheres;
}

// Without damping all of v^2 / 2 is stored in the contact with a floor.
TEST(Breakage, OnAFloorFromHalfTheSquareOfTheSpeed) {
  for (const double share : {0.97, 1.03})
    EXPECT_EQ(broken_on_floor(kRadius, std::sqrt(2 * kStrength * share), brittle(weightless(kDt))),
              share > 1);
}

// Strength goes with (d / D50)^-m.
TEST(Breakage, LargeGrainsAreWeaker) {
  const double m = 0.8;
  for (const double size : {0.6, 2.0})
    for (const double share : {0.97, 1.03}) {
      const double speed = std::sqrt(2 * kStrength * std::pow(size, -m) * share);
      EXPECT_EQ(broken_on_floor(size * kRadius, speed, brittle(weightless(kDt), m)), share > 1) << size;
    }
}

// Two equal spheres that meet with v and -v have v^2 / 2 each.
TEST(Breakage, TwoSpheresBearHalfEach) {
  for (const double share : {0.97, 1.03}) {
    const WorldSettings settings = brittle(weightless(kDt));
    const double speed = std::sqrt(2 * kStrength * share);
    RrlinearWorld world(settings);
    world.add_spheres({ball({-1.001 * kRadius, 0, 0}, kRadius, {speed, 0, 0}),
                       ball({1.001 * kRadius, 0, 0}, kRadius, {-speed, 0, 0})});
    world.advance_to(0.01);
    EXPECT_EQ(world.statistics().broken_spheres, share > 1 ? 2 : 0);
  }
}

// None is finer than the smallest grain of the grading.
TEST(Breakage, StopsAtTheSmallestDiameter) {
  const double speed = std::sqrt(4 * kStrength), fragment = 2 * kRadius * std::pow(4, -1. / 3);
  EXPECT_EQ(broken_on_floor(kRadius, speed, brittle(weightless(kDt), 0, 0.99 * fragment)), 1);
  EXPECT_EQ(broken_on_floor(kRadius, speed, brittle(weightless(kDt), 0, 1.01 * fragment)), 0);
}

double volume_of(const Snapshot& now) {
  return std::accumulate(now.grains.begin(), now.grains.end(), 0.0, [](double sum, const Grain& g) {
    return sum + kPi / 6 * g.diameter * g.diameter * g.diameter;
  });
}

// Mass and momentum are kept to rounding; volume once the fragments are grown. Energy of motion
// does not rise when it happens.
TEST(Breakage, KeepsMassMomentumAndVolume) {
  WorldSettings settings = brittle(weightless(kDt));
  RrlinearWorld world(settings);
  const double speed = std::sqrt(3 * kStrength);
  world.add_spheres({ball({0, 0, 0}, kRadius, {speed, 0, 0}, {0, 0, 5}),
                     ball({2.001 * kRadius, 0.3 * kRadius, 0}, kRadius, {-speed, 0, 0})});
  const auto momentum = [&] {
    Vec3 sum = Vec3::Zero();
    for (const Grain& g : world.snapshot().grains) sum += g.mass * g.velocity;
    return sum;
  };
  const auto mass = [&] {
    double sum = 0;
    for (const Grain& g : world.snapshot().grains) sum += g.mass;
    return sum;
  };
  const double mass_before = mass(), volume_before = volume_of(world.snapshot());
  const Vec3 before = momentum();
  double energy = world.energy().kinetic + world.energy().elastic;
  while (world.statistics().broken_spheres == 0 && world.time() < 0.01) step(world);
  ASSERT_EQ(world.statistics().broken_spheres, 2);
  ASSERT_EQ(world.snapshot().grains.size(), 8);
  EXPECT_LT(world.energy().kinetic + world.energy().elastic, energy);
  EXPECT_NEAR(mass(), mass_before, 1e-14 * mass_before);
  EXPECT_LT((momentum() - before).norm(), 1e-12 * mass_before * speed);
  world.advance_to(2.0);
  EXPECT_NEAR(mass(), mass_before, 1e-14 * mass_before);
  EXPECT_NEAR(volume_of(world.snapshot()), volume_before, 1e-12 * volume_before);
  EXPECT_LT((momentum() - before).norm(), 1e-9 * mass_before * speed);
}

// Angular momentum about the middle of a sphere that spins and is hit without friction: m x v + I w over its
// fragments is that of its spin, at once and when they are grown.
TEST(Breakage, KeepsAngularMomentum) {
  RrlinearWorld world(brittle(weightless(kDt)));
  const double speed = std::sqrt(3 * kStrength), r = kRadius;
  world.add_spheres(
      {ball({0, 0, 0}, r, {speed, 0, 0}, {20, -30, 50}), ball({2.001 * r, 0, 0}, r, {-speed, 0, 0})});
  const auto angular = [&] {  // places stand half a step ahead of velocities, which v x v = 0 forgives
    const Spheres& s = world.spheres();
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < s.size(); ++i)
      sum += s.velocity[i].w * s.place[i].vec().cross(s.velocity[i].vec()) + s.spin[i].w * s.spin[i].vec();
    return sum;
  };
  const Vec3 before = angular();
  EXPECT_NEAR(before.norm(), 0.4 * ball_mass(world.settings().material, r) * r * r * Vec3(20, -30, 50).norm(),
              1e-12);
  while (world.statistics().broken_spheres == 0 && world.time() < 0.01) step(world);
  ASSERT_EQ(world.statistics().broken_spheres, 2);
  EXPECT_LT((angular() - before).norm(), 1e-9 * before.norm());
  world.advance_to(0.5);
  EXPECT_LT((angular() - before).norm(), 1e-6 * before.norm());
}

// How fast fragments grow is theirs: 1 % of the radius in three times sqrt(m / k), whatever the time step and
// the finest rock around. From kSizeAtFirst to kSize in ln(0.630 / 0.449) / ln(1.01) = 33.9 of these.
TEST(Breakage, FragmentsGrowAtTheirOwnPace) {
  for (const double dt : {kDt, kDt / 4})
    for (const bool fine : {false, true}) {
      RrlinearWorld world(brittle(weightless(dt)));
      std::vector<NewSphere> spheres{ball({0, 0, 0}, kRadius, {2.5, 0, 0}),
                                     ball({2.001 * kRadius, 0, 0}, kRadius, {-2.5, 0, 0})};
      if (fine) spheres.push_back(ball({5, 0, 0}, 0.1 * kRadius));
      world.add_spheres(spheres);
      while (world.statistics().broken_spheres == 0 && world.time() < 0.01) step(world);
      const double begin = world.time(), grown = kRadius * Breakage::kSize,
                   mass = ball_mass(world.settings().material, kRadius) / 4;
      const double pace = 3 * std::sqrt(mass / pair_stiffness(world.settings().material, grown, grown));
      const auto largest = [&] {
        double r = 0;
        for (const Grain& g : world.snapshot().grains)
          if (g.position.x() < 4) r = std::max(r, 0.5 * g.diameter);
        return r;
      };
      while (largest() < grown * (1 - 1e-9) && world.time() < begin + 100 * pace)
        world.advance_to(world.time() + 0.1 * pace);
      const double expected = std::log(Breakage::kSize / Breakage::kSizeAtFirst) / std::log(1.01) * pace;
      EXPECT_NEAR(world.time() - begin, expected, 0.02 * expected) << dt << " " << fine;
    }
}

// The four do not overlap, and lie inside the sphere.
TEST(Breakage, FragmentsLieInsideTheSphere) {
  const double r = Breakage::kSizeAtFirst;
  for (const std::uint64_t number : {0, 1, 77}) {
    const auto places = fragment_places(number);
    for (std::size_t a = 0; a < places.size(); ++a) {
      EXPECT_NEAR(places[a].norm() + r, 1, 1e-12);
      for (std::size_t b = 0; b < a; ++b) EXPECT_NEAR((places[a] - places[b]).norm(), 2 * r, 1e-12);
    }
  }
  EXPECT_NEAR(4 * std::pow(Breakage::kSize, 3), 1, 1e-12);
}

// A heap that is hit: the same with any number of threads, and with Bullet's bodies kept or not; spheres that
// are added later have the numbers that were kept for them.
TEST(Breakage, IsTheSameWithThreads) {
  std::vector<Grain> first;
  for (const int threads : {1, 2, 4}) {
    WorldSettings settings;
    settings.material.mu = settings.material.mu_r = 0.3;
    settings.threads = threads;
    settings.sleep = true;
    settings.breakage = {.fragility = 0.5, .exponent = 0.5, .reference_diameter = 0.1};
    settings.breakage.smallest_diameter = 0.04;
    RrlinearWorld world(settings);
    add_floor(world, {0.3, 0.3});
    std::vector<NewSphere> heap;
    Random random(5, 0, RandomPurpose::positions);
    for (int k = 0; k < 600; ++k)
      heap.push_back(
          ball({0.12 * (k % 8), 0.12 * (k / 8 % 8), 0.1 + 0.12 * (k / 64)}, random.uniform(0.03, 0.058)));
    world.reserve_numbers(601);
    world.add_spheres(heap);
    world.advance_to(1.0);
    world.add_spheres({ball({0.4, 0.4, 3}, 0.25, {0, 0, -8})});
    if (threads == 2) world.update_bullet();
    world.advance_to(2.0);
    if (threads == 2) world.update_bullet();
    const auto grains = world.snapshot().grains;
    EXPECT_GT(world.statistics().broken_spheres, 5);
    EXPECT_EQ(grains.size(), 601 + 3 * static_cast<std::size_t>(world.statistics().broken_spheres));
    EXPECT_EQ(grains.back().id, static_cast<std::int64_t>(grains.size()) - 1);
    if (first.empty()) first = grains;
    ASSERT_EQ(grains.size(), first.size());
    for (std::size_t k = 0; k < first.size(); ++k) ASSERT_EQ(grains[k].position, first[k].position) << k;
  }
}

}  // namespace
}  // namespace scree::verification
