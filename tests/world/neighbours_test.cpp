// NeighbourGrid and PairList against all pairs of spheres, one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sim/material/random.h"
#include "sim/world/grid.h"
#include "sim/world/pair_list.h"
#include "sim/world/spheres.h"

namespace scree {
namespace {

using Pair = std::pair<int, int>;

// Radii from 1/27 to 1 (log-uniform) in a cube that makes them overlap here and there; the last `fixed` do
// not move.
Spheres random_spheres(int count, int fixed, std::uint64_t seed) {
  Random random(seed, 0, RandomPurpose::positions);
  Spheres s;
  for (int i = 0; i < count; ++i) {
    const double radius = std::pow(27.0, -random.uniform());
    Quad place;
    place.set({random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)});
    place.w = radius;
    s.place.push_back(place);
    Quad velocity;
    velocity.w = radius * radius * radius;
    s.velocity.push_back(velocity);
    s.spin.emplace_back();
    s.force.emplace_back();
    s.torque.emplace_back();
    s.id.push_back(i);
    s.dump.push_back(1);
    s.lost.push_back(0);
    s.asleep.push_back(0);
  }
  s.movable = count - fixed;
  return s;
}

double gap(const Spheres& s, int i, int j) {
  const double d = (s.place[i].vec() - s.place[j].vec()).norm();
  return d - s.place[i].w - s.place[j].w;
}

std::set<Pair> listed_pairs(const PairList& list, int count) {
  std::set<Pair> pairs;
  EXPECT_EQ(list.rows(), count);
  for (int i = 0; i < list.rows(); ++i)
    for (int p = list.begin(i); p < list.end(i); ++p) {
      EXPECT_LT(i, list.partner(p));
      EXPECT_TRUE(pairs.emplace(i, list.partner(p)).second)
          << "listed twice: " << i << " " << list.partner(p);
      if (p > list.begin(i)) {
        EXPECT_LT(list.partner(p - 1), list.partner(p));
      }
    }
  return pairs;
}

// What a step does: marks pairs that touch, and gives each a memory of its own; returns it by pair.
std::map<Pair, double> touch(PairList& list, const Spheres& s, double& next) {
  std::map<Pair, double> memory;
  for (int i = 0; i < list.rows(); ++i)
    for (int p = list.begin(i); p < list.end(i); ++p) {
      if (gap(s, i, list.partner(p)) >= 0) {
        list.touching[p] = 0;
        list.history[p] = {};
        continue;
      }
      if (!list.touching[p]) {
        list.touching[p] = 1;
        list.history[p].shear = Vec3(next, 0, 0);
        list.history[p].rolling = Vec3(0, next, 0);
        next += 1;
      }
      memory[{i, list.partner(p)}] = list.history[p].shear.x();
    }
  return memory;
}

TEST(NeighbourGrid, QueryFindsEveryOverlapOfReachesOnce) {
  const int count = 400;
  const Spheres s = random_spheres(count, 0, 5);
  NeighbourGrid grid;
  grid.reset(count, 1.0 / 27, 1.0);
  Random random(6, 0, RandomPurpose::positions);
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < count; ++i)
      grid.place(i,
                 s.place[i].vec() +
                     Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) * round,
                 std::min(1.0, s.place[i].w * random.uniform(1.0, 1.5)));
    if (round == 3) grid.remove(7);
    for (int i = 0; i < count; ++i) {
      if (round == 3 && i == 7) continue;
      std::multiset<int> found;
      grid.query(i, [&](int j) { found.insert(j); });
      for (int j = 0; j < count; ++j) {
        if (j == i || (round == 3 && j == 7)) {
          EXPECT_EQ(found.count(j), 0u);
          continue;
        }
        const double range = grid.reach(i) + grid.reach(j);
        if ((grid.position(i) - grid.position(j)).norm() < range)
          EXPECT_EQ(found.count(j), 1u);
        else
          EXPECT_LE(found.count(j), 1u);
      }
    }
  }
}

