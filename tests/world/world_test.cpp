// The explicit world as a whole: the same result for any number of threads, runaways, lost spheres, what
// Bullet sees.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "sim/material/random.h"
#include "sim/world/rrlinear_world.h"
#include "tests/world/ball.h"

namespace scree {
namespace {

void add_floor(RockWorld& world) {
  world.add_mesh(make_box({-20, -20, -2}, {20, 20, 0}), {0.4, 0.4}, Motion::fixed(Pose{}));
}

// Mixed spheres of ratio 1:6 that fall on a floor and on each other.
std::vector<NewSphere> rain(int per_side, int layers) {
  Random random(4, 0, RandomPurpose::positions);
  std::vector<NewSphere> spheres;
  for (int k = 0; k < layers; ++k)
    for (int i = 0; i < per_side; ++i)
      for (int j = 0; j < per_side; ++j) {
        const Vec3 at(0.5 * (i - 0.5 * per_side) + random.uniform(-0.02, 0.02),
                      0.5 * (j - 0.5 * per_side) + random.uniform(-0.02, 0.02), 0.26 + 0.5 * k);
        spheres.push_back(ball(at, random.uniform() < 0.2 ? 0.23 : random.uniform(0.04, 0.15), {0, 0, -3}));
      }
  return spheres;
}

bool same_bits(const std::vector<Quad>& a, const std::vector<Quad>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Quad)) == 0;
}

void expect_same_state(const RockWorld& a, const RockWorld& b) {
  EXPECT_EQ(a.spheres().id, b.spheres().id);
  EXPECT_TRUE(same_bits(a.spheres().place, b.spheres().place));
  EXPECT_TRUE(same_bits(a.spheres().velocity, b.spheres().velocity));
  EXPECT_TRUE(same_bits(a.spheres().spin, b.spheres().spin));
}

class Determinism : public testing::TestWithParam<bool> {};

// 2,592 spheres: more than one task holds, so that several threads do share the work.
TEST_P(Determinism, AnyNumberOfThreadsGivesTheSameBits) {
  const auto run = [](int threads) {
    WorldSettings settings;
    settings.threads = threads;
    settings.sleep = GetParam();
    auto world = std::make_unique<RrlinearWorld>(settings);
    world->add_spheres(rain(18, 8));
    add_floor(*world);
    world->advance_to(0.3);
    world->add_spheres({ball({0, 0, 6}, 0.2), ball({0.1, 0.2, 7}, 0.1)});  // and in a second portion
    world->advance_to(0.6);
    return world;
  };
  const auto one = run(1);
  EXPECT_GT(one->statistics().largest_overlap_ratio, 0.02);
  for (const int threads : {1, 2, 4}) {
    const auto again = run(threads);
    expect_same_state(*one, *again);
    EXPECT_EQ(one->statistics().steps, again->statistics().steps);
  }
}

// A load falls on a heap that sleeps on fixed balls, then a blade comes and pushes both.
TEST(World, SleepAndToolsGiveTheSameBitsWithAnyNumberOfThreads) {
  std::int64_t most_asleep = 0, woken = 0;
  const auto run = [&](int threads) {
    WorldSettings settings;
    settings.threads = threads;
    settings.sleep = true;
    auto world = std::make_unique<RrlinearWorld>(settings);
    std::vector<NewSphere> spheres = rain(16, 4);
    for (NewSphere& s : spheres) s.velocity.setZero();
    for (int x = -14; x <= 14; ++x)
      for (int y = -14; y <= 14; ++y) {
        spheres.push_back(ball({0.4 * x, 0.4 * y, 0}, 0.2));
        spheres.back().fixed = true;
      }
    world->add_spheres(spheres);
    add_floor(*world);
    const auto at = [](double x) { return Pose{{x, 0, 0.25}, Quaternion::Identity()}; };
    world->add_mesh(make_box({-0.5, -6, 0}, {0, 6, 2}), {0.4, 0.4},
                    Motion({{0.0, at(-6)}, {6.0, at(-6)}, {7.0, at(-4)}}));
    world->advance_to(5.0);
    most_asleep = world->statistics().asleep;
    std::vector<NewSphere> load = rain(5, 4);
    for (NewSphere& s : load) s.position.z() += 3;
    world->add_spheres(load);
    for (double time = 5.1; time < 6.95; time += 0.1) {
      const std::int64_t before = world->statistics().asleep;
      world->advance_to(time);
      woken = std::max(woken, before - world->statistics().asleep);
    }
    return world;
  };
  const auto one = run(1);
  EXPECT_GT(most_asleep, 500);  // of 1,024
  EXPECT_GT(woken, 20);
  EXPECT_GT(one->statistics().asleep, 100);
  for (const int threads : {2, 4}) {
    const auto again = run(threads);
    expect_same_state(*one, *again);
    EXPECT_EQ(one->statistics().steps, again->statistics().steps);
  }
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutSleep, Determinism, testing::Bool());

