#include "sim/material/in_parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <latch>
#include <stdexcept>
#include <thread>
#include <vector>

namespace scree {
namespace {

TEST(InParallel, SharesTheWork) {
  std::vector<std::atomic<int>> done(1000);
  in_parallel(done.size(), 4, [&](std::size_t k) { ++done[k]; });
  for (const auto& each : done) EXPECT_EQ(each, 1);
  in_parallel(0, 4, [](std::size_t) { FAIL(); });
  std::latch both(2);  // each waits for the other
  in_parallel(2, 2, [&](std::size_t) { both.arrive_and_wait(); });
}

TEST(InParallel, ThrowsWhatTheFirstThrewWhenAllHaveEnded) {
  for (const int threads : {1, 4}) {
    std::atomic<int> under_way{0}, done{0};
    EXPECT_THROW(in_parallel(1000, threads,
                             [&](std::size_t k) {
                               ++under_way;
                               std::this_thread::sleep_for(std::chrono::milliseconds(1));
                               --under_way;
                               if (k == 5) throw std::out_of_range("five");
                               ++done;
                             }),
                 std::out_of_range);
    EXPECT_EQ(under_way, 0);
    EXPECT_LT(done, 900) << "what was not begun is left";
  }
}

}  // namespace
}  // namespace scree
