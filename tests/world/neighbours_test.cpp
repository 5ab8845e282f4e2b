// NeighbourGrid and PairList against all pairs of spheres, one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "sim/material/random.h"
#include "sim/world/grid.h"
#include "sim/world/pair_list.h"
#include "sim/world/spheres.h"
#include "tests/world/random_spheres.h"

namespace scree {
namespace {

using Pair = std::pair<int, int>;

double gap(const Spheres& s, int i, int j) {
  const double d = (s.place[i].vec() - s.place[j].vec()).norm();
  return d - s.place[i].w - s.place[j].w;
}

// All pairs, by their owners; checks that both rows of a pair know of it.
std::set<Pair> listed_pairs(const PairList& list) {
  std::set<Pair> pairs;
  for (int i = 0; i < list.rows(); ++i) {
    const auto row = list.neighbours(i);
    for (std::size_t k = 1; k < row.size(); ++k) EXPECT_LT(row[k - 1].sphere, row[k].sphere);
    EXPECT_EQ(row.size() - list.owned(i).size(),
              static_cast<std::size_t>(
                  std::count_if(row.begin(), row.end(), [&](const Neighbour& n) { return n.sphere < i; })));
    for (const Neighbour& n : list.owned(i)) {
      EXPECT_GT(n.sphere, i);
      pairs.emplace(i, n.sphere);
      if (n.sphere >= list.rows()) continue;
      const auto other = list.neighbours(n.sphere);
      const auto back =
          std::find_if(other.begin(), other.end(), [&](const Neighbour& m) { return m.sphere == i; });
      EXPECT_NE(back, other.end());
      if (back != other.end()) {
        EXPECT_EQ(back->memory(), n.memory());
      }
    }
  }
  return pairs;
}

std::vector<int> all_in_the_model(const Spheres& s) {
  std::vector<int> spheres;
  for (int i = 0; i < s.movable; ++i)
    if (!s.lost[i]) spheres.push_back(i);
  return spheres;
}

// What a step does: marks pairs that touch, and gives each a memory of its own; returns it by pair.
std::map<Pair, double> touch(PairList& list, const Spheres& s, double& next) {
  std::map<Pair, double> memory;
  for (int i = 0; i < list.rows(); ++i)
    for (Neighbour& n : list.owned(i)) {
      ContactMemory& contact = list.memory(n);
      if (gap(s, i, n.sphere) >= 0) {
        n.tag &= ~1u;
        contact = {};
        continue;
      }
      if (!n.touching()) {
        n.tag |= 1u;
        contact.shear[0] = contact.rolling[1] = static_cast<float>(next);
        next += 1;
      }
      memory[{i, n.sphere}] = contact.shear[0];
    }
  return memory;
}

// By ratio of diameters.
class Grid : public testing::TestWithParam<double> {};

TEST_P(Grid, QueryFindsEveryOverlapOfReachesOnce) {
  const int count = 400;
  const Spheres s = random_spheres(count, 0, 5, GetParam());
  NeighbourGrid grid;
  grid.reset(count, 1.0 / GetParam(), 1.0);
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
        const double range = grid.site(i).w + grid.site(j).w;
        if ((grid.site(i).vec() - grid.site(j).vec()).norm() < range)
          EXPECT_EQ(found.count(j), 1u);
        else
          EXPECT_LE(found.count(j), 1u);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ratios, Grid, testing::Values(27.0, 100.0));

// By ratio of diameters and number of threads.
class Pairs : public testing::TestWithParam<std::tuple<double, int>> {};

TEST_P(Pairs, EveryOverlapIsListedOnceAndKeepsItsMemoryOverRepairs) {
  const int count = 300, fixed = 40;
  const auto [ratio, threads] = GetParam();
  Spheres s = random_spheres(count, fixed, 7, ratio);
  Random random(8, 0, RandomPurpose::positions);
  Team team(threads);
  PairList list;
  list.set_team(&team);
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
      left = list.way_out2(i, s.place[i]) > 1 || left;
    }
    if (repairs == 100 && !s.lost[11]) {
      s.lost[11] = 1;
      list.drop(11);
      left = true;
    }
    if (left) {
      list.repair(s, all_in_the_model(s), 1.0);
      ++repairs;
    }
    const std::set<Pair> pairs = listed_pairs(list);
    int missing = 0;
    for (int i = 0; i < s.movable; ++i)
      for (int j = i + 1; j < count; ++j) {
        if (s.lost[i] || s.lost[j]) continue;
        if (gap(s, i, j) < 0 && !pairs.count({i, j})) ++missing;
      }
    ASSERT_EQ(missing, 0) << "after repair " << repairs;
    for (const Pair& pair : pairs) ASSERT_FALSE(s.lost[pair.first] || s.lost[pair.second]);
    std::set<std::uint32_t> memories;
    for (int i = 0; i < list.rows(); ++i)
      for (const Neighbour& n : std::as_const(list).owned(i)) {
        ASSERT_TRUE(memories.insert(n.memory()).second) << "two pairs share a memory";
        const auto before = memory.find({i, n.sphere});
        if (before == memory.end()) {
          ASSERT_FALSE(n.touching());
          ASSERT_EQ(list.memory(n).shear[0], 0.0);
          continue;
        }
        if (gap(s, i, n.sphere) >= 0) continue;  // has parted
        ASSERT_TRUE(n.touching());
        ASSERT_EQ(list.memory(n).shear[0], before->second);
        ASSERT_EQ(list.memory(n).rolling[1], before->second);
        ++kept;
      }
    memory = touch(list, s, next);
  }
  EXPECT_GT(kept, 1000);
}

INSTANTIATE_TEST_SUITE_P(RatiosAndThreads, Pairs,
                         testing::Combine(testing::Values(27.0, 100.0), testing::Values(1, 4)));

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
    for (const Neighbour& n : std::as_const(list).owned(i)) {
      if (!n.touching()) continue;
      const auto before = memory.find({count - 1 - n.sphere, count - 1 - i});
      ASSERT_NE(before, memory.end());
      EXPECT_EQ(list.memory(n).shear[0], -before->second);
      EXPECT_EQ(list.memory(n).rolling[1], -before->second);
      ++found;
    }
  EXPECT_EQ(found, memory.size());
}

}  // namespace
}  // namespace scree