// Whether a run is asked for in one piece or in many looks at step boundaries does not matter.
TEST(World, LooksAtStepBoundariesDoNotChangeTheRun) {
  WorldSettings settings;
  settings.fixed_time_step = 0x1p-11;  // exact in binary, so that times add up exactly
  RrlinearWorld one(settings), many(settings);
  for (RrlinearWorld* world : {&one, &many}) {
    world->add_spheres(rain(6, 4));
    add_floor(*world);
  }
  one.advance_to(0.5);
  for (int k = 1; k <= 64; ++k) many.advance_to(0.5 * k / 64);
  expect_same_state(one, many);
}

std::vector<std::vector<std::int64_t>> partners(const RrlinearWorld& world, std::int64_t without) {
  std::vector<std::vector<std::int64_t>> lists;
  const Spheres& s = world.spheres();
  for (int i = 0; i < s.movable; ++i) {
    if (s.id[i] == without) continue;
    auto& row = lists.emplace_back();
    for (const Neighbour& n : world.pairs().owned(i)) row.push_back(s.id[n.sphere]);
  }
  return lists;
}

// A sphere at 200 m/s far away repairs its own lists. Its skin is as large as the largest sphere's radius
// allows and lasts at least skin / (v dt) steps; nobody else is listed anew because of it.
TEST(World, RunawayLeavesTheOthersAlone) {
  WorldSettings settings;
  settings.fixed_time_step = 2e-4;
  RrlinearWorld quiet(settings), runaway(settings);
  std::vector<NewSphere> spheres = rain(6, 4);
  for (RrlinearWorld* world : {&quiet, &runaway}) {
    world->add_spheres(spheres);
    add_floor(*world);
    world->advance_to(8.0);  // at rest
  }
  // Beyond all others on every axis, so that it comes last in the order of the spheres.
  const auto id = static_cast<std::int64_t>(spheres.size());
  runaway.add_spheres({ball({100, 100, 100}, 0.2, {200, 0, 0})});
  quiet.add_spheres({ball({100, 100, 100}, 0.2)});
  for (RrlinearWorld* world : {&quiet, &runaway}) world->advance_to(8.0);
  // 300 steps: fewer than lie between two re-sortings, which list everybody.
  const auto before = partners(runaway, id);
  std::vector<Vec3> places, listed;
  for (int i = 0; i < runaway.spheres().size(); ++i) {
    places.push_back(runaway.spheres().place[i].vec());
    listed.push_back(runaway.pairs().ball_at(i));
  }
  const std::int64_t quiet_before = quiet.statistics().list_repairs,
                     before_repairs = runaway.statistics().list_repairs;
  const auto steps = runaway.statistics().steps;
  quiet.advance_to(8.06);
  runaway.advance_to(8.06);
  EXPECT_EQ(partners(runaway, id), before);
  for (int i = 0; i < runaway.spheres().size(); ++i) {
    if (runaway.spheres().id[i] == id) continue;
    ASSERT_EQ(runaway.spheres().id[i], quiet.spheres().id[i]);
    // One that moves by itself, by more than half its skin, may be listed anew whenever somebody is.
    const Quad& now = runaway.spheres().place[i];
    if ((now.vec() - places[i]).norm() < 0.05 * now.w) {
      ASSERT_EQ(runaway.pairs().ball_at(i), listed[i]);
    }
    ASSERT_EQ(runaway.spheres().place[i].vec(), quiet.spheres().place[i].vec());
    ASSERT_EQ(runaway.spheres().velocity[i].vec(), quiet.spheres().velocity[i].vec());
  }
  const double moved =
      200 * settings.fixed_time_step;  // m a step; a skin is at least the largest radius here
  const double own = static_cast<double>(runaway.statistics().steps - steps) * moved / 0.2;
  EXPECT_LE(static_cast<double>(runaway.statistics().list_repairs - before_repairs),
            own + 1 + static_cast<double>(quiet.statistics().list_repairs - quiet_before));
}

