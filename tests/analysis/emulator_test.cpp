// The emulator and the posterior against functions that are known.
#include "analysis/statistics/emulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "analysis/statistics/calibration.h"

namespace scree {
namespace {

// A repose angle over friction: rises and levels off.
double angle(double mu) {
  return 12 + 30 * (1 - std::exp(-3 * mu));
}

struct Data {
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
};

// `seeds` noisy values at each of `points` places along a line.
Data line(int points, int seeds, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, noise);
  Data data{Eigen::MatrixXd(points * seeds, 1), Eigen::VectorXd(points * seeds)};
  for (int p = 0; p < points; ++p)
    for (int s = 0; s < seeds; ++s) {
      data.x(p * seeds + s, 0) = static_cast<double>(p) / (points - 1);
      data.y[p * seeds + s] = angle(data.x(p * seeds + s, 0)) + error(random);
    }
  return data;
}

Eigen::VectorXd at(double x) {
  return Eigen::VectorXd::Constant(1, x);
}

TEST(Emulator, FollowsWhatIsExact) {
  const Data data = line(20, 1, 0.0, 1);
  const Emulator emulator(data.x, data.y);
  for (double x = 0.03; x < 1; x += 0.05) {
    const Prediction p = emulator.at(at(x));
    EXPECT_NEAR(p.mean, angle(x), 0.005 * (angle(1) - angle(0))) << x;
    EXPECT_LT(p.std, 0.01 * (angle(1) - angle(0))) << x;
  }
}

TEST(Emulator, TellsNoiseFromIgnorance) {
  const Data few = line(6, 2, 1.3, 2), many = line(12, 20, 1.3, 3);
  const Emulator unsure(few.x, few.y), sure(many.x, many.y);
  // 240 values: the noise is known to 1 / sqrt(2 * 239) of itself, the mean to about 1.3 / sqrt(20).
  EXPECT_NEAR(sure.at(at(0.5)).noise, 1.3, 3 * 1.3 / std::sqrt(2 * 239.0));
  EXPECT_LT(sure.at(at(0.5)).std, 1.3 / std::sqrt(20.0));
  EXPECT_GT(unsure.at(at(0.5)).std, sure.at(at(0.5)).std);
}

TEST(Emulator, IntervalsCoverTheTruth) {
  int inside = 0, all = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Data data = line(5, 2, 1.0, 100 + seed);
    const Emulator emulator(data.x, data.y);
    for (double x = 0.03; x < 1; x += 0.07) {
      const Prediction p = emulator.at(at(x));
      inside += std::abs(p.mean - angle(x)) < 1.645 * p.std ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GT(inside, 0.82 * all);  // 90 % are promised
}

TEST(Emulator, LearnsWhichParameterMatters) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  Eigen::MatrixXd x(30, 2);
  Eigen::VectorXd y(30);
  for (int k = 0; k < 30; ++k) {
    x(k, 0) = share(random), x(k, 1) = share(random);
    y[k] = angle(x(k, 0));
  }
  const Emulator emulator(x, y);
  for (const double other : {0.1, 0.5, 0.9})
    EXPECT_NEAR(emulator.at(Eigen::Vector2d(0.4, other)).mean, angle(0.4), 0.3);
}

TEST(Emulator, ConstantIsConstant) {
  Eigen::MatrixXd x(5, 1);
  x << 0, 0.25, 0.5, 0.75, 1;
  const Emulator emulator(x, Eigen::VectorXd::Constant(5, 7.0));
  EXPECT_NEAR(emulator.at(at(0.6)).mean, 7.0, 1e-9);
  EXPECT_LT(emulator.at(at(0.6)).std, 1e-3);
  EXPECT_THROW(Emulator(x.topRows(3), Eigen::VectorXd::Zero(3)), std::invalid_argument);
}

// With an emulator that is sure the posterior of mu is normal about angle^-1(target), its deviation that of
// the target over the slope.
TEST(Posterior, IsTheTargetSeenThroughTheCurve) {
  const Data data = line(30, 1, 0.0, 1);
  const Emulator emulator(data.x, data.y);
  const double truth = 0.3, uncertainty = 0.5, slope = 30 * 3 * std::exp(-3 * truth);
  const Posterior posterior({{angle(truth), uncertainty, &emulator}}, 1);
  const auto interval = posterior.interval(0, 0.9);
  EXPECT_NEAR(posterior.most_likely()[0], truth, 0.005);
  EXPECT_NEAR(0.5 * (interval[1] - interval[0]), 1.645 * uncertainty / slope, 0.1 * uncertainty / slope);
  EXPECT_LT(posterior.excess_uncertainty(), 0.01);
}

// Where the emulator is not sure the likelihood is wider: the density of every node against that of the first
// is that of normal numbers with the variances of target and emulator together.
TEST(Posterior, AddsTheEmulatorsUncertaintyToTheTargets) {
  Eigen::MatrixXd x(4, 1);
  x << 0, 0.1, 0.2, 1.0;
  Eigen::VectorXd y(4);
  for (int k = 0; k < 4; ++k) y[k] = angle(x(k, 0));
  const Emulator emulator(x, y);
  const double value = angle(0.5), uncertainty = 0.5;
  const Posterior posterior({{value, uncertainty, &emulator}}, 1);
  double least_sure = 0;
  const auto log_normal = [&](std::size_t node) {
    const Prediction p = emulator.at(posterior.point(node));
    const double variance = uncertainty * uncertainty + p.std * p.std;
    least_sure = std::max(least_sure, p.std);
    return -0.5 * (std::log(variance) + (p.mean - value) * (p.mean - value) / variance);
  };
  // From the likeliest node outwards, as far as densities are above rounding.
  std::size_t top = 0;
  for (std::size_t node = 0; node < posterior.size(); ++node)
    if (posterior.density(node) > posterior.density(top)) top = node;
  for (std::size_t node = 0; node < posterior.size(); ++node) {
    if (!(posterior.density(node) > 1e-12 * posterior.density(top))) continue;
    EXPECT_NEAR(std::log(posterior.density(node) / posterior.density(top)),
                log_normal(node) - log_normal(top), 1e-9);
  }
  EXPECT_GT(least_sure, uncertainty);  // there is something to add
}

TEST(Posterior, AsksWhereItMatters) {
  Eigen::MatrixXd x(4, 1);
  x << 0, 0.1, 0.2, 1.0;
  Eigen::VectorXd y(4);
  for (int k = 0; k < 4; ++k) y[k] = angle(x(k, 0));
  const Emulator emulator(x, y);
  const Posterior posterior({{angle(0.5), 0.5, &emulator}}, 1);
  EXPECT_GT(posterior.excess_uncertainty(), 0.1);
  const auto next = posterior.next_points(2);
  EXPECT_GT(next[0][0], 0.25);
  EXPECT_LT(next[0][0], 0.95);
  EXPECT_GT(std::abs(next[1][0] - next[0][0]), 0.05);
}

TEST(Calibration, LevelsAreFoundAlongBothAxes) {
  // z = 3 x + 2 y; the level 4 runs from (0, 2) to (4/3, 0).
  ParameterMap map{{0, 1, 2}, {0, 2}, {{0, 3, 6}, {4, 7, 10}}};
  EXPECT_NEAR(map.at(0.5, 1.5), 4.5, 1e-12);
  const auto pairs = level_pairs(map, 4.0);
  ASSERT_GT(pairs.size(), 100u);
  for (const auto& [x, y] : pairs) EXPECT_NEAR(3 * x + 2 * y, 4, 1e-9);
  EXPECT_NEAR(pairs.front()[0], 0, 1e-12);
  EXPECT_NEAR(pairs.back()[0], 4.0 / 3, 0.02);
  EXPECT_NEAR(level_where_equal(map, 4.0), 0.8, 1e-9);
  EXPECT_TRUE(std::isnan(level_where_equal(map, 40.0)));
  EXPECT_NEAR(crossing(map.x, map.value[0], 4.5), 1.5, 1e-12);
  // A level within one cell, off every node's column: table B.2 has 25.4 between mu = 0.1 and 0.3 only.
  map.value = {{10, 20, 30}, {10, 20, 30}};
  EXPECT_FALSE(level_pairs(map, 25.4).empty());
}

TEST(Posterior, KnowsWhenItsRangeCutsItOff) {
  const Data data = line(30, 1, 0.0, 1);
  const Emulator emulator(data.x, data.y);
  EXPECT_FALSE(Posterior({{angle(0.4), 0.5, &emulator}}, 1).cut_off(0));
  EXPECT_TRUE(Posterior({{angle(0.0) - 3, 0.5, &emulator}}, 1).cut_off(0));
  EXPECT_TRUE(Posterior({{angle(0.5), 500, &emulator}}, 1).cut_off(0));
}

}  // namespace
}  // namespace scree
