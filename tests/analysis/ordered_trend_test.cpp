// Tests of sign, slope and order against numbers of textbooks or worked out by hand.
#include "analysis/statistics/ordered_trend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace scree {
namespace {

TEST(Sign, OneSidedTByHand) {
  // Mean -2, deviation 1, three values: t = -2 sqrt 3; with two degrees of freedom
  // P(T > t) = 1/2 - t / (2 sqrt(2 + t^2)) = 1/2 - 3.4641 / (2 sqrt 14) = 0.03709.
  const MeanStd sample = mean_std({-1, -2, -3});
  const double p = 0.5 - 2 * std::sqrt(3.0) / (2 * std::sqrt(14.0));
  EXPECT_NEAR(p_of_sign(sample, -1), p, 1e-12);
  EXPECT_NEAR(p_of_sign(sample, -1), 0.03709, 1e-5);
  EXPECT_NEAR(p_of_sign(sample, 1), 1 - p, 1e-12) << "the other side";
  EXPECT_TRUE(std::isnan(p_of_sign(mean_std({-1}), -1))) << "one seed";
  EXPECT_TRUE(std::isnan(p_of_sign(mean_std({-1, -1}), -1))) << "no scatter";
}

TEST(Slope, AnscombesFirstSet) {
  // Anscombe, The American Statistician 27 (1973) 17: slope 0.5001 with standard error 0.1179; p 0.00217,
  // and t at 0.975 with 9 degrees of freedom is 2.2622.
  const Slope s = slope_of({10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5},
                           {8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68});
  EXPECT_NEAR(s.slope, 0.5001, 5e-5);
  EXPECT_NEAR(s.p, 0.00217, 5e-6);
  EXPECT_NEAR(s.high - s.slope, 2.2622 * 0.1179, 1e-4);
  EXPECT_NEAR(s.slope - s.low, s.high - s.slope, 1e-12);
}

TEST(Slope, IsUnknownWithoutTwoPlacesAndHasNoIntervalWithoutScatter) {
  EXPECT_TRUE(std::isnan(slope_of({}, {}).slope));
  EXPECT_TRUE(std::isnan(slope_of({1, 1, 1}, {1, 2, 3}).slope));
  const Slope two = slope_of({1, 3}, {1, 2});
  EXPECT_DOUBLE_EQ(two.slope, 0.5);
  EXPECT_TRUE(std::isnan(two.p));
  EXPECT_TRUE(std::isnan(slope_of({1, 2, 3}, {2, 4, 6}).low));
  EXPECT_THROW(slope_of({1}, {}), std::invalid_argument);
}

TEST(Order, KnowledgeOfPerformance) {
  // Hollander and Wolfe, Nonparametric Statistical Methods, chapter 6 (pieces made by three groups of six):
  // J = 79, its mean 54. Without ties the variance would be 153 (J* = 2.02). With those of 38 and 43 (two
  // each), 44 (three), 40 (four): (12546 - 1530 - 258) / 72 + 360 * 30 / (36 * 4896) + 90 * 22 / (8 * 306)
  // = 150.287; z = 25 / sqrt 150.287 = 2.0393.
  const auto test =
      jonckheere_terpstra({{40, 35, 38, 43, 44, 41}, {38, 40, 47, 44, 40, 42}, {48, 40, 45, 43, 46, 44}});
  EXPECT_DOUBLE_EQ(test.statistic, 79);
  EXPECT_DOUBLE_EQ(test.expected, 54);
  EXPECT_NEAR(test.variance, 150.287, 1e-3);
  EXPECT_NEAR(test.p, 0.0414, 5e-5);
}

TEST(Order, FallingGroupsAreAsFarFromNoOrder) {
  // Two groups of two without ties: J is 0 to 4, mean 2, variance (4 * 3 * 13 - 2 * (2 * 1 * 9)) / 72 = 5/3.
  const auto falling = jonckheere_terpstra({{3, 4}, {1, 2}}), rising = jonckheere_terpstra({{1, 2}, {3, 4}});
  EXPECT_DOUBLE_EQ(falling.statistic, 0);
  EXPECT_DOUBLE_EQ(rising.statistic, 4);
  EXPECT_DOUBLE_EQ(rising.variance, 5.0 / 3);
  EXPECT_DOUBLE_EQ(falling.p, rising.p);
  EXPECT_TRUE(std::isnan(jonckheere_terpstra({{1, 1}, {1}}).p)) << "all the same";
  EXPECT_TRUE(std::isnan(jonckheere_terpstra({}).p));
}

}  // namespace
}  // namespace scree
