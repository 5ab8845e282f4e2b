// Sleep: spheres at rest cost nothing until something disturbs them, and then behave as if they had been
// awake.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/world/rrlinear_world.h"
#include "tests/world/ball.h"

namespace scree {
namespace {

constexpr double kRadius = 0.3;

NewSphere ball(const Vec3& position, const Vec3& velocity = Vec3::Zero(), double radius = kRadius) {
  return scree::ball(position, radius, velocity);
}

struct Bench {
  RrlinearWorld world;
  int floor;
  explicit Bench(const std::vector<NewSphere>& spheres, bool sleep = true)
      : world([&] {
          WorldSettings settings;
          settings.sleep = sleep;
          return settings;
        }()) {
    world.add_spheres(spheres);
    floor = world.add_mesh(make_box({-20, -20, -2}, {20, 20, 0}), {0.4, 0.4}, Motion::fixed(Pose{}));
  }
  Grain grain(std::size_t id) const { return world.snapshot().grains[id]; }
};

TEST(Sleep, BallAtRestSleepsInItsPlace) {
  Bench b({ball({0, 0, kRadius})});
  b.world.advance_to(10);
  EXPECT_EQ(b.world.statistics().asleep, 1);
  const Vec3 at = b.grain(0).position;
  b.world.advance_to(20);
  EXPECT_EQ(b.grain(0).position, at);
  // Overlap of rest: m g / kn = 4/3 r^2 rho g / E; it fell asleep when within 0.5 % of the radius of it.
  const double overlap = 4.0 / 3 * kRadius * kRadius * 2760 * 9.81 / 1e6;
  EXPECT_NEAR(at.z(), kRadius - overlap, 0.005 * kRadius);
}

TEST(Sleep, FallingBallDoesNotSleep) {
  Bench b({ball({0, 0, 4})});
  b.world.advance_to(0.5);
  EXPECT_EQ(b.world.statistics().asleep, 0);
}

// Slow is not still: on a floor without friction nothing brakes a ball that makes a twentieth of its radius
// in one of the windows, 3 sqrt(R / g), over which sleep is judged.
TEST(Sleep, CreepingBallDoesNotSleep) {
  WorldSettings settings;
  settings.sleep = true;
  RrlinearWorld world(settings);
  world.add_mesh(make_box({-20, -20, -2}, {20, 20, 0}), {0, 0}, Motion::fixed(Pose{}));
  const double speed = 0.05 * kRadius / (3 * std::sqrt(kRadius / 9.81));
  world.add_spheres({ball({0, 0, kRadius}, {speed, 0, 0})});
  world.advance_to(10);
  EXPECT_EQ(world.statistics().asleep, 0);
  EXPECT_NEAR(world.snapshot().grains[0].position.x(), 10 * speed, 0.01 * 10 * speed);
}

// A block is judged by its own time to fall, 3 sqrt(R / g), and not by that of the smallest sphere around:
// 0.0017 sqrt(R g) = 6 mm/s is the limit of this one, of which a window of the small one's would make 31.
TEST(Sleep, BlockThatCreepsBesideSmallRockDoesNotSleep) {
  constexpr double kBlock = 1.33, kSmall = 0.05;
  for (const double speed : {0.01, 0.001}) {
    WorldSettings settings;
    settings.sleep = true;
    RrlinearWorld world(settings);
    world.add_mesh(make_box({-20, -20, -2}, {20, 20, 0}), {0, 0}, Motion::fixed(Pose{}));
    world.add_spheres(
        {ball({0, 0, kBlock}, {speed, 0, 0}, kBlock), ball({9, 0, kSmall}, Vec3::Zero(), kSmall)});
    world.advance_to(12);
    const double limit = 0.005 * kBlock / (3 * std::sqrt(kBlock / 9.81));
    EXPECT_EQ(world.statistics().asleep, speed < limit ? 2 : 1);
    if (speed > limit) {
      EXPECT_NEAR(world.snapshot().grains[0].position.x(), 12 * speed, 0.01 * 12 * speed);
    }
  }
}

TEST(Sleep, BlowWakes) {
  Bench b({ball({0, 0, kRadius})});
  b.world.advance_to(10);
  ASSERT_EQ(b.world.statistics().asleep, 1);
  const double x = b.grain(0).position.x();
  b.world.add_spheres({ball({-1.0, 0, kRadius}, {5, 0, 0})});
  b.world.advance_to(11);
  EXPECT_GT(b.grain(0).position.x() - x, 0.1);
}

TEST(Sleep, FloorTakenAwayWakes) {
  Bench b({ball({0, 0, kRadius})});
  b.world.advance_to(10);
  ASSERT_EQ(b.world.statistics().asleep, 1);
  b.world.remove_mesh(b.floor);
  b.world.advance_to(11);
  EXPECT_NEAR(b.grain(0).velocity.z(), -0.6 * 9.81, 0.1);  // (1 - alpha) g t
}

TEST(Sleep, FloorThatMovesWakes) {
  Bench b({ball({0, 0, kRadius})});
  b.world.advance_to(10);
  ASSERT_EQ(b.world.statistics().asleep, 1);
  const double z = b.grain(0).position.z();
  b.world.set_mesh_motion(b.floor, Motion({{10.0, Pose{}}, {12.0, Pose{{0, 0, 1}, Quaternion::Identity()}}}));
  b.world.advance_to(14);
  EXPECT_NEAR(b.grain(0).position.z() - z, 1.0, 0.005 * kRadius);
}

// Chain of causes: the lower one of two is knocked out, the upper one falls.
TEST(Sleep, LossOfASupportWakes) {
  Bench b({ball({0, 0, kRadius}), ball({0, 0, 3 * kRadius})});
  b.world.advance_to(10);
  ASSERT_EQ(b.world.statistics().asleep, 2);
  b.world.add_spheres({ball({-2, 0, kRadius}, {15, 0, 0})});
  b.world.advance_to(20);
  EXPECT_LT(b.grain(1).position.z(), 1.5 * kRadius);
}

// The lower one of two is pushed out of the domain for good; nothing is left hanging.
TEST(Sleep, SleepersWakeWhenANeighbourLeavesTheModel) {
  WorldSettings settings;
  settings.sleep = true;
  settings.domain_low = {-5, -5, -5};
  RrlinearWorld world(settings);
  world.add_mesh(make_box({-20, -20, -2}, {20, 20, 0}), {0.4, 0.4}, Motion::fixed(Pose{}));
  world.add_spheres({ball({-4.6, 0, kRadius}), ball({-4.6, 0, 3 * kRadius})});
  world.advance_to(10);
  ASSERT_EQ(world.statistics().asleep, 2);
  world.add_spheres({ball({-3.5, 0, kRadius}, {-30, 0, 0})});
  world.advance_to(20);
  EXPECT_GE(world.statistics().lost_particles, 1);
  for (const Grain& g : world.snapshot().grains) EXPECT_LT(g.position.z(), 1.5 * kRadius) << g.id;
}

// It is taken out while it still touches the one that sleeps on it: its last step, over the border of the
// domain, is too short to be felt there.
TEST(Sleep, SleeperOnWhatIsTakenOutWakes) {
  WorldSettings settings;
  settings.sleep = true;
  RrlinearWorld at_rest(settings);
  const auto build = [](RrlinearWorld& world) {
    world.add_mesh(make_box({-20, -20, -2}, {20, 20, 0}), {0.4, 0.4}, Motion::fixed(Pose{}));
    world.add_spheres({ball({0, 0, kRadius}), ball({0, 0, 3 * kRadius})});
    world.advance_to(10);
  };
  build(at_rest);
  settings.domain_low = {at_rest.snapshot().grains[0].position.x() - 1e-9, -5, -5};
  RrlinearWorld world(settings);
  build(world);
  ASSERT_EQ(world.statistics().asleep, 2);
  world.set_velocity(0, {-5e-3, 0, 0}, Vec3::Zero());
  for (int k = 1; k <= 200; ++k) world.advance_to(10 + 0.01 * k);  // looked at while it is over the border
  EXPECT_EQ(world.statistics().lost_particles, 1);
  const std::vector<Grain> left = world.snapshot().grains;
  ASSERT_EQ(left.size(), 1u);
  EXPECT_LT(left.front().position.z(), 1.5 * kRadius);
}

// Rock that slept on the floor is given a velocity in the moment in which a mesh elsewhere is taken away.
// What is removed is the wall that it touches, as the gate of a truck.
TEST(Sleep, PushWakesWhileTheSceneChanges) {
  Bench b({ball({0, 0, kRadius})});
  const int other =
      b.world.add_mesh(make_box({0.999 * kRadius, -1, 0}, {1, 1, 1}), {0.4, 0.4}, Motion::fixed(Pose{}));
  b.world.advance_to(10);
  ASSERT_FALSE(b.world.mesh_contacts(0).empty());
  ASSERT_EQ(b.world.statistics().asleep, 1);
  const double x = b.grain(0).position.x();
  b.world.remove_mesh(other);
  b.world.set_velocity(0, {2, 0, 0}, Vec3::Zero());
  b.world.advance_to(10.1);
  EXPECT_EQ(b.world.statistics().asleep, 0);
  EXPECT_GT(b.grain(0).position.x() - x, 0.1);
}

// What has left the model does not come back when what it touched leaves it, too.
TEST(Sleep, WhatIsTakenOutIsNotWoken) {
  Bench b({ball({0, 0, kRadius}), ball({0, 0, 3 * kRadius}), ball({5, 0, kRadius})});
  b.world.advance_to(10);
  ASSERT_EQ(b.world.statistics().asleep, 3);
  b.world.take_out([](const Vec3& place) { return place.x() < 1; });
  b.world.advance_to(11);
  EXPECT_EQ(b.world.statistics().asleep, 1);
  EXPECT_EQ(b.world.snapshot().grains.size(), 1u);
  for (int i = 0; i < b.world.spheres().size(); ++i)
    if (b.world.spheres().lost[i]) {
      EXPECT_TRUE(b.world.spheres().velocity[i].vec().isZero() && !b.world.spheres().asleep[i]) << i;
    }
}

// A tool goes by a millimetre from it, for longer than a ball needs to fall asleep.
TEST(Sleep, BallBesideAToolThatMovesStaysAwake) {
  Bench b({ball({0, 0, kRadius}), ball({0, 5, kRadius})});
  b.world.add_mesh(make_box({kRadius + 0.001, -4, 0.01}, {kRadius + 1, 4, 1}), {0.4, 0.4},
                   Motion({{0.0, Pose{}}, {20.0, Pose{{0, 0.5, 0}, Quaternion::Identity()}}}));
  b.world.advance_to(10);
  EXPECT_EQ(b.world.statistics().asleep, 1) << "the one far from the tool";
}

std::vector<NewSphere> heap() {
  std::vector<NewSphere> spheres;
  for (int k = 0; k < 60; ++k)
    spheres.push_back(ball(
        {0.65 * (k % 3) + 0.01 * (k % 7), 0.65 * ((k / 3) % 3) + 0.01 * (k % 5), 0.35 + 0.65 * (k / 9)}));
  return spheres;
}

// Woken without a disturbance, a heap stays where it slept. What was left of its motion when it fell asleep,
// at most 0.5 % of the radius a window, may still come: most settle by less than 2 %, and one that was slowly
// toppling goes on.
TEST(Sleep, HeapWokenWithoutADisturbanceDoesNotMove) {
  Bench b(heap());
  b.world.advance_to(15);
  ASSERT_EQ(b.world.statistics().asleep, 60);
  const Snapshot before = b.world.snapshot();
  for (const Grain& g : before.grains) b.world.set_velocity(g.id, Vec3::Zero(), Vec3::Zero());
  b.world.advance_to(15.001);
  EXPECT_EQ(b.world.statistics().asleep, 0);
  b.world.advance_to(20);
  EXPECT_EQ(b.world.statistics().asleep, 60);
  const Snapshot after = b.world.snapshot();
  int moved = 0;
  for (std::size_t i = 0; i < before.grains.size(); ++i)
    if ((after.grains[i].position - before.grains[i].position).norm() > 0.02 * kRadius) ++moved;
  EXPECT_LE(moved, 1);  // of 60
}

// A block of 100 times the mass falls on a heap: as many spheres are moved as in a heap that never slept.
TEST(Sleep, LargeFallWakesDeeply) {
  int moved[2] = {0, 0};
  double sunk[2] = {0, 0};
  for (const bool sleep : {false, true}) {
    Bench b(heap(), sleep);
    b.world.advance_to(15);
    ASSERT_EQ(b.world.statistics().asleep, sleep ? 60 : 0);
    const Snapshot before = b.world.snapshot();
    b.world.add_spheres({ball({0.65, 0.65, 8}, Vec3::Zero(), 1.4)});
    b.world.advance_to(20);
    const Snapshot after = b.world.snapshot();
    for (std::size_t i = 0; i < before.grains.size(); ++i) {
      const double way = (after.grains[i].position - before.grains[i].position).norm();
      if (way > 0.1 * kRadius) ++moved[sleep];
      sunk[sleep] += before.grains[i].position.z() - after.grains[i].position.z();
    }
  }
  EXPECT_GT(moved[0], 30);
  EXPECT_NEAR(moved[1], moved[0], 0.15 * moved[0]);
  EXPECT_NEAR(sunk[1], sunk[0], 0.2 * sunk[0]);
}

// The same heap with and without sleep. A sleeper is frozen within 0.5 % of its radius a window, so a heap
// may differ by some of these.
TEST(Sleep, HeapIsThatOfAWorldThatNeverSleeps) {
  const std::vector<NewSphere> spheres = heap();
  Bench with(spheres), without(spheres, false);
  with.world.advance_to(15);
  without.world.advance_to(15);
  EXPECT_GT(with.world.statistics().asleep, 50);
  double top_with = 0, top_without = 0, mean = 0;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    top_with = std::max(top_with, with.grain(i).position.z());
    top_without = std::max(top_without, without.grain(i).position.z());
    mean += (with.grain(i).position.z() - without.grain(i).position.z()) / double(spheres.size());
  }
  EXPECT_NEAR(top_with, top_without, kRadius);
  EXPECT_NEAR(mean, 0, 0.1 * kRadius);
}

}  // namespace
}  // namespace scree
