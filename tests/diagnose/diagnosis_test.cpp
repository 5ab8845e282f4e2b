#include "analysis/diagnose/diagnosis.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <stdexcept>
#include <vector>

#include "analysis/diagnose/outcome.h"
#include "tests/diagnose/synthetic.h"

namespace scree {
namespace {

using Kind = DiagnosisVerdict::Kind;

class DiagnosisOf : public testing::Test {
 protected:
  SyntheticWorld world;
  LearntModel model{world.space, world.experiments, world.design(1)};

  Diagnosis of(const ModelPoint& truth, std::uint64_t seed) const {
    return diagnose(world.space, world.measure(truth, 5, seed), model);
  }
  static std::vector<std::size_t> named(const Diagnosis& d) {
    if (d.verdict.named.empty()) return {};
    return d.judgements[d.verdict.named.front()].hypothesis.effects;
  }
};

// chi2 = d^T (C + S)^-1 d: S is what the surrogate does not know of the fitted model.
TEST_F(DiagnosisOf, GapsAddWhatTheSurrogateDoesNotKnow) {
  const Diagnosis d = of(SyntheticWorld::point(0.5, -0.6), 1);
  const SurfacePrediction fitted = model.at(d.calibration.best);
  const Eigen::VectorXd difference = d.measured.vector() - fitted.mean;
  const auto chi2 = [&](const Eigen::MatrixXd& covariance) {
    return difference.dot(covariance.ldlt().solve(difference));
  };
  const double with = chi2(d.covariance + fitted.covariance), without = chi2(d.covariance);
  EXPECT_NEAR(d.calibration.gap.chi2, with, 1e-6 * with);
  EXPECT_GT(without, 1.01 * with) << "the surrogate is too good for this test";
}

// Changes are counted in standard uncertainties, what the base parameters make up for does not count, and
// what is not known of a change c, here c c', is taken off.
TEST_F(DiagnosisOf, DetectabilityIsWhatIsLeftAfterCompensation) {
  const Diagnosis d = of(SyntheticWorld::point(0.5, -0.6), 1);
  const Eigen::Vector2d base(0.2, -0.1), step(0.05, 0);
  const Eigen::VectorXd other_base = model.at({base + step, {}}).mean - model.at({base - step, {}}).mean,
                        effect = model.at(SyntheticWorld::point(0.2, -0.1, {{0, 0.5}})).mean -
                                 model.at(SyntheticWorld::point(0.2, -0.1)).mean;
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(effect.size(), effect.size());
  const auto strength = [&](const Eigen::VectorXd& change, const Eigen::MatrixXd& unsure, double scale = 1) {
    return detectability(model, scale * d.covariance, base, change, unsure);
  };
  const double plain = strength(effect, none);
  EXPECT_GT(plain, 1);
  EXPECT_NEAR(strength(other_base, none), 0, 1e-9);
  EXPECT_NEAR(strength(effect + 3 * other_base, none), plain, 1e-9);
  EXPECT_NEAR(strength(effect, none, 4), plain / 2, 1e-9);
  EXPECT_NEAR(strength(effect, 0.75 * effect * effect.transpose()), plain / 2, 1e-9);
}

TEST_F(DiagnosisOf, AMisfitThatIsNoNumberIsNotTakenForNone) {
  Measurements measured = world.measure(SyntheticWorld::point(0.5, -0.6), 5, 1);
  measured.values[0].value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(diagnose(world.space, measured, model), std::runtime_error);
}

TEST_F(DiagnosisOf, ACovarianceThatIsNoneIsRefused) {
  Measurements measured = world.measure(SyntheticWorld::point(0.5, -0.6), 5, 1);
  for (auto& value : measured.values) value.std.reset();  // what is given counts
  measured.covariance(0, 0) = -1;
  EXPECT_THROW(diagnose(world.space, measured, model), std::runtime_error);
}

TEST_F(DiagnosisOf, NominalDataSaysThatNothingIsMissing) {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Diagnosis d = of({world.space.nominal(), {}}, seed);
    alarms += d.verdict.kind == Kind::nothing || d.verdict.kind == Kind::calibration ? 0 : 1;
  }
  EXPECT_LE(alarms, 2) << "of 40";
}

TEST_F(DiagnosisOf, OtherParametersAreCalibratedAndNothingIsNamed) {
  int wrong = 0, inside = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const Diagnosis d = of(SyntheticWorld::point(0.5, -0.6), seed);
    wrong += d.verdict.kind == Kind::calibration ? 0 : 1;
    const Judgement::Interval a = d.calibration.base[0];
    inside += a.low <= 0.25 && 0.25 <= a.high ? 1 : 0;
  }
  EXPECT_LE(wrong, 2) << "of 40";
  EXPECT_GE(inside, 31) << "of 40: 90 % intervals";
}

// Over several designs: what one design has wrong, all measurements with it have in common.
TEST_F(DiagnosisOf, HiddenEffectsAreNamedWithTheirAmplitude) {
  int right = 0, inside = 0, count = 0;
  for (std::uint64_t design = 1; design <= 4; ++design) {
    const LearntModel learnt(world.space, world.experiments, world.design(design));
    for (std::size_t e = 0; e < SyntheticWorld::kEffects; ++e)
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const double x = e == 3 && seed == 2 ? -0.45 : 0.45;
        const Diagnosis d =
            diagnose(world.space, world.measure(SyntheticWorld::point(-0.4, 0.3, {{e, x}}), 5, seed), learnt);
        ++count;
        if (named(d) != std::vector<std::size_t>{e}) continue;
        ++right;
        const Judgement::Interval i = d.judgements[d.verdict.named.front()].effects[0][0];
        inside += i.low <= x && x <= i.high ? 1 : 0;
      }
  }
  EXPECT_GE(right, 30) << "of " << count;
  EXPECT_GE(inside, right * 8 / 10) << "of " << right << ": 90 % intervals";
}

