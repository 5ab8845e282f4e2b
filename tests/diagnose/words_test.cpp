// What a diagnosis says, in words and in its report.
#include "analysis/diagnose/words.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

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

// `a` lies between 0.1 and 0.3: 0.2961 is within 2 % of 0.2 of its end, 0.2959 is not.
TEST_F(Said, ParametersAtTheEndOfTheirRange) {
  Judgement& j = o.diagnosis.calibration;
  const auto at_end = [&](double a) {
    j.base[0] = {0.1, 0.2, 0.3};
    j.best.base[0] = o.space.base[0].coordinate(a);
    o.calibrated->at.base[0] = 0;
    return fitted_parameters(o.space, j, &*o.calibrated)[0].at_end;
  };
  EXPECT_FALSE(at_end(0.2959));
  EXPECT_THAT(words(), Not(HasSubstr("re-calibrated a")));
  EXPECT_TRUE(at_end(0.2961));
  EXPECT_THAT(words(),
              HasSubstr("At the end of its range: re-calibrated a 0.296 of a range from 0.100 to 0.300"));
  EXPECT_THAT(words(), HasSubstr("Widen it in the model file if rock may be so."));
  // What was simulated lies there, and the fit does not: that value is the one said.
  j.best.base[0] = 0;
  o.calibrated->at.base[0] = -1;
  EXPECT_NEAR(fitted_parameters(o.space, j, &*o.calibrated)[0].at_end.value_or(0), 0.1, 1e-12);
  EXPECT_THAT(words(), HasSubstr("re-calibrated a 0.100 of a range from 0.100 to 0.300"));
  o.diagnosis.verdict = {Kind::nothing, {}};
  o.augmented.reset();
  EXPECT_THAT(words(), Not(HasSubstr("Widen it")));
  EXPECT_FALSE(fitted_models(o)[0].parameters[0].at_end) << "nor marked in the report";
}

// Effect 1 lies between 0, where it does nothing, and 1: there is nothing to look for beyond 0.
TEST_F(Said, AnEffectThatIsAbsentIsNotAtTheEndOfItsRange) {
  Judgement j = named();
  const auto at_end = [&](double amplitude) {
    j.best.effects[0].at[0] = amplitude;
    return fitted_parameters(o.space, j, nullptr).back().at_end;
  };
  EXPECT_FALSE(at_end(0.001));
  EXPECT_TRUE(at_end(0.99));
}

TEST_F(Said, GapsSayHowTheyWereMeasured) {
  o.nominal.gap = {90.5, 11, 1e-9};
  o.calibrated->gap = {50.5, 11, 1e-4};
  o.augmented->gap = {9.25, 11, 0.6};
  EXPECT_THAT(words(),
              AllOf(HasSubstr("Gap by the fitted surfaces: as it is " + gap_in_words(o.diagnosis.nominal) +
                              "; best parameters " + gap_in_words(o.diagnosis.calibration.gap) +
                              "; with effect1 " + gap_in_words(named().gap)),
                    HasSubstr("Gap by full simulations, all numbers free: as it is chi-square 90.5 on "
                              "11, p < 0.001 (4 seeds); best parameters chi-square 50.5 on 11, p < "
                              "0.001 (4 seeds); with effect1 chi-square 9.25 on 11, p = 0.600 (4 "
                              "seeds).")));
}

// Two numbers, two parameters: whatever is left says nothing.
TEST_F(Said, AsManyParametersAsNumbersAreNoTest) {
  Measurements few = world.measure(SyntheticWorld::point(0.5, -0.6), 5, 1);
  EXPECT_TRUE(diagnose(world.space, few, model).calibration.gap.is_test);
  const DesignRuns all = world.design(1);
  DesignRuns runs(2);
  for (std::size_t e = 0; e < 2; ++e)
    for (const DesignRun& run : all[e]) runs[e].push_back({run.at, run.outputs.head(1)});
  few.values = {few.values[0], few.values[6]};
  few.covariance = Eigen::Matrix2d(few.covariance({0, 6}, {0, 6}));
  const Diagnosis d = diagnose(world.space, few, LearntModel(world.space, world.experiments, runs));
  EXPECT_TRUE(d.nominal.is_test) << "nothing is fitted";
  EXPECT_FALSE(d.calibration.gap.is_test);
  EXPECT_THAT(gap_in_words(d.calibration.gap), HasSubstr("with no more numbers than parameters: no test"));
}

