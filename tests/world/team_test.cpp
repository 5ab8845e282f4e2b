// Loops shared by threads: each index is done once, whoever comes or stays away.
#include "sim/world/team.h"

#include <gtest/gtest.h>

#include <new>
#include <vector>

namespace scree {
namespace {

class Teams : public testing::TestWithParam<int> {};

TEST_P(Teams, DoEveryIndexOnceJobAfterJob) {
  Team team(GetParam()), other(2);
  std::vector<int> done(50);
  for (int job = 0; job < 20000; ++job) {
    const int count = job % 51;
    // Nothing is atomic here: what one job wrote, the next may read.
    team.run(count, [&](int k) { done[static_cast<std::size_t>(k)] += k + 1; });
    if (job % 100 == 0) other.run(3, [](int) {});
  }
  for (int k = 0; k < 50; ++k) {
    int jobs = 0;
    for (int job = 0; job < 20000; ++job) jobs += job % 51 > k ? 1 : 0;
    EXPECT_EQ(done[static_cast<std::size_t>(k)], jobs * (k + 1)) << k;
  }
}

TEST_P(Teams, TellWhatABodyThrowsAndWorkOn) {
  Team team(GetParam());
  for (int job = 0; job < 200; ++job) {
    EXPECT_THROW(team.run(20,
                          [&](int k) {
                            if (k == job % 20) throw std::bad_alloc();
                          }),
                 std::bad_alloc);
    std::vector<int> done(20);
    team.run(20, [&](int k) { done[static_cast<std::size_t>(k)] = 1; });
    EXPECT_EQ(done, std::vector<int>(20, 1));
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, Teams, testing::Values(1, 2, 4));

}  // namespace
}  // namespace scree