TEST_F(DiagnosisOf, TwoHiddenEffectsAreBothNamed) {
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    right += named(of(SyntheticWorld::point(0.2, 0.2, {{0, 0.5}, {3, -0.5}}), seed)) ==
                     std::vector<std::size_t>{0, 3}
                 ? 1
                 : 0;
  EXPECT_GE(right, 7) << "of 8";
}

TEST_F(DiagnosisOf, AnEffectThatIsNotInTheLibraryIsUnknown) {
  SyntheticWorld smaller;
  smaller.space.effects.erase(smaller.space.effects.begin());
  DesignRuns runs = world.design(1);
  for (auto& experiment : runs) {
    std::erase_if(experiment, [](const DesignRun& run) {
      return !run.at.effects.empty() && run.at.effects[0].effect == 0;
    });
    for (DesignRun& run : experiment)
      for (EffectAt& effect : run.at.effects) --effect.effect;
  }
  const LearntModel without(smaller.space, smaller.experiments, runs);
  int unknown = 0, sure = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Diagnosis d =
        diagnose(smaller.space, world.measure(SyntheticWorld::point(0, 0.3, {{0, 0.6}}), 5, seed), without);
    unknown += d.verdict.kind == Kind::unknown ? 1 : 0;
    sure += d.verdict.kind == Kind::effect ? 1 : 0;
  }
  EXPECT_GE(unknown, 9) << "of 10";
  EXPECT_LE(sure, 1) << "of 10";
}

// Full simulations at the fitted values that do not give the data take a name back; the rest share its
// probability.
TEST_F(DiagnosisOf, WhatSimulationsContradictIsNotNamed) {
  Diagnosis d = of(SyntheticWorld::point(0.1, 0.1, {{1, 0.6}}), 3);
  ASSERT_EQ(named(d), std::vector<std::size_t>{1});
  refute(d, d.verdict.named.front(), Gap{90, 10, 1e-9});
  EXPECT_NE(named(d), std::vector<std::size_t>{1});
  double sum = 0, before = 1;
  for (const Judgement& j : d.judgements) {
    EXPECT_LE(j.probability, before) << "by falling probability";
    sum += before = j.probability;
    if (j.simulated == Judgement::Simulated::refuted) {
      EXPECT_EQ(j.probability, 0);
      EXPECT_EQ(j.gap.chi2, 90);
    }
  }
  EXPECT_NEAR(sum, 1, 1e-9);
}

// The same of re-calibration: what its own simulations contradict is not said, though surfaces explain it
// all.
TEST_F(DiagnosisOf, ACalibrationThatSimulationsContradictIsNotSaid) {
  Diagnosis d = of(SyntheticWorld::point(0.5, -0.6), 1);
  ASSERT_EQ(d.verdict.kind, Kind::calibration);
  const auto calibration = std::find_if(d.judgements.begin(), d.judgements.end(), [](const Judgement& j) {
    return j.hypothesis.effects.empty() && !j.hypothesis.unknown;
  });
  refute(d, static_cast<std::size_t>(calibration - d.judgements.begin()), Gap{90, 11, 1e-9});
  EXPECT_NE(d.verdict.kind, Kind::calibration);
  EXPECT_EQ(d.calibration.simulated, Judgement::Simulated::refuted);
  EXPECT_EQ(d.calibration.gap.chi2, 90);
  EXPECT_EQ(d.calibration.probability, 0);
}

// Pairs are tried where the one effect that explains the data is contradicted, and only there.
TEST_F(DiagnosisOf, PairsAreTriedWhereSimulationsContradictSingleEffects) {
  const Measurements measured = world.measure(SyntheticWorld::point(0.1, 0.1, {{1, 0.6}}), 5, 3);
  const auto pairs = [&](const Contradicted& contradicted) {
    const Diagnosis d = diagnose(world.space, measured, model, contradicted);
    return std::count_if(d.judgements.begin(), d.judgements.end(),
                         [](const Judgement& j) { return j.hypothesis.effects.size() == 2; });
  };
  EXPECT_EQ(pairs({}), 0);
  EXPECT_EQ(pairs({{0}}), 0);
  EXPECT_EQ(pairs({{1}}), 6) << "of four effects";
}

using DiagnosisThreads = DiagnosisOf;
TEST_F(DiagnosisThreads, ChangeNothing) {
  const Measurements measured = world.measure(SyntheticWorld::point(0.1, 0.1, {{1, 0.6}}), 5, 3);
  const Diagnosis alone = diagnose(world.space, measured, model, {}, Pairs::always);
  const LearntModel shared(world.space, world.experiments, world.design(1), {}, 4);
  const Diagnosis d = diagnose(world.space, measured, shared, {}, Pairs::always, nullptr, 4);
  ASSERT_EQ(d.judgements.size(), alone.judgements.size());
  for (std::size_t k = 0; k < d.judgements.size(); ++k) {
    EXPECT_EQ(d.judgements[k].hypothesis.effects, alone.judgements[k].hypothesis.effects);
    EXPECT_EQ(d.judgements[k].evidence.log_evidence, alone.judgements[k].evidence.log_evidence);
    EXPECT_EQ(d.judgements[k].probability, alone.judgements[k].probability);
    EXPECT_EQ(d.judgements[k].best.base, alone.judgements[k].best.base);
    EXPECT_EQ(d.judgements[k].gap.chi2, alone.judgements[k].gap.chi2);
  }
  EXPECT_EQ(d.verdict.named, alone.verdict.named);
}

