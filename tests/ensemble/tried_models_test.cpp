#include "cli/ensemble/tried_models.h"

#include <gtest/gtest.h>

#include "tests/diagnose/synthetic.h"

namespace scree {
namespace {

// A diagnosis of an effect that is there; what is simulated differs from the data by `off`.
class Tried : public testing::Test {
 protected:
  SyntheticWorld world;
  LearntModel model{world.space, world.experiments, world.design(1)};
  Diagnosis d =
      diagnose(world.space, world.measure(SyntheticWorld::point(0.1, 0.1, {{1, 0.6}}), 5, 3), model);
  double off = 0;
  bool fails = false;
  int simulated = 0;
  TriedModels tried{world.space, d, model, [this](const ModelPoint& at) {
                      ++simulated;
                      if (fails) throw TooFewRuns("none came to rest");
                      SimulatedModel made{at, 4, d.measured.vector(), {}, {}};
                      made.mean.array() += off;
                      return made;
                    }};
  Judgement& effect() {
    for (Judgement& j : d.judgements)
      if (j.hypothesis.effects == std::vector<std::size_t>{1}) return j;
    throw std::logic_error("no such judgement");
  }
};

TEST_F(Tried, AFitIsSimulatedOnceUntilItMoves) {
  EXPECT_TRUE(tried.simulate(effect()));
  EXPECT_FALSE(tried.simulate(effect()));
  effect().best.base[0] += 0.09;
  EXPECT_FALSE(tried.simulate(effect()));
  effect().best.base[0] += 0.02;
  EXPECT_TRUE(tried.simulate(effect()));
  tried.simulate_again(effect());
  EXPECT_EQ(simulated, 3);
  EXPECT_EQ(tried.last(effect())->at.base, effect().best.base);
}

// The means of `runs` = 4 seeds against the data: d' (V + S / 4)^-1 d.
TEST_F(Tried, GapsAreThoseOfFullSimulations) {
  off = 0.3;
  tried.simulate(effect());
  const Eigen::VectorXd difference = Eigen::VectorXd::Constant(d.measured.vector().size(), off);
  const Eigen::MatrixXd covariance = d.covariance + model.scatter() / 4;
  EXPECT_NEAR(tried.best(effect()).gap.chi2, difference.dot(covariance.llt().solve(difference)), 1e-9);
}

// One model with the effects that gives the data is enough, though others do not.
TEST_F(Tried, AnEffectThatWasBorneOutIsNotContradicted) {
  off = 30;
  tried.simulate(effect());
  EXPECT_TRUE(tried.contradicts(effect()));
  EXPECT_EQ(tried.contradicted(), Contradicted{{1}});
  EXPECT_FALSE(tried.may_be_said(effect()));
  off = 0;
  tried.simulate_again(effect());
  EXPECT_TRUE(tried.bears_out(effect()));
  off = 30;
  tried.simulate_again(effect());
  EXPECT_TRUE(tried.contradicts(effect()));
  EXPECT_TRUE(tried.may_be_said(effect()));
  EXPECT_TRUE(tried.contradicted().empty());
  EXPECT_EQ(tried.best(effect()).gap.chi2, 0);
}

// Re-calibration is its last fit: one of before says nothing of it.
TEST_F(Tried, ACalibrationIsContradictedByItsLastFit) {
  d = diagnose(world.space, world.measure(SyntheticWorld::point(0.5, -0.6), 5, 1), model);
  EXPECT_FALSE(tried.more_than_calibration());
  tried.simulate(d.calibration);
  EXPECT_TRUE(tried.may_be_said(d.calibration));
  EXPECT_FALSE(tried.more_than_calibration());
  off = 30;
  tried.simulate_again(d.calibration);
  EXPECT_FALSE(tried.may_be_said(d.calibration));
  EXPECT_EQ(tried.contradicted(), Contradicted{{}});
  EXPECT_TRUE(tried.more_than_calibration());
}

// Not at this fit; at another it may be.
TEST_F(Tried, WhatCannotBeSimulatedIsTriedAgainWhenItHasMoved) {
  fails = true;
  EXPECT_TRUE(tried.simulate(effect()));
  EXPECT_TRUE(tried.failed(effect()));
  EXPECT_EQ(tried.last(effect()), nullptr);
  EXPECT_EQ(tried.contradicted(), Contradicted{{1}});
  EXPECT_FALSE(tried.simulate(effect()));
  EXPECT_EQ(simulated, 1);
  EXPECT_EQ(tried.failures().at({1}).why, "none came to rest");
  fails = false;
  effect().best.base[0] += 0.11;
  EXPECT_FALSE(tried.failed(effect()));
  EXPECT_TRUE(tried.simulate(effect()));
  EXPECT_TRUE(tried.may_be_said(effect()));
  EXPECT_TRUE(tried.contradicted().empty());
  EXPECT_TRUE(tried.failures().empty());
}

TEST_F(Tried, WhatWasBorneOutIsNotTakenBackByAFitThatCannotBeSimulated) {
  tried.simulate(effect());
  fails = true;
  effect().best.base[0] += 0.11;
  tried.simulate(effect());
  EXPECT_TRUE(tried.failed(effect()));
  EXPECT_TRUE(tried.may_be_said(effect()));
  EXPECT_TRUE(tried.contradicted().empty());
  EXPECT_THROW(tried.simulate(d.calibration), TooFewRuns) << "without it there is nothing to compare with";
}

}  // namespace
}  // namespace scree
