// Designs fill their space.
#include "cli/ensemble/design.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

TEST(Design, LatinHypercubeHasOnePointASlice) {
  const int count = 50;
  const UnitPoints points = latin_hypercube(count, 3, 7);
  ASSERT_EQ(points.size(), 50u);
  for (std::size_t d = 0; d < 3; ++d) {
    std::vector<int> slices;
    for (const auto& point : points) slices.push_back(static_cast<int>(std::floor(point[d] * count)));
    std::sort(slices.begin(), slices.end());
    for (int k = 0; k < count; ++k) EXPECT_EQ(slices[static_cast<std::size_t>(k)], k);
  }
  EXPECT_EQ(points, latin_hypercube(count, 3, 7));
  EXPECT_NE(points, latin_hypercube(count, 3, 8));
}

// Of the first 2^m - 1 points after the origin every slice of width 2^-m but the one at zero holds one.
TEST(Design, SobolFillsDyadicSlices) {
  const UnitPoints points = sobol(63, 4);
  for (std::size_t d = 0; d < 4; ++d) {
    std::vector<int> slices;
    for (const auto& point : points) slices.push_back(static_cast<int>(std::floor(point[d] * 64)));
    std::sort(slices.begin(), slices.end());
    for (int k = 0; k < 63; ++k) EXPECT_EQ(slices[static_cast<std::size_t>(k)], k + 1) << d;
  }
}

TEST(Design, MoreSobolPointsBeginAlike) {
  const UnitPoints few = sobol(10, 2), many = sobol(40, 2);
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
}

}  // namespace
}  // namespace scree