// Two effects may explain the data though several others do better alone.
TEST_F(DiagnosisOf, AllPairsAreTriedThatMayGoTogether) {
  SyntheticWorld larger;
  for (const std::string name : {"effect5", "effect6", "effect7"})
    larger.space.effects.push_back(
        {name, name, 0, {{"effects." + name + ".size", "", 0, 1}}, {"one", "two"}});
  larger.space.effects.back().excludes = "effect5";
  const LearntModel learnt(larger.space, larger.experiments, larger.design(1));
  const Diagnosis d = diagnose(larger.space, larger.measure(SyntheticWorld::point(0.1, 0.1), 5, 3), learnt,
                               {}, Pairs::always);
  std::set<std::vector<std::size_t>> pairs;
  for (const Judgement& j : d.judgements)
    if (j.hypothesis.effects.size() == 2) pairs.insert(j.hypothesis.effects);
  EXPECT_EQ(pairs.size(), 7u * 6 / 2 - 1);
  EXPECT_FALSE(pairs.contains({4, 6}));
}

// By the roots 8 : 4 : 2 : 1 : 1 of the probabilities, the leading one's eight sixteenths not given away.
TEST(SharedByRivals, ByTheRootsOfTheirProbabilities) {
  std::vector<Judgement> judgements(5);
  std::vector<const Judgement*> among;
  for (const double probability : {0.64, 0.16, 0.04, 0.01, 0.01}) {
    judgements[among.size()].probability = probability;
    among.push_back(&judgements[among.size()]);
  }
  using Shares = std::vector<std::pair<std::ptrdiff_t, int>>;
  const auto shares = [&](const Judgement& leading, int count) {
    Shares all;
    for (const auto& [rival, share] : shared_by_rivals(among, leading, count))
      all.emplace_back(rival - judgements.data(), share);
    return all;
  };
  EXPECT_EQ(shares(judgements[0], 16), (Shares{{1, 4}, {2, 2}, {3, 1}, {4, 1}}));
  EXPECT_EQ(shares(judgements[1], 16), (Shares{{0, 8}, {2, 2}, {3, 1}, {4, 1}}));
  for (Judgement& j : judgements) j.probability = 0;
  EXPECT_TRUE(shares(judgements[0], 16).empty());
}

TEST_F(DiagnosisOf, WhatAnEarlierOneSaysOfTheSameModelIsTakenOver) {
  const Measurements measured = world.measure(SyntheticWorld::point(0.1, 0.1, {{1, 0.6}}), 5, 3);
  const Diagnosis without = diagnose(world.space, measured, model);
  const Diagnosis anew = diagnose(world.space, measured, model, {}, Pairs::always);
  const Diagnosis taken_over = diagnose(world.space, measured, model, {}, Pairs::always, &without);
  ASSERT_EQ(anew.judgements.size(), without.judgements.size() + 6) << "of four effects";
  ASSERT_EQ(taken_over.judgements.size(), anew.judgements.size());
  for (std::size_t k = 0; k < anew.judgements.size(); ++k) {
    EXPECT_EQ(taken_over.judgements[k].hypothesis.effects, anew.judgements[k].hypothesis.effects);
    EXPECT_EQ(taken_over.judgements[k].probability, anew.judgements[k].probability);
  }
}

// Three runs of a scatter S that has proved four times as large as in the design: chi-square of a difference
// d is d' (V + 4 S / 3)^-1 d.
TEST_F(DiagnosisOf, GapsOfSimulationsCountWithTheScatterThatTheyProved) {
  const Measurements measured = world.measure({world.space.nominal(), {}}, 5, 7);
  const LearntModel wider(world.space, world.experiments, world.design(1), {{4, 1}, {4, 1}});
  const Diagnosis d = diagnose(world.space, measured, wider);
  const Eigen::MatrixXd one = model.scatter();
  EXPECT_TRUE(wider.scatter().isApprox(4 * one));
  Eigen::VectorXd off = Eigen::VectorXd::Zero(one.rows());
  off[2] = 3;
  const Eigen::MatrixXd covariance = d.covariance + 4 * one / 3;
  EXPECT_NEAR(simulated_gap(d, wider, measured.vector() + off, 3).chi2, off.dot(covariance.llt().solve(off)),
              1e-6);
}

// One number whose repeats scatter thirtyfold widens itself, and the others of its experiment hardly.
TEST_F(DiagnosisOf, OneNumberThatScattersWidensTheOthersLittle) {
  Measurements measured = world.measure({world.space.nominal(), {}}, 5, 7);
  const Eigen::VectorXd before = working_covariance(measured, model.surfaces()).matrix.diagonal().cwiseSqrt();
  MeasuredValue& odd = measured.values[2];
  odd.std = 30 * *odd.std;
  odd.uncertainty = *odd.std / std::sqrt(5.0);
  measured.covariance(2, 2) = odd.uncertainty * odd.uncertainty;
  const Eigen::VectorXd after = working_covariance(measured, model.surfaces()).matrix.diagonal().cwiseSqrt();
  EXPECT_GT(after[2], 5 * before[2]);
  for (const Eigen::Index k : {0, 1, 3, 4, 5}) EXPECT_LT(after[k], 1.9 * before[k]) << k;
  for (Eigen::Index k = 6; k < 11; ++k) EXPECT_EQ(after[k], before[k]) << k << ", of another experiment";
}