class Report : public Said {
 protected:
  Report() {
    std::filesystem::create_directories(folder);
    const std::string one = "chi of <\"S1\"";
    write_diagnosis({"Model",
                     "/data/model.yaml",
                     {{one, "", "/data/a.yaml"}},
                     "scree 5 (r)",
                     "2026-01-02",
                     "scree diagnose a.yaml"},
                    o, folder);
    page = slurp(folder / "report.html");
    json = nlohmann::json::parse(slurp(folder / "diagnosis.json"));
  }
  ~Report() override { std::filesystem::remove_all(folder); }
  static std::string slurp(const std::filesystem::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("scree_words_" + std::to_string(getpid()));
  std::string page;
  nlohmann::json json;
};

TEST_F(Report, SaysWhereItComesFrom) {
  for (const char* part : {"chi of &lt;&quot;S1", "not stated", "/data/a.yaml", "/data/model.yaml",
                           "scree 5 (r)", "2026-01-02", "scree diagnose a.yaml"})
    EXPECT_THAT(page, HasSubstr(part));
  EXPECT_EQ(json["origin"]["command"], "scree diagnose a.yaml");
  EXPECT_EQ(json["origin"]["datasets"][0]["file"], "/data/a.yaml");
  EXPECT_EQ(json["origin"]["model"]["file"], "/data/model.yaml");
}

TEST_F(Report, ShowsParametersAndBothUncertainties) {
  EXPECT_NEAR(json["fitted"]["with what was found"]["effect1.size"]["simulated"], 0.55, 1e-12);
  EXPECT_THAT(page, HasSubstr("<td class=\"word\">effect1.size</td>"));
  EXPECT_THAT(page, HasSubstr("<th>stated</th><th>used</th>"));
  const MeasuredValue& first = o.diagnosis.measured.values[0];
  EXPECT_THAT(page, HasSubstr(fmt::format("<td>{}</td><td>{}</td>", number_text(first.uncertainty),
                                          number_text(std::sqrt(o.diagnosis.covariance(0, 0))))));
}

// Three of the four effects share a pair with the one that is named.
TEST_F(Report, ShowsWhatIsAlikeHoweverLittle) {
  const auto begin = page.find("With what leads:"), end = page.find("</ul>", begin);
  ASSERT_NE(begin, std::string::npos);
  const std::string list = page.substr(begin, end - begin);
  for (const char* other : {"effect0", "effect2", "effect3"})
    EXPECT_THAT(list, HasSubstr(fmt::format("<li>effect1 and {}: ", other)));
}

// Of nine pairs, six are shown; re-calibration, all effects and what is unknown always are.
TEST_F(Report, ShowsAllEffectsAndTheMostProbablePairs) {
  std::vector<Judgement>& all = o.diagnosis.judgements;
  const Judgement one = named();
  for (int k = 0; k < 9; ++k) {
    all.insert(all.begin() + 1 + k, one);
    Judgement& pair = all[static_cast<std::size_t>(1 + k)];
    pair.hypothesis.effects = {0, 1};
    pair.effects.push_back(pair.effects[0]);
    pair.probability = 0.1 - 0.01 * k;
  }
  write_diagnosis({}, o, folder);
  page = slurp(folder / "report.html");
  EXPECT_THAT(page, HasSubstr("And 3 further pairs, none above 0.040."));
  for (const char* row : {"no effect (re-calibration alone)", "effect0", "effect1", "effect2", "effect3"})
    EXPECT_THAT(page, HasSubstr(fmt::format("<tr><td class=\"word\">{}</td>", row)));
  EXPECT_THAT(page, testing::ContainsRegex("something unknown</td><td>[0-9.]*</td><td></td><td></td>"));
}

}  // namespace
}  // namespace scree