TEST(PairList, EveryOverlapIsListedOnceAndKeepsItsMemoryOverRepairs) {
  const int count = 300, fixed = 40;
  Spheres s = random_spheres(count, fixed, 7);
  Random random(8, 0, RandomPurpose::positions);
  PairList list;
  std::vector<int> order(count, -1);
  list.rebuild(s, order, 0.0);
  double next = 1;
  int repairs = 0, kept = 0;
  std::map<Pair, double> memory = touch(list, s, next);
  while (repairs < 200) {
    // Small moves of all, large ones of a few; a dropped sphere stays where it is.
    bool left = false;
    for (int i = 0; i < s.movable; ++i) {
      if (s.lost[i]) continue;
      const double reach = random.uniform() < 0.01 ? 1.5 : 0.02 * s.place[i].w;
      const Vec3 move(random.uniform(-reach, reach), random.uniform(-reach, reach),
                      random.uniform(-reach, reach));
      s.velocity[i].set(move);
      s.place[i].add(move);
      left = list.left_skin(i, s.place[i]) || left;
    }
    if (repairs == 100 && !s.lost[11]) {
      s.lost[11] = 1;
      list.drop(11);
      left = true;
    }
    if (left) {
      list.repair(s, 1.0);
      ++repairs;
    }
    const std::set<Pair> pairs = listed_pairs(list, count);
    int missing = 0;
    for (int i = 0; i < s.movable; ++i)
      for (int j = i + 1; j < count; ++j) {
        if (s.lost[i] || s.lost[j]) continue;
        if (gap(s, i, j) < 0 && !pairs.count({i, j})) ++missing;
      }
    ASSERT_EQ(missing, 0) << "after repair " << repairs;
    for (const Pair& pair : pairs) ASSERT_FALSE(s.lost[pair.first] || s.lost[pair.second]);
    for (int p = 0; p < static_cast<int>(list.size()); ++p) {
      const Pair pair{list.owner(p), list.partner(p)};
      ASSERT_TRUE(p >= list.begin(pair.first) && p < list.end(pair.first));
      const auto before = memory.find(pair);
      if (before == memory.end()) {
        ASSERT_FALSE(list.touching[p]);
        continue;
      }
      if (gap(s, pair.first, pair.second) >= 0) continue;  // has parted
      ASSERT_TRUE(list.touching[p]);
      ASSERT_EQ(list.history[p].shear.x(), before->second);
      ASSERT_EQ(list.history[p].rolling.y(), before->second);
      ++kept;
    }
    for (int j = 0; j < count; ++j)
      for (int k = list.incoming_begin[j]; k < list.incoming_begin[j + 1]; ++k)
        ASSERT_EQ(list.partner(list.incoming_pair[k]), j);
    memory = touch(list, s, next);
  }
  EXPECT_GT(kept, 1000);
}

TEST(PairList, MemoryFollowsSpheresThatAreRenumbered) {
  const int count = 200;
  Spheres s = random_spheres(count, 0, 9);
  PairList list;
  list.rebuild(s, std::vector<int>(count, -1), 0.0);
  double next = 1;
  const std::map<Pair, double> memory = touch(list, s, next);
  ASSERT_GT(memory.size(), 20u);
  // Backwards: every pair changes its owner, and what acted on piece 1 now acts on piece 2.
  std::vector<int> order(count);
  for (int k = 0; k < count; ++k) order[k] = count - 1 - k;
  std::reverse(s.place.begin(), s.place.end());
  std::reverse(s.velocity.begin(), s.velocity.end());
  list.rebuild(s, order, 0.0);
  std::size_t found = 0;
  for (int i = 0; i < count; ++i)
    for (int p = list.begin(i); p < list.end(i); ++p) {
      if (!list.touching[p]) continue;
      const auto before = memory.find({count - 1 - list.partner(p), count - 1 - i});
      ASSERT_NE(before, memory.end());
      EXPECT_EQ(list.history[p].shear.x(), -before->second);
      EXPECT_EQ(list.history[p].rolling.y(), -before->second);
      ++found;
    }
  EXPECT_EQ(found, memory.size());
}

}  // namespace
}  // namespace scree