// What could not be simulated is not named either; its gap stays that of the surface.
TEST_F(DiagnosisOf, WhatCannotBeSimulatedIsNotNamed) {
  Diagnosis d = of(SyntheticWorld::point(0.1, 0.1, {{1, 0.6}}), 3);
  const double chi2 = d.judgements[d.verdict.named.front()].gap.chi2;
  refute(d, d.verdict.named.front(), std::nullopt);
  EXPECT_NE(named(d), std::vector<std::size_t>{1});
  const auto failed = std::find_if(d.judgements.begin(), d.judgements.end(), [](const Judgement& j) {
    return j.simulated == Judgement::Simulated::failed;
  });
  ASSERT_NE(failed, d.judgements.end());
  EXPECT_EQ(failed->gap.chi2, chi2);
}

Judgement judged(std::vector<std::size_t> effects, bool unknown, double probability, double p) {
  Judgement j;
  j.hypothesis.effects = std::move(effects);
  j.hypothesis.unknown = unknown;
  j.probability = probability;
  j.gap.p = p;
  return j;
}

// Re-calibration three times as probable as the one effect that explains the data: no name, however probable
// an effect that does not explain them.
TEST(Verdict, NamesNothingThatIsLessProbableThanCalibration) {
  Diagnosis d;
  d.nominal.p = d.calibration.gap.p = 1e-4;
  d.judgements = {judged({0}, false, 0.95, 0.005), judged({}, false, 0.03, 1e-4),
                  judged({1}, false, 0.01, 0.02), judged({}, true, 0.005, 1), judged({2}, false, 0, 0.5)};
  refute(d, 4, Gap{90, 10, 1e-9});
  EXPECT_EQ(d.verdict.kind, Kind::calibration);
  d.judgements[1].probability = 1e-4;
  refute(d, 4, Gap{90, 10, 1e-9});
  EXPECT_EQ(d.verdict.kind, Kind::effect);
}

// Something unknown is more probable than effects that explain the data: these are not passed over, but for
// one that simulations contradict.
TEST_F(DiagnosisOf, UnknownIsSaidWithTheEffectsThatWouldDo) {
  DiagnosisOutcome o;
  o.space = world.space;
  o.space.base.clear();  // the judgements below have no fits
  o.diagnosis.measured = world.measure(SyntheticWorld::point(0.1, 0.1), 5, 3);
  o.diagnosis.covariance = Eigen::MatrixXd::Identity(11, 11);
  o.nominal.mean = o.diagnosis.measured.vector();
  o.nominal.std = Eigen::VectorXd::Zero(o.nominal.mean.size());
  o.diagnosis.nominal.p = o.diagnosis.calibration.gap.p = 1e-4;
  o.diagnosis.judgements = {judged({}, true, 0.9, 1),        judged({1}, false, 0.05, 0.13),
                            judged({0}, false, 0.04, 0.005), judged({0, 1}, false, 0.0075, 0.02),
                            judged({2}, false, 0.001, 0.3),  judged({}, false, 0, 1e-4)};
  const auto said = [&] {
    refute(o.diagnosis, 5, Gap{90, 10, 1e-9});  // says anew what is named
    EXPECT_EQ(o.diagnosis.verdict.kind, Kind::unknown);
    return diagnosis_in_words(o).front();
  };
  const auto name = [&](std::size_t effect) { return world.space.effects[effect].name; };
  EXPECT_THAT(said(),
              testing::HasSubstr(fmt::format("(probability 0.90). By their fits alone these would explain "
                                             "the data, but are less probable: {} (p = 0.130, probability "
                                             "0.050); {} and {} (p = 0.020, probability 0.0075).",
                                             name(1), name(0), name(1))));
  for (Judgement& j : o.diagnosis.judgements)
    if (j.hypothesis.is_effect()) j.simulated = Judgement::Simulated::refuted;
  EXPECT_THAT(said(), testing::HasSubstr("none of them explains the data, alone or with a second one"));
}

// A surface that is less sure of itself leaves an amplitude more open.
TEST_F(DiagnosisOf, WiderSurfacesGiveWiderIntervals) {
  const Measurements measured = world.measure(SyntheticWorld::point(0.1, 0.1, {{1, 0.6}}), 50, 3);
  const LearntModel wider(world.space, world.experiments, world.design(1), {{1, 4}, {1, 4}});
  const auto width = [&](const LearntModel& learnt) {
    const Diagnosis d = diagnose(world.space, measured, learnt);
    for (const Judgement& j : d.judgements)
      if (j.hypothesis.effects == std::vector<std::size_t>{1})
        return j.effects[0][0].high - j.effects[0][0].low;
    return 0.0;
  };
  EXPECT_GT(width(wider), 1.2 * width(model));
}

