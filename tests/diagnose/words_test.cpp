// What a diagnosis says, in words and in its report.
#include "analysis/diagnose/words.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysis/diagnose/fitted_parameters.h"
#include "analysis/report/report_text.h"
#include "tests/diagnose/synthetic.h"

namespace scree {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using Kind = DiagnosisVerdict::Kind;

// Effect 1 is hidden and named; what full simulations show is set by hand.
class Said : public testing::Test {
 protected:
  Said() {
    o.space = world.space;
    o.diagnosis =
        diagnose(world.space, world.measure(SyntheticWorld::point(0.1, 0.1, {{1, 0.6}}), 5, 3), model);
    o.nominal = shown({world.space.nominal(), {}});
    o.calibrated = shown(SyntheticWorld::point(0.2, -0.3));
    o.augmented = shown(SyntheticWorld::point(0.16, 0.1, {{1, 0.55}}));
  }
  SimulatedModel shown(const ModelPoint& at) const {
    SimulatedModel m;
    m.at = at;
    m.runs = 4;
    m.mean = o.diagnosis.measured.vector();
    m.std = Eigen::VectorXd::Zero(m.mean.size());
    return m;
  }
  std::string words() const { return fmt::format("{}", fmt::join(diagnosis_in_words(o), "\n")); }
  const Judgement& named() const { return o.diagnosis.judgements[o.diagnosis.verdict.named.at(0)]; }

  SyntheticWorld world;
  LearntModel model{world.space, world.experiments, world.design(1)};
  DiagnosisOutcome o;
};

// The median of an interval is not the best fit, which is what is simulated: 0.2 + 0.1 * 0.16 of `a`, 0.5 +
// 0.3 * 0.1 of `b`.
TEST_F(Said, WhatIsStatedAndWhatWasSimulated) {
  ASSERT_EQ(o.diagnosis.verdict.kind, Kind::effect);
  const Judgement::Interval i = named().effects[0][0];
  const std::string stated = fmt::format("effect1.size {} ({} to {})", number_text(i.middle),
                                         number_text(i.low), number_text(i.high));
  ASSERT_NE(number_text(i.middle), "0.550");
  EXPECT_THAT(words(), AllOf(HasSubstr(stated),
                             HasSubstr("written to the scenarios, is of the models tried the nearest to the "
                                       "data: a 0.216, b 0.530, effect1.size 0.550.")));
  EXPECT_THAT(simulated_in_words(o),
              Contains(fmt::format("effect1.size 0.550 (middle of its interval {}, {} to {})",
                                   number_text(i.middle), number_text(i.low), number_text(i.high))));
  o.augmented.reset();
  o.calibrated.reset();
  EXPECT_THAT(words(), Not(HasSubstr("written to the scenarios")));
}

}  // namespace
}  // namespace scree
