// Grains of two spheres, against the mechanics of a rigid body that is alike all around its axis.
#include "sim/world/clumps.h"

#include <set>

#include "sim/effects/effect.h"
#include "tests/verification/scene.h"

namespace scree::verification {
namespace {

constexpr double kRadius = 0.1, kDt = 1e-4;

WorldSettings clumped(WorldSettings settings, double elongation) {
  const EffectUse use{find_effect("clumps"), {elongation}};
  settings.clumps = modifications(std::span(&use, 1), {}).clumps;
  return settings;
}

NewSphere grain(const Vec3& position, const Vec3& axis, const Vec3& velocity = Vec3::Zero(),
                const Vec3& spin = Vec3::Zero()) {
  NewSphere g = ball(position, kRadius, velocity, spin);
  g.axis = axis.normalized();
  return g;
}

Vec3 axis_of(const RockWorld& world, int grain) {
  const Spheres& s = world.spheres();
  const int i = index_of(world, grain), p = s.partner[i];
  return (s.place[p].vec() - s.place[i].vec()).normalized();
}

Vec3 momentum_of(const RockWorld& world) {
  Vec3 sum = Vec3::Zero();
  for (const Quad& v : world.spheres().velocity) sum += v.w * v.vec();
  return sum;
}

// Sum over grains of m x v + L; places stand half a step ahead of velocities, which m v v = 0 forgives.
Vec3 angular_momentum_of(const RockWorld& world) {
  const Spheres& s = world.spheres();
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < s.size(); ++i) {
    const int p = s.partner[i];
    const Vec3 middle = 0.5 * (s.place[i].vec() + s.place[p].vec()),
               velocity = 0.5 * (s.velocity[i].vec() + s.velocity[p].vec());
    sum += s.velocity[i].w * middle.cross(velocity) + 0.5 * s.angular[i].vec();
  }
  return sum;
}

// The two spheres together fill the volume of the grain: sum over slices of what either covers.
TEST(Clumps, FillTheVolumeOfTheGrain) {
  for (const double e : {0.01, 0.3, 0.7, 1.0}) {
    const Clumps clumps{e};
    const double r = clumps.size(), arm = e * r;  // of a grain of radius 1
    double volume = 0;
    constexpr int kSlices = 200000;
    const double step = 2 * (r + arm) / kSlices;
    for (int k = 0; k < kSlices; ++k) {
      const double x = -(r + arm) + (k + 0.5) * step;
      const auto square = [&](double middle) { return r * r - (x - middle) * (x - middle); };
      volume += kPi * std::max({square(-arm), square(arm), 0.0}) * step;
    }
    EXPECT_NEAR(volume, 4 * kPi / 3, 1e-6) << e;
    EXPECT_DOUBLE_EQ(clumps.length(), (1 + e) * r);
  }
}

// Moments of inertia of a body of one density in the shape of the two spheres: sum over slices across the
// axis, each a disc of the larger of the two circles, area A, with A^2 / (2 pi) along and A^2 / (4 pi) + A
// x^2 across.
Clumps::Inertia inertia_by_slices(double e) {
  double volume = 0, along = 0, across = 0;
  constexpr int kSlices = 200000;
  const double step = 2 * (1 + e) / kSlices;
  for (int k = 0; k < kSlices; ++k) {
    const double x = -(1 + e) + (k + 0.5) * step;
    const auto square = [&](double middle) { return 1 - (x - middle) * (x - middle); };
    const double area = kPi * std::max({square(-e), square(e), 0.0});
    volume += area * step;
    along += area * area / (2 * kPi) * step;
    across += (area * area / (4 * kPi) + area * x * x) * step;
  }
  return {along / volume, across / volume};
}

TEST(Clumps, HaveTheInertiaOfTheirShape) {
  for (const double e : {0.01, 0.3, 0.5, 0.7, 1.0}) {
    const Clumps::Inertia exact = inertia_by_slices(e), ours = Clumps{e}.inertia();
    EXPECT_NEAR(ours.along, exact.along, 1e-7) << e;
    EXPECT_NEAR(ours.across, exact.across, 1e-7) << e;
  }
  EXPECT_NEAR(Clumps{1.0}.inertia().across, 1.4, 1e-12) << "two balls side by side, 2/5 + 1";
}

// Free of forces the axis goes around the angular momentum L at L / I across (symmetric top), at a constant
// angle, and L and the energy of motion stay.
TEST(Clumps, FreeAxisPrecessesAboutTheAngularMomentum) {
  const double e = 0.7;
  RrlinearWorld world(clumped(weightless(kDt), e));
  const Vec3 spin(3, 0, 8);
  world.add_spheres({grain({0, 0, 0}, {1, 0, 1}, {1, 2, 3}, spin)});
  step(world);
  const double mass = ball_mass(world.settings().material, kRadius), r = kRadius * Clumps{e}.size();
  const Clumps::Inertia unit = inertia_by_slices(e);
  const double across = unit.across * mass * r * r, along = unit.along * mass * r * r;
  const Vec3 momentum = world.spheres().angular[0].vec(), up = momentum.normalized();
  const Vec3 axis = Vec3(1, 0, 1).normalized();
  const double of_spin =
      0.5 * across * (spin - axis.dot(spin) * axis).squaredNorm() + 0.5 * along * std::pow(axis.dot(spin), 2);
  EXPECT_NEAR(world.energy().kinetic, 0.5 * mass * 14 + of_spin, 1e-5 * mass * 14);
  const double energy = world.energy().kinetic, height = axis_of(world, 0).dot(up), begin = world.time();
  const auto flat = [&] { return Vec3(axis_of(world, 0) - axis_of(world, 0).dot(up) * up).normalized(); };
  const Vec3 first = flat(), side = up.cross(first);
  const double rate = momentum.norm() / across;
  for (int k = 1; k <= 8; ++k) {
    world.advance_to(begin + 0.1 * k);
    const double angle = rate * (world.time() - begin);
    EXPECT_LT((flat() - std::cos(angle) * first - std::sin(angle) * side).norm(), 1e-5 * angle) << k;
    EXPECT_NEAR(axis_of(world, 0).dot(up), height, 1e-7);
    EXPECT_NEAR(world.energy().kinetic, energy, 1e-6 * energy);
    EXPECT_LT((world.spheres().angular[0].vec() - momentum).norm(), 1e-12 * momentum.norm());
  }
  EXPECT_LT((world.snapshot().grains.front().velocity - Vec3(1, 2, 3)).norm(), 1e-9);
}

// The grain is seen as a sphere of its volume and mass, which falls as one.
TEST(Clumps, AreSeenAsSpheresOfTheirVolume) {
  RrlinearWorld world(clumped(undamped(kDt), 0.5));
  world.add_spheres({grain({0, 0, 10}, {1, 2, 0}, {1, 0, 0}, {0, 5, 0}), grain({3, 0, 10}, {0, 0, 1})});
  world.advance_to(0.5);
  const Snapshot shot = world.snapshot();
  ASSERT_EQ(shot.grains.size(), 2u);
  EXPECT_EQ(world.spheres().movable, 4);
  for (const Grain& g : shot.grains) {
    EXPECT_NEAR(g.diameter, 2 * kRadius, 1e-15);
    EXPECT_NEAR(g.mass, ball_mass(world.settings().material, kRadius), 1e-9);
    EXPECT_NEAR(g.position.z(), 10 - 0.5 * kGravity * 0.25, kGravity * kDt);
  }
  EXPECT_EQ(shot.grains[1].id, 1);
  world.add_spheres({grain({6, 0, 10}, {0, 0, 1}), grain({9, 0, 10}, {0, 0, 1})});
  world.advance_to(0.6);
  std::set<std::int64_t> numbers(world.spheres().id.begin(), world.spheres().id.end());
  EXPECT_EQ(numbers.size(), 8u) << "each has its own";
  EXPECT_EQ(world.snapshot().grains.size(), 4u);
  EXPECT_NEAR(shot.grains[0].position.x(), 0.5, 1e-9);
}

// Two grains that meet out of line, without friction: momentum, angular momentum and energy are kept, and
// both turn afterwards.
TEST(Clumps, OffCentreImpactKeepsMomentumAngularMomentumAndEnergy) {
  RrlinearWorld world(clumped(weightless(2e-6), 0.8));
  world.add_spheres(
      {grain({-0.3, 0.05, 0}, {0, 1, 0.2}, {2, 0, 0}), grain({0.3, -0.05, 0.02}, {0.3, 1, 0}, {-1, 0, 0})});
  step(world);
  const Vec3 momentum = momentum_of(world), angular = angular_momentum_of(world);
  const double energy = world.energy().total();
  world.advance_to(0.3);
  const Spheres& s = world.spheres();
  for (int i = 0; i < 4; ++i) EXPECT_GT(s.spin[i].vec().norm(), 0.5) << "they have met out of line";
  EXPECT_LT((momentum_of(world) - momentum).norm(), 1e-10 * momentum.norm());
  EXPECT_LT((angular_momentum_of(world) - angular).norm(), 1e-4 * angular.norm());
  EXPECT_NEAR(world.energy().total(), energy, 1e-4 * energy);
}

// A grain with its axis down a slope stands on two feet, arm apart from its middle to either side and r below
// it: it tips over the lower one when tan(slope) > arm / r = elongation, while a ball without rolling
// resistance rolls on any slope.
TEST(Clumps, StandOnASlopeAsLongAsTheyAreLong) {
  const double slope = std::atan(0.4);
  for (const double e : {0.3, 0.5}) {
    WorldSettings settings = clumped(undamped(0), e);
    settings.fixed_time_step = 0;
    settings.material.local_damping = 0.3;
    settings.material.mu = 1;
    settings.gravity = kGravity * Vec3(std::sin(slope), 0, -std::cos(slope));
    RrlinearWorld world(settings);
    add_floor(world, {1.0, 0.0});
    const double r = kRadius * Clumps{e}.size();
    world.add_spheres({grain({0, 0, r}, {1, 0, 0})});
    world.advance_to(3.0);
    const double went = world.snapshot().grains.front().position.x();
    if (e > std::tan(slope)) {
      EXPECT_LT(went, 0.1 * kRadius) << e;
      EXPECT_LT(velocity_of(world, 0).norm(), 1e-6);
    } else {
      EXPECT_GT(went, 2 * kRadius) << e;
    }
  }
}

// Friction by size is that of the grain, not of its smaller spheres: one of D50 slides where tan(slope) > mu.
TEST(Clumps, FrictionBySizeIsThatOfTheGrain) {
  const double slope = std::atan(0.4);
  for (const double exponent : {-2.0, 2.0})
    for (const double mu : {0.37, 0.44}) {
      WorldSettings settings = clumped(undamped(0), 0.6);
      settings.fixed_time_step = 0;
      settings.material.local_damping = 0.3;
      settings.contact_effects.mu_exponent = exponent;
      settings.contact_effects.reference_diameter = 2 * kRadius;
      settings.gravity = kGravity * Vec3(std::sin(slope), 0, -std::cos(slope));
      RrlinearWorld world(settings);
      add_floor(world, {mu, 0.0});
      world.add_spheres({grain({0, 0, kRadius * Clumps{0.6}.size()}, {1, 0, 0})});
      world.advance_to(3.0);
      const double went = world.snapshot().grains.front().position.x();
      EXPECT_EQ(went > 0.2 * kRadius, mu < 0.4) << mu << " " << exponent << ": " << went;
    }
}

// Force and moment beyond what rest takes: a grain that is dropped upright, out of line by a hair, ends
// lying.
TEST(Clumps, EndLyingAndSleep) {
  WorldSettings settings = clumped(undamped(0), 0.8);
  settings.fixed_time_step = 0;
  settings.material.local_damping = 0.4;
  settings.material.mu = 0.5;
  settings.sleep = true;
  settings.time_step_safety = 0.1;
  RrlinearWorld world(settings);
  add_floor(world, {0.5, 0.01});
  world.add_spheres({grain({0, 0, 3 * kRadius}, {0.1, 0, 1})});
  world.advance_to(6.0);
  EXPECT_LT(std::abs(axis_of(world, 0).z()), 0.01);
  EXPECT_EQ(world.statistics().asleep, 2) << "both of its spheres";
  const auto balance = world.energy_balance();
  EXPECT_LT(std::abs(balance->relative_error()), 1e-3);
  // A push wakes all of it.
  world.set_velocity(0, {1, 0, 0}, Vec3::Zero());
  EXPECT_EQ(world.spheres().asleep[0] + world.spheres().asleep[1], 0);
  world.advance_to(6.2);
  EXPECT_GT(world.snapshot().grains.front().position.x(), 0.02);
}

// alpha |F| against the motion of the middle: a damped fall has g (1 - alpha).
TEST(Clumps, LocalDampingActsOnTheGrain) {
  WorldSettings settings = clumped(undamped(kDt), 0.6);
  settings.material.local_damping = 0.3;
  RrlinearWorld world(settings);
  world.add_spheres({grain({0, 0, 10}, {1, 0, 0}, {0, 0, -1e-6})});
  world.advance_to(0.5);
  EXPECT_NEAR(velocity_of(world, 0).z(), -0.7 * kGravity * 0.5, 2 * kGravity * kDt);
}

}  // namespace
}  // namespace scree::verification