TEST_F(DiagnosisOf, WhatWasHeldOutIsForetoldByTheRightEffectOnly) {
  const Diagnosis d = of(SyntheticWorld::point(0.1, 0.1, {{1, 0.6}}), 3);
  const HeldOut before = held_out(world.space, d, model, {{}, false, 0});
  const HeldOut after = held_out(world.space, d, model, {{1}, false, 0});
  EXPECT_EQ(before.count, 11);
  EXPECT_THAT(before.parts, testing::ElementsAre("experiment one", "experiment two"));
  EXPECT_LT(after.gap(), 0.25 * before.gap());
}

TEST_F(DiagnosisOf, TheMapNamesWhatDisagrees) {
  Measurements measured = world.measure({world.space.nominal(), {}}, 5, 7);
  measured.values[8].value += 20 * measured.values[8].uncertainty;
  const Diagnosis d = diagnose(world.space, measured, model);
  EXPECT_EQ(d.numbers.front().where, measured.values[8].label);
  EXPECT_TRUE(d.numbers.front().significant);
  EXPECT_GT(d.numbers.front().z, 5);
  EXPECT_LT(d.nominal.p, 1e-3);
  EXPECT_THAT(d.parts,
              testing::Contains(testing::AllOf(testing::Field(&Disagreement::where, "experiment two"),
                                               testing::Field(&Disagreement::significant, true))));
}

TEST(Evidence, OfAGaussianIsItsIntegral) {
  // exp(-x'x / (2 s^2)) over [-1, 1]^3: (s sqrt(2 pi) erf(1 / (s sqrt 2)))^3, times the uniform prior 1/8.
  for (const double s : {0.5, 0.05, 0.005}) {
    const Evidence e = integrate([&](const Eigen::VectorXd& x) { return -0.5 * x.squaredNorm() / (s * s); },
                                 {Eigen::VectorXd::Constant(3, -1), Eigen::VectorXd::Constant(3, 1)}, 5);
    const double one = s * std::sqrt(2 * std::numbers::pi) * std::erf(1 / (s * std::sqrt(2.0)));
    EXPECT_NEAR(e.log_evidence, 3 * std::log(one) - std::log(8), 0.15) << s;
    EXPECT_NEAR(e.quantile(1, 0.5), 0, 0.15 * s) << s;
    if (s < 0.2) {
      EXPECT_NEAR(e.quantile(1, 0.95), 1.645 * s, 0.2 * s) << s;
    }
  }
}

// exp(-x / s) from 0 on: nine tenths of it are the shortest between 0 and s log 10, and 0 is the most
// probable of all. The same the other way round.
TEST(Evidence, TheShortestRangeBeginsWhereTheMostProbableLies) {
  constexpr double s = 0.1;
  const ParameterBox box{Eigen::VectorXd::Zero(2), Eigen::VectorXd::Ones(2)};
  const Evidence e = integrate([&](const Eigen::VectorXd& x) { return -(x[0] + 1 - x[1]) / s; }, box, 5);
  const Evidence::Range first = e.shortest(0, 0.9), second = e.shortest(1, 0.9);
  EXPECT_EQ(first.low, 0);
  EXPECT_NEAR(first.high, s * std::log(10), 0.15 * s * std::log(10));
  EXPECT_EQ(second.high, 1);
  EXPECT_NEAR(second.low, 1 - s * std::log(10), 0.15 * s * std::log(10));
  const Evidence middle = integrate(
      [&](const Eigen::VectorXd& x) { return -50 * (x.array() - 0.5).matrix().squaredNorm(); }, box, 5);
  EXPECT_NEAR(middle.shortest(0, 0.9).low, 0.5 - 1.645 * 0.1, 0.03);
  EXPECT_NEAR(middle.shortest(0, 0.9).high, 0.5 + 1.645 * 0.1, 0.03);
}

TEST(Evidence, FindsBothOfTwoModes) {
  const auto two = [](const Eigen::VectorXd& x) {
    const double a = std::pow((x[0] - 0.7) / 0.05, 2), b = std::pow((x[0] + 0.7) / 0.05, 2);
    return std::log(std::exp(-0.5 * a) + std::exp(-0.5 * b) + 1e-300);
  };
  const Evidence e = integrate(two, {Eigen::VectorXd::Constant(1, -1), Eigen::VectorXd::Constant(1, 1)}, 5);
  EXPECT_NEAR(e.log_evidence, std::log(2 * 0.05 * std::sqrt(2 * std::numbers::pi) / 2), 0.1);
  EXPECT_LT(e.quantile(0, 0.25), -0.6);
  EXPECT_GT(e.quantile(0, 0.75), 0.6);
}

// A narrow peak beside a broad hill, which the stages find late: its interval is that of the peak, of many
// samples and not of one. The peak is Student's t of two degrees of freedom in three dimensions.
TEST(Evidence, HasEnoughSamplesOfANarrowPeak) {
  constexpr double s = 0.01, height = 15;
  const auto peak = [](const Eigen::VectorXd& x) {
    const double hill = -0.5 * x.squaredNorm() / (0.3 * 0.3);
    const double off = (x - Eigen::VectorXd::Constant(3, 0.45)).squaredNorm() / (s * s);
    return std::log(std::exp(hill) + std::exp(height - 2.5 * std::log1p(off / 3)));
  };
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Evidence e =
        integrate(peak, {Eigen::VectorXd::Constant(3, -1), Eigen::VectorXd::Constant(3, 1)}, seed);
    EXPECT_GT(1 / e.weights.squaredNorm(), 90) << "samples that count, seed " << seed;
    const double width = e.quantile(0, 0.95) - e.quantile(0, 0.05);
    EXPECT_GT(width, 2 * s);
    EXPECT_LT(width, 12 * s);
  }
}

