#include "analysis/diagnose/misfit.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <stdexcept>
#include <string>

#include "tests/diagnose/synthetic.h"

namespace scree {
namespace {

const double kKnown = std::numeric_limits<double>::infinity();

double p_above(const boost::math::fisher_f& f, double x) {
  return boost::math::cdf(boost::math::complement(f, x));
}

// Of one block with nu degrees of freedom, n numbers and q parameters p is that of F(n - q, nu) at
// chi-square / (n - q); of a known scale that of chi-square on n - q.
TEST(Misfit, OfOneBlockIsFishersF) {
  const Eigen::VectorXd d = Eigen::VectorXd::LinSpaced(6, -1.5, 3);
  const Eigen::MatrixXd covariance = Eigen::VectorXd::LinSpaced(6, 0.5, 2).asDiagonal();
  const double chi2 = d.cwiseAbs2().cwiseQuotient(covariance.diagonal()).sum();
  for (const int fitted : {0, 2}) {
    std::vector<ScatterBlock> blocks{{{0, 1, 2, 3, 4, 5}, 9}};
    const Gap f = gap_of(misfit(d, covariance, blocks), blocks, fitted);
    EXPECT_NEAR(f.chi2, chi2, 1e-12 * chi2);
    EXPECT_EQ(f.freedom, 6 - fitted);
    EXPECT_NEAR(f.p, p_above(boost::math::fisher_f(6 - fitted, 9), chi2 / (6 - fitted)), 1e-9);
    blocks.front().freedom = kKnown;
    const Gap known = gap_of(misfit(d, covariance, blocks), blocks, fitted);
    EXPECT_NEAR(known.p,
                boost::math::cdf(boost::math::complement(boost::math::chi_squared(6 - fitted), chi2)), 1e-12);
  }
}

// Chi-square is d' C^-1 d in any order of blocks, and the density that of a normal distribution where all is
// known: -(chi2 + log det C) / 2.
TEST(Misfit, BlocksAddUpWhateverIsCorrelated) {
  Eigen::MatrixXd a(4, 4);
  a << 2, 0.3, -0.5, 0.2, 0.3, 1, 0.4, 0, -0.5, 0.4, 3, 0.6, 0.2, 0, 0.6, 1.5;
  const Eigen::Vector4d d(1, -2, 0.5, 1);
  const double chi2 = d.dot(a.ldlt().solve(d));
  const Misfit split = misfit(d, a, {{{2, 0}, kKnown}, {{1, 3}, 4}}),
               whole = misfit(d, a, {{{0, 1, 2, 3}, kKnown}});
  EXPECT_NEAR(split.chi2, chi2, 1e-12);
  EXPECT_NEAR(split.of_blocks[0] + split.of_blocks[1], chi2, 1e-12);
  EXPECT_NEAR(whole.log_density, -0.5 * (chi2 + std::log(a.determinant())), 1e-12);
  EXPECT_NEAR(split.log_shape, -0.5 * split.of_blocks[0] - 0.5 * (4 + 2) * std::log1p(split.of_blocks[1] / 4),
              1e-12);
  const auto why = [&](const Eigen::Matrix4d& covariance) {
    try {
      misfit(d, covariance, {{{0, 1, 2, 3}, kKnown}});
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  Eigen::Matrix4d indefinite = a;
  indefinite(0, 1) = indefinite(1, 0) = 2;
  for (const Eigen::Matrix4d& bad : {indefinite, Eigen::Matrix4d(-a)})
    EXPECT_NE(why(bad).find("not positive definite"), std::string::npos);
}

// Two numbers that lie 16.8 standard uncertainties off stay so when a third comes with two repeats, whose
// scale may be anything; the third cannot be told from chance.
TEST(Misfit, AWeakNumberHidesNoStrongOnes) {
  const std::vector<ScatterBlock> two{{{0, 1}, kKnown}}, three{{{0, 1}, kKnown}, {{2}, 0.41}};
  const Eigen::Vector3d d(16.8, 16.8, 1);
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  EXPECT_LT(gap_of(misfit(d.head(2), one.topLeftCorner(2, 2), two), two, 0).p, 1e-30);
  EXPECT_LT(gap_of(misfit(d, one, three), three, 0).p, 1e-30);
  const std::vector<ScatterBlock> third = blocks_among(three, {2});
  ASSERT_EQ(third.size(), 1u);
  EXPECT_EQ(third[0].values, std::vector<Eigen::Index>{0});
  EXPECT_GT(gap_of(misfit(d.tail(1), one.bottomRightCorner(1, 1), third), third, 0).p, 0.3);
}

// How often p of a true model lies below 0.05 and 0.01, of a thousand measurements of it.
struct Rates {
  double five = 0, one = 0;
};
// `shared`: deviation of an error that all numbers of a measurement share, which the covariance states.
Rates rates(const std::array<int, 2>& repeats, bool correlated, double shared) {
  constexpr int kTrials = 1000;
  const SyntheticWorld world;
  const LearntModel model(world.space, world.experiments, world.design(1));
  const ModelPoint truth = SyntheticWorld::point(0.3, 0.2);
  Eigen::VectorXd mean(world.numbers(0) + world.numbers(1));
  for (int k = 0; k < mean.size(); ++k)
    mean[k] = k < world.numbers(0) ? world.mean(0, k, truth) : world.mean(1, k - world.numbers(0), truth);
  Rates rates;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto seed = 900 + static_cast<std::uint64_t>(trial);
    Measurements measured = world.measure(truth, repeats, seed, correlated);
    const double offset = shared * Random(seed, 2, RandomPurpose::measurement).normal();
    for (std::size_t k = 0; shared > 0 && k < measured.values.size(); ++k) {
      MeasuredValue& value = measured.values[k];
      value.value += offset;
      value.uncertainty = std::hypot(value.uncertainty, shared);
    }
    measured.covariance.array() += shared * shared;
    const WorkingCovariance working = working_covariance(measured, model.surfaces());
    const double p =
        gap_of(misfit(measured.vector() - mean, working.matrix, working.blocks), working.blocks, 0).p;
    rates.five += (p < 0.05) / double{kTrials};
    rates.one += (p < 0.01) / double{kTrials};
  }
  return rates;
}

// Few repeats of one experiment beside many of another, or correlations known from few repeats, make a
// diagnosis no surer than it may be. Binomial: 0.05 +- 0.007, 0.01 +- 0.003 where p is exact; what is drawn
// towards the simulation's scatter is more careful.
TEST(Misfit, ATrueModelIsSeldomDoubted) {
  struct Case {
    std::array<int, 2> repeats;
    bool correlated;
    double shared = 0;
  };
  for (const Case& each : {Case{{5, 5}, false},
                           {{2, 100}, false},
                           {{3, 30}, false},
                           {{5, 5}, true},
                           {{8, 8}, true},
                           {{12, 42}, true},
                           {{42, 42}, true},
                           {{42, 42}, true, 2}}) {
    const Rates found = rates(each.repeats, each.correlated, each.shared);
    EXPECT_LT(found.five, 0.05 + 3 * 0.007) << each.repeats[0] << " " << each.correlated;
    EXPECT_LT(found.one, 0.01 + 3 * 0.003) << each.repeats[0] << " " << each.correlated;
  }
}

}  // namespace
}  // namespace scree