TEST(World, LostSphereIsCountedAndMissedByNobody) {
  WorldSettings settings;
  settings.fixed_time_step = 5e-4;
  settings.domain_high = {30, 30, 30};
  RrlinearWorld with(settings), without(settings);
  std::vector<NewSphere> spheres = rain(6, 4);
  const auto id = static_cast<std::int64_t>(spheres.size());
  spheres.push_back(ball({25, 25, 25}, 0.2));
  without.add_spheres(spheres);
  spheres.back().velocity = {20, 0, 0};
  with.add_spheres(spheres);
  for (RrlinearWorld* world : {&with, &without}) {
    add_floor(*world);
    world->advance_to(0.6);  // lost at 0.25 s; before the spheres are re-sorted, which changes roundings
  }
  EXPECT_EQ(with.statistics().lost_particles, 1);
  const double mass = settings.material.density * 4.0 / 3 * std::numbers::pi * 0.008;
  EXPECT_NEAR(with.statistics().lost_mass, mass, 1e-9 * mass);
  EXPECT_EQ(with.sphere_body(id), nullptr);
  const Snapshot a = with.snapshot(), b = without.snapshot();
  ASSERT_EQ(a.grains.size() + 1, b.grains.size());
  for (std::size_t i = 0; i < a.grains.size(); ++i) {
    EXPECT_EQ(a.grains[i].id, b.grains[i].id);
    EXPECT_EQ(a.grains[i].position, b.grains[i].position);
    EXPECT_EQ(a.grains[i].velocity, b.grains[i].velocity);
  }
  // And spheres may be added afterwards.
  with.add_spheres({ball({0, 0, 8}, 0.2)});
  with.advance_to(0.7);
  EXPECT_EQ(with.statistics().lost_particles, 1);
  EXPECT_EQ(with.snapshot().grains.size(), b.grains.size());
}

// Neighbours are known over some hundredths of a radius only; what comes from forty radii away must be found
// in time. Elastic and of equal mass, the spheres exchange their velocities.
TEST(World, WhatComesFromAfarIsMet) {
  WorldSettings settings;
  settings.gravity = Vec3::Zero();
  settings.material.local_damping = 0;
  RrlinearWorld world(settings);
  world.add_spheres({ball({0, 0, 0}, 0.1, {2, 0, 0}), ball({4, 0, 0}, 0.1)});
  world.advance_to(2.5);  // they meet after 1.9 s
  const std::vector<Grain> grains = world.snapshot().grains;
  EXPECT_NEAR(grains[0].velocity.x(), 0, 0.02);
  EXPECT_NEAR(grains[1].velocity.x(), 2, 0.02);
}

TEST(World, TooFastASphereIsABlowUp) {
  WorldSettings settings;
  settings.fixed_time_step = 1e-4;
  RrlinearWorld world(settings);
  world.add_spheres({ball({0, 0, 0}, 0.1, {600, 0, 0})});
  EXPECT_THROW(world.advance_to(0.1), BlowUp);
}

// Leapfrog of a spring is stable up to dt = 2 sqrt(m / k), here that of a ball on the floor, k = pi E R.
TEST(World, EnergyOutOfNothingIsABlowUp) {
  WorldSettings settings;
  settings.material.local_damping = 0;
  const double radius = 0.5,
               mass = settings.material.density * 4.0 / 3 * std::numbers::pi * std::pow(radius, 3),
               stiffness = std::numbers::pi * settings.material.effective_modulus * radius;
  for (const double share : {0.95, 1.05}) {
    settings.fixed_time_step = share * 2 * std::sqrt(mass / stiffness);
    RrlinearWorld world(settings);
    world.add_spheres({ball({0, 0, radius - 1.01 * mass * 9.81 / stiffness}, radius)});
    add_floor(world);
    if (share < 1) {
      EXPECT_NO_THROW(world.advance_to(2000 * settings.fixed_time_step));
      continue;
    }
    try {
      world.advance_to(2000 * settings.fixed_time_step);
      FAIL() << "it did not blow up";
    } catch (const BlowUp& error) {
      EXPECT_NE(std::string(error.what()).find("energy"), std::string::npos) << error.what();
    }
  }
}

// Energy is looked at as soon as the scene has changed, not after it has had time to grow.
TEST(World, EnergyOutOfNothingIsSeenFromTheChangeOfASceneOn) {
  WorldSettings settings;
  settings.material.local_damping = 0;
  const double radius = 0.5,
               mass = settings.material.density * 4.0 / 3 * std::numbers::pi * std::pow(radius, 3),
               stiffness = std::numbers::pi * settings.material.effective_modulus * radius;
  settings.fixed_time_step = 1.0005 * 2 * std::sqrt(mass / stiffness);
  RrlinearWorld world(settings);
  NewSphere base = ball({5, 0, 0}, radius);
  base.fixed = true;
  world.add_spheres({base});
  add_floor(world);
  world.advance_to(22 * settings.fixed_time_step);
  world.add_spheres({ball({0, 0, radius - 1.01 * mass * 9.81 / stiffness}, radius)});
  EXPECT_THROW(world.advance_to(152 * settings.fixed_time_step), BlowUp);
}