TEST(ResponseSurface, LearnsScatterAndForetellsWithinItsUncertainty) {
  const SyntheticWorld world;
  const DesignRuns runs = world.design(4);
  const ResponseSurface surface(world.space, "one", runs[0]);
  EXPECT_NEAR(std::sqrt(surface.scatter()(0, 0)), 1.0, 0.2);  // 0.6^2 + 0.8^2
  EXPECT_NEAR(surface.scatter()(0, 1), 0.36, 0.25);
  double sum = 0;
  int count = 0;
  Random random(9, 0, RandomPurpose::design);
  for (int k = 0; k < 60; ++k) {
    ModelPoint at = SyntheticWorld::point(random.uniform(-1, 1), random.uniform(-1, 1));
    const auto e = static_cast<std::size_t>(k % 4);
    if (e != 2) at.effects.push_back({e, Eigen::VectorXd::Constant(1, random.uniform(0, 1))});
    const SurfacePrediction p = surface.at(at);
    for (int c = 0; c < 6; ++c, ++count)
      sum += std::pow(p.mean[c] - world.mean(0, c, at), 2) / p.covariance(c, c);
  }
  EXPECT_LT(sum / count, 2.0);
  EXPECT_GT(sum / count, 0.2);
}

// An effect that has done all it can at a third of its range, of either sign differently.
TEST(ResponseSurface, FollowsAnEffectThatSaturates) {
  ModelSpace space;
  space.base = {{"material.mu", 0, -1, 1}};
  space.effects = {{"sticky", "sticky", 0, {{"effects.sticky.size", "", -1, 1}}, {"one"}}};
  const auto truth = [](double base, double x) {
    return 2 * base + (x > 0 ? 12 * std::min(x, 0.35) : 2 * x);
  };
  std::vector<DesignRun> runs;
  Random random(3, 0, RandomPurpose::design);
  const auto add = [&](double base, double x) {
    ModelPoint at{Eigen::VectorXd::Constant(1, base), {}};
    if (x != 0) at.effects.push_back({0, Eigen::VectorXd::Constant(1, x)});
    runs.push_back({at, Eigen::VectorXd::Constant(1, truth(base, x) + 0.1 * random.uniform(-1, 1))});
  };
  for (int k = 0; k < 20; ++k) add(random.uniform(-1, 1), 0);
  for (int k = 1; k <= 14; ++k) add(random.uniform(-1, 1), k / 14.0), add(random.uniform(-1, 1), -k / 14.0);
  const ResponseSurface surface(space, "one", runs);
  for (const double x : {-0.9, -0.6, -0.35, -0.2, 0.2, 0.35, 0.6, 0.9}) {
    const SurfacePrediction p =
        surface.at({Eigen::VectorXd::Constant(1, 0.3), {{0, Eigen::VectorXd::Constant(1, x)}}});
    // Lines between knots an eighth apart cut a corner, where the slope changes by 12, by a quarter of that
    // at most; a polynomial of third order is off by 0.8.
    EXPECT_NEAR(p.mean[0], truth(0.3, x), 12.0 / 8 / 4) << x;
    EXPECT_LT(std::abs(p.mean[0] - truth(0.3, x)), 4 * std::sqrt(p.covariance(0, 0))) << x;
  }
}

// Along a root at the bottom of a range, 0.0625 is 0.25 and 0.25 is 0.5; at its top the coordinate itself
// counts; below a hundredth all are the same.
TEST(ModelSpaceDistance, IsThatOfCoordinatesAndOfHowFarAlongTheyAre) {
  const SyntheticWorld world;
  const auto distance = [&](double first, double second, std::size_t effect = 0) {
    return world.space.distance(SyntheticWorld::point(0.1, 0.2, {{effect, first}}),
                                SyntheticWorld::point(0.1, 0.2, {{effect, second}}));
  };
  EXPECT_NEAR(distance(0.0625, 0.25), 0.25, 1e-12);
  EXPECT_NEAR(distance(0.81, 1), 0.19, 1e-12);
  EXPECT_NEAR(distance(0, 0.01), 0.01, 1e-12);
  EXPECT_NEAR(distance(0, 0.04), 0.1, 1e-12);
  EXPECT_NEAR(distance(-0.25, 0.25, 3), 0.5, 1e-12) << "two signs: no root";
  const ModelPoint plain = SyntheticWorld::point(0.1, 0.2), other = SyntheticWorld::point(0.1, -0.2);
  EXPECT_NEAR(world.space.distance(plain, other), 0.4, 1e-12);
  EXPECT_TRUE(std::isinf(world.space.distance(plain, SyntheticWorld::point(0.1, 0.2, {{0, 0.5}}))));
}

