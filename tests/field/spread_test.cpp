// Statistics over pictures against numbers worked by hand and printed tables.
#include "analysis/field/spread.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <stdexcept>

#include "analysis/field/anderson_darling.h"
#include "analysis/field/origin_fit.h"

namespace scree {
namespace {

std::vector<double> normal_quantiles(int n) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) values.push_back(quantile(boost::math::normal(3, 2), (i + 0.5) / n));
  return values;
}

// A2 = -n - sum (2i - 1) (ln F(x_i) + ln(1 - F(x_n+1-i))) / n, Anderson and Darling (1954).
double by_its_sum(std::vector<double> x) {
  std::sort(x.begin(), x.end());
  const MeanStd both = mean_std(x);
  const boost::math::normal fitted(both.mean, both.std);
  const double n = static_cast<double>(x.size());
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += (2.0 * static_cast<double>(i) + 1) *
           (std::log(cdf(fitted, x[i])) + std::log(cdf(complement(fitted, x[x.size() - 1 - i]))));
  return (-n - sum / n) * (1 + 0.75 / n + 2.25 / (n * n));
}

TEST(AndersonDarling, StatisticIsItsSum) {
  const std::vector<double> skewed{1, 1.1, 1.3, 1.35, 1.7, 2.2, 3, 4.5, 9, 14};
  EXPECT_NEAR(anderson_darling(skewed).statistic, by_its_sum(skewed), 1e-9);
  EXPECT_NEAR(anderson_darling(normal_quantiles(42)).statistic, by_its_sum(normal_quantiles(42)), 1e-9);
}

// Stephens's 5 % point of A2* is 0.752 and the 1 % point 1.035: samples just around them.
TEST(AndersonDarling, TellsSkewFromNormal) {
  EXPECT_GT(anderson_darling(normal_quantiles(42)).p, 0.9);
  std::vector<double> logarithmic;
  for (const double value : normal_quantiles(42)) logarithmic.push_back(std::exp(value / 2));
  EXPECT_LT(anderson_darling(logarithmic).p, 0.001);
  const Spread spread = spread_over(logarithmic);
  EXPECT_LT(spread.normal.p, 0.001);
  EXPECT_GT(spread.lognormal.p, 0.9);
  // Stretched until the statistic passes the 5 % point, p passes 0.05.
  for (double power = 1; power < 3; power += 0.02) {
    std::vector<double> stretched;
    for (const double value : normal_quantiles(30)) stretched.push_back(std::exp(power * value / 6));
    const NormalityTest test = anderson_darling(stretched);
    if (std::abs(test.statistic - 0.752) > 0.01) {
      EXPECT_EQ(test.p<0.05, test.statistic> 0.752) << power;
    }
    if (std::abs(test.statistic - 1.035) > 0.01) {
      EXPECT_EQ(test.p<0.01, test.statistic> 1.035) << power;
    }
  }
}

TEST(AndersonDarling, SaysNothingOfFewOrEqualValues) {
  EXPECT_FALSE(anderson_darling({1, 2, 3, 4, 5, 6, 7}).known);
  EXPECT_FALSE(anderson_darling(std::vector<double>(20, 3.0)).known);
  EXPECT_FALSE(anderson_darling({}).known);
}

TEST(SampleQuantile, IsLinearBetweenSortedValues) {
  EXPECT_DOUBLE_EQ(sample_quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(sample_quantile({4, 1, 3, 2}, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(sample_quantile({4, NAN, 1}, 1), 4);
  EXPECT_TRUE(std::isnan(sample_quantile({NAN}, 0.5)));
}

TEST(Histogram, BordersBelongToTheBinAbove) {
  // 0.15 / 0.05 is 2.9999999999999996 in binary.
  const Histogram bins = histogram({0.15, 0.19, 0.2, 0.31}, 0.05);
  EXPECT_DOUBLE_EQ(bins.share_at(0.15), 0.5);
  EXPECT_DOUBLE_EQ(bins.share_at(0.2), 0.25);
  EXPECT_DOUBLE_EQ(bins.share_at(0.26), 0);
  EXPECT_DOUBLE_EQ(bins.share_at(9), 0);
  EXPECT_NEAR(bins.middle(bins.mode()), 0.175, 1e-12);
  EXPECT_EQ(bins.shares.size(), 4u);
  EXPECT_THROW(histogram({}, 1), std::invalid_argument);
  EXPECT_THROW(histogram({1}, 0), std::invalid_argument);
}

TEST(BinWidth, IsARoundNumberBelowScotts) {
  // std 1 of 8 values: 3.49 / 2 = 1.745.
  const double s = std::sqrt(7.0 / 8);
  EXPECT_DOUBLE_EQ(bin_width({s, -s, s, -s, s, -s, s, -s}), 1);
  EXPECT_DOUBLE_EQ(bin_width({4 * s, -4 * s, 4 * s, -4 * s, 4 * s, -4 * s, 4 * s, -4 * s}), 5);
  EXPECT_DOUBLE_EQ(bin_width({1, 1, 1}), 1);
}

TEST(OriginFit, ByHand) {
  // slope (1*2 + 2*3 + 3*7) / 14 = 29/14; residuals about it: sum y^2 - slope sum xy = 62 - 29^2 / 14.
  const OriginFit fit = fit_through_origin({1, 2, 3, NAN}, {2, 3, 7, 1});
  EXPECT_EQ(fit.n, 3);
  EXPECT_NEAR(fit.slope, 29.0 / 14, 1e-12);
  const double residual = 62 - 29.0 * 29 / 14;
  EXPECT_NEAR(fit.r2, 1 - residual / 62, 1e-12);
  EXPECT_NEAR(fit.r2_of_mean, 1 - residual / (62 - 48), 1e-12);
  EXPECT_NEAR(fit.error, std::sqrt(residual / 2 / 14), 1e-12);
  EXPECT_TRUE(std::isnan(fit_through_origin({1}, {1}).slope));
  EXPECT_THROW(fit_through_origin({1, 2}, {1}), std::invalid_argument);
}

TEST(OriginFit, ValuesOfOneSignLookGoodAboutZero) {
  // y does not depend on x: the line is worse than the mean, and R2 about zero is large all the same.
  const OriginFit fit = fit_through_origin({4, 5, 6, 7}, {1, 1.1, 0.9, 1});
  EXPECT_GT(fit.r2, 0.9);
  EXPECT_LT(fit.r2_of_mean, 0);
}

}  // namespace
}  // namespace scree