// Motion that friction bounds does not grow: what a step that is too long makes, friction takes.
TEST(World, EnergyOutOfNothingThatFrictionTakesIsABlowUp) {
  EnergyWatch watch;
  AwakeEnergy same;
  same.kinetic = 1;
  watch.check(same, 5, 0);
  EXPECT_NO_THROW(watch.check(same, 5.9, 1));
  watch.supply(10);
  EXPECT_NO_THROW(watch.check(same, 15.9, 2));
  EXPECT_THROW(watch.check(same, 17.9, 3), BlowUp);
}

TEST(World, EnergyCanBeAskedBeforeTheFirstStep) {
  WorldSettings settings;
  RrlinearWorld world(settings);
  world.add_spheres({ball({0, 0, 2}, 0.5), ball({0, 0, 4}, 0.5)});
  const double mass = settings.material.density * 4.0 / 3 * std::numbers::pi * 0.125;
  EXPECT_NEAR(world.energy().potential, mass * 9.81 * 6, 1e-6);
}

struct RayHit : btCollisionWorld::ClosestRayResultCallback {
  RayHit(const Vec3& from, const Vec3& to) : ClosestRayResultCallback(to_bullet(from), to_bullet(to)) {
    m_collisionFilterMask = btBroadphaseProxy::AllFilter;
  }
};

TEST(World, BulletSeesSpheresAndMeshesWhereTheyAre) {
  RrlinearWorld world((WorldSettings()));
  const double radius = 0.3;
  world.add_spheres({ball({1, 2, 3}, radius, {1, 0, 0})});
  const int lift = world.add_mesh(make_box({-1, -1, -1}, {1, 1, 0}), {0.4, 0.4},
                                  Motion({{0.0, Pose{}}, {2.0, Pose{{-8, 0, 2}, Quaternion::Identity()}}}));
  world.advance_to(0.5);
  world.update_bullet();
  const Snapshot shot = world.snapshot();
  const Vec3 x = shot.grains[0].position;
  EXPECT_GT(x.x(), 1.2);
  const btRigidBody* body = world.sphere_body(0);
  EXPECT_EQ(from_bullet(body->getWorldTransform().getOrigin()), x);
  EXPECT_EQ(from_bullet(body->getLinearVelocity()), shot.grains[0].velocity);

  RayHit sphere(x + Vec3(0, 0, 5), x - Vec3(0, 0, 5));
  world.rayTest(sphere.m_rayFromWorld, sphere.m_rayToWorld, sphere);
  ASSERT_TRUE(sphere.hasHit());
  EXPECT_EQ(sphere.m_collisionObject->getUserIndex(), 0);
  EXPECT_NEAR(sphere.m_hitPointWorld.z(), x.z() + radius, 1e-4);  // Bullet's convex cast stops at 1e-4

  // The box has risen by 2 m * 0.5 / 2.
  EXPECT_NEAR(world.mesh(lift).state().pose.position.z(), 0.5, 1e-12);
  RayHit box({-2, 0, 5}, {-2, 0, -5});
  world.rayTest(box.m_rayFromWorld, box.m_rayToWorld, box);
  ASSERT_TRUE(box.hasHit());
  EXPECT_NEAR(box.m_hitPointWorld.z(), 0.5, 1e-6);
}

TEST(World, StepSimulationIsBulletsOwnEntry) {
  RrlinearWorld world((WorldSettings()));
  world.add_spheres({ball({0, 0, 5}, 0.3)});
  btDiscreteDynamicsWorld& bullet = world;
  EXPECT_GT(bullet.stepSimulation(0.1), 0);
  EXPECT_NEAR(world.time(), 0.1, 1e-12);
  EXPECT_LT(world.sphere_body(0)->getWorldTransform().getOrigin().z(), 5);
}

// At most 1.5 KB a sphere, contacts included, however wide the grading. Bullet's bodies, a kilobyte and more
// each, are only made when somebody asks for them.
TEST(World, MemoryPerSphere) {
  RrlinearWorld world(WorldSettings{});
  std::vector<NewSphere> spheres;
  Random random(31, 0, RandomPurpose::positions);
  for (int k = 0; k < 20000; ++k) {
    const double radius = 0.05 * std::pow(27.0, std::pow(random.uniform(), 4.0));
    spheres.push_back(
        ball({random.uniform(-12, 12), random.uniform(-12, 12), random.uniform(0, 12)}, radius));
  }
  world.add_spheres(spheres);
  world.advance_to(0.01);
  EXPECT_LT(static_cast<double>(world.bytes()) / 20000.0, 1500.0);
  world.advance_to(0.1);  // rows have moved and left gaps
  EXPECT_LT(static_cast<double>(world.bytes()) / 20000.0, 1500.0);
}

}  // namespace
}  // namespace scree