// Friction and an effect do the same, y = 6 (b + x), and all pairs of them that give the measured numbers are
// open, b = 0.4 - x. Of amplitudes only 0.3 was simulated often: it is known to fit, others may.
TEST(WhereToLearn, IsAllThatIsOpenAndNotOnlyWhatIsKnown) {
  constexpr int kNumbers = 12;
  ModelSpace space;
  space.base = {{"material.mu", 0, -1, 1}};
  space.effects = {{"sticky", "sticky", 0, {{"effects.sticky.size", "", 0, 1}}, {"one"}}};
  Random random(3, 0, RandomPurpose::design);
  std::vector<DesignRun> runs;
  const auto add = [&](double base, double x) {
    ModelPoint at{Eigen::VectorXd::Constant(1, base), {}};
    if (x != 0) at.effects.push_back({0, Eigen::VectorXd::Constant(1, x)});
    Eigen::VectorXd y(kNumbers);
    for (double& each : y) each = 6 * (base + x) + random.uniform(-1, 1);
    runs.push_back({at, y});
  };
  for (int k = 0; k < 24; ++k) add(random.uniform(-1, 1), 0);
  for (int k = 0; k < 40; ++k) add(0.1 + 0.1 * random.uniform(-1, 1), 0.3);
  add(-0.5, 0.9), add(0.2, 0.6);
  Measurements measured;
  measured.experiments = {"one"};
  for (int k = 1; k <= kNumbers; ++k)
    measured.values.push_back(
        {0, fmt::format("chi_S{}", k), fmt::format("one/chi_S{}", k), 2.4, 0.1, {}, {}});
  measured.covariance = 0.1 * 0.1 * Eigen::MatrixXd::Identity(kNumbers, kNumbers);
  const LearntModel model(space, {"one"}, {runs});
  const Diagnosis d = diagnose(space, measured, model);
  const std::vector<ModelPoint> points = where_to_learn(space, d, model, {{0}, false, 0}, 40, {});
  ASSERT_EQ(points.size(), 40u);
  int far = 0;
  for (const ModelPoint& at : points) far += std::abs(at.effects.at(0).amplitude() - 0.3) > 0.2 ? 1 : 0;
  EXPECT_GE(far, 19);  // 23 of 40; by the likelihood itself 14

  // Where the nearest simulation of one experiment gave nothing, no matter what others did there, none lies.
  std::vector<SimulatedPoints> simulated(2);
  for (int b = -10; b <= 10; ++b)
    for (int k = 1; k <= 20; ++k) {
      const ModelPoint at{Eigen::VectorXd::Constant(1, 0.1 * b),
                          {{0, Eigen::VectorXd::Constant(1, 0.05 * k)}}};
      (k <= 6 ? simulated[0].measured : simulated[0].gave_nothing).push_back(at);
      simulated[1].measured.push_back(at);
    }
  const auto highest = [](const std::vector<ModelPoint>& of) {
    double most = 0;
    for (const ModelPoint& at : of) most = std::max(most, at.effects.at(0).amplitude());
    return most;
  };
  EXPECT_GT(highest(points), 0.5);
  const std::vector<ModelPoint> kept = where_to_learn(space, d, model, {{0}, false, 0}, 40, simulated);
  EXPECT_EQ(kept.size(), 40u);
  EXPECT_LT(highest(kept), 0.4);
}

// An effect that does most of what it can in the lowest seventh of its range, more of it where the friction
// is high, and then turns round: y = 2 b + (1 + b / 2) 6 (1 - exp(-x / 0.07)) - 3 x. Amplitudes lie as in a
// design. With hats that know nothing of the base parameters, and even in x
// instead of its root, errors were 0.88 and their mean square 27 times the variance that the surface gave.
TEST(ResponseSurface, FollowsAnEffectThatActsAtTheBottomOfItsRange) {
  ModelSpace space;
  space.base = {{"material.mu", 0, -1, 1}};
  space.effects = {{"sticky", "sticky", 0, {{"effects.sticky.size", "", 0, 1}}, {"one"}}};
  const auto truth = [](double base, double x) {
    return 2 * base + (1 + base / 2) * 6 * (1 - std::exp(-x / 0.07)) - 3 * x;
  };
  double square = 0, error = 0;
  int count = 0;
  for (std::uint64_t world = 0; world < 20; ++world) {
    Random random(world, 0, RandomPurpose::design);
    std::vector<DesignRun> runs;
    const auto point = [](double base, double x) {
      ModelPoint at{Eigen::VectorXd::Constant(1, base), {}};
      if (x != 0) at.effects.push_back({0, Eigen::VectorXd::Constant(1, x)});
      return at;
    };
    const auto add = [&](double base, double x) {
      runs.push_back(
          {point(base, x), Eigen::VectorXd::Constant(1, truth(base, x) + 0.2 * random.uniform(-1, 1))});
    };
    for (int k = 0; k < 24; ++k) add(random.uniform(-1, 1), 0);
    for (int k = 1; k <= 20; ++k) add(random.uniform(-1, 1), k * k / 400.0);
    const ResponseSurface surface(space, "one", runs);
    for (const double base : {-0.5, 0.0, 0.5})
      for (const double x : {0.03, 0.06, 0.1, 0.2, 0.5}) {
        const SurfacePrediction p = surface.at(point(base, x));
        const double off = p.mean[0] - truth(base, x);
        error += off * off;
        square += off * off / p.covariance(0, 0);
        ++count;
      }
  }
  EXPECT_LT(std::sqrt(error / count), 0.3);
  EXPECT_LT(square / count, 2.5);
}

// Two effects that do less together the more there is of the first, and more on one side of the base
// parameter. What is learnt from some simulations of both holds beside them, and before there is any the
// surface says that it does not know.
TEST(ResponseSurface, FollowsTwoEffectsThatActOnEachOther) {
  ModelSpace space;
  space.base = {{"material.mu", 0, -1, 1}};
  space.effects = {{"sticky", "sticky", 0, {{"effects.sticky.size", "", 0, 1}}, {"one"}},
                   {"rough", "rough", 0, {{"effects.rough.size", "", 0, 1}}, {"one"}}};
  const auto truth = [](double base, double a, double b) {
    return 2 * base + 3 * std::sqrt(a) + 2 * std::sqrt(b) -
           2.5 * std::sqrt(a * b) * (1 - 0.6 * std::sqrt(a)) * (1 + 1.5 * base);
  };
  double before = 0, after = 0, error = 0;
  int count = 0;
  for (std::uint64_t world = 0; world < 20; ++world) {
    Random random(world, 0, RandomPurpose::design);
    std::vector<DesignRun> runs;
    const auto point = [](double base, double a, double b) {
      ModelPoint at{Eigen::VectorXd::Constant(1, base), {}};
      if (a != 0) at.effects.push_back({0, Eigen::VectorXd::Constant(1, a)});
      if (b != 0) at.effects.push_back({1, Eigen::VectorXd::Constant(1, b)});
      return at;
    };
    const auto add = [&](double a, double b) {
      const double base = random.uniform(-1, 1);
      runs.push_back(
          {point(base, a, b), Eigen::VectorXd::Constant(1, truth(base, a, b) + 0.2 * random.uniform(-1, 1))});
    };
    for (int k = 0; k < 24; ++k) add(0, 0);
    for (int k = 1; k <= 20; ++k) add(k * k / 400.0, 0), add(0, k * k / 400.0);
    const ResponseSurface without(space, "one", runs);
    for (int k = 0; k < 40; ++k) add(random.uniform(0.01, 1), random.uniform(0.01, 1));
    const ResponseSurface with(space, "one", runs);
    for (int k = 0; k < 20; ++k, ++count) {
      const double base = random.uniform(-0.8, 0.8), a = random.uniform(0.1, 0.9),
                   b = random.uniform(0.1, 0.9);
      const auto square = [&](const ResponseSurface& surface) {
        const SurfacePrediction p = surface.at(point(base, a, b));
        return std::pow(p.mean[0] - truth(base, a, b), 2) / p.covariance(0, 0);
      };
      before += square(without);
      after += square(with);
      error += std::pow(with.at(point(base, a, b)).mean[0] - truth(base, a, b), 2);
    }
  }
  EXPECT_LT(before / count, 2.5);
  EXPECT_GT(before / count, 0.3);
  EXPECT_LT(after / count, 1.4);
  EXPECT_GT(after / count, 0.3);
  EXPECT_LT(std::sqrt(error / count), 0.115);
}

// Readings of one pile share its scatter: what an effect on measurement does is then known far better than
// the scatter of one run allows, and the mean of the base model no better than its piles do.
TEST(ResponseSurface, LearnsFromReadingsOfTheSamePiles) {
  ModelSpace space;
  space.base = {{"material.mu", 0, -1, 1}};
  space.effects = {{"blur", "blur", 0, {{"effects.blur.width", "", 0, 1}}, {"one"}, true}};
  constexpr int kWorlds = 40, kPiles = 12;
  double together = 0, alone = 0, worst_change = 0;  // squares of errors
  double mean_error = 0, mean_variance = 0, scatter = 0;
  for (int world = 0; world < kWorlds; ++world) {
    Random random(static_cast<std::uint64_t>(world), 0, RandomPurpose::design);
    std::vector<DesignRun> runs;
    for (int k = 0; k < kPiles; ++k) {
      const Eigen::VectorXd base = Eigen::VectorXd::Constant(1, -1 + 2 * (k + 0.5) / kPiles);
      const double of_pile = random.uniform(-1, 1);
      const auto add = [&](double x) {
        ModelPoint at{base, {}};
        if (x > 0) at.effects.push_back({0, Eigen::VectorXd::Constant(1, x)});
        const double y = 2 * base[0] + 0.6 * x + of_pile + 0.1 * random.uniform(-1, 1);
        runs.push_back({at, Eigen::VectorXd::Constant(1, y), "pile" + std::to_string(k)});
      };
      add(0);
      add(static_cast<double>(1 + (5 * k) % kPiles) / kPiles);
    }
    const auto change = [&](const std::vector<DesignRun>& of) {
      const ResponseSurface surface(space, "one", of);
      const Eigen::VectorXd middle = Eigen::VectorXd::Zero(1);
      const SurfacePrediction without = surface.at({middle, {}});
      if (!of.front().pile.empty()) {
        mean_error += without.mean[0] * without.mean[0];
        mean_variance += without.covariance(0, 0);
        scatter += surface.scatter()(0, 0) / kWorlds;
      }
      return surface.at({middle, {{0, Eigen::VectorXd::Constant(1, 1)}}}).mean[0] - without.mean[0] - 0.6;
    };
    const double error = change(runs);
    together += error * error;
    worst_change = std::max(worst_change, std::abs(error));
    for (DesignRun& run : runs) run.pile.clear();
    alone += std::pow(change(runs), 2);
  }
  EXPECT_LT(together, 0.25 * alone) << "of " << kWorlds << " worlds";
  EXPECT_LT(worst_change, 0.6);
  EXPECT_NEAR(scatter, (1 + 0.01) / 3, 0.1) << "variance of one run, however often its pile is read";
  EXPECT_LT(mean_error, 2 * mean_variance) << "the mean is not thought better known than it is";
}

}  // namespace
}  // namespace scree
