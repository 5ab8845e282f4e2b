// Disposal options held against each other.
#include "analysis/cases/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/statistics/welch.h"

namespace scree {
namespace {

StudyOption option(const char* name, std::initializer_list<double> crest) {
  StudyOption result;
  result.name = name;
  for (const double chi : crest)
    result.runs.seeds.push_back(
        {{"sections", 6}, {"chi_S1", chi}, {"chi_S6", 0.5}, {"d50_m_S1", 0.2}, {"d50_m_S6", 1.0}});
  return result;
}

TEST(Welch, ByHand) {
  // Means 3 and 1, variances 1 and 4, three values each: t = 2 / sqrt(5/3) = 1.549 with 2.941 degrees of
  // freedom.
  const Welch test = welch(mean_std({2, 3, 4}), mean_std({-1, 1, 3}));
  EXPECT_TRUE(test.known);
  EXPECT_DOUBLE_EQ(test.difference, 2);
  EXPECT_NEAR(test.error, std::sqrt(5.0 / 3), 1e-12);
  EXPECT_NEAR(test.p, 0.221, 0.002);
  EXPECT_NEAR(test.t_95, 3.220, 0.01);
  EXPECT_FALSE(welch(mean_std({1}), mean_std({1, 2})).known);
}

TEST(Study, DifferencesWithinTheScatterAreTies) {
  // chi ranges 1.0, 1.02, 2.0 with scatters of 0.1: the first two are a tie.
  const std::vector<StudyOption> options{option("worst", {-1.4, -1.5, -1.6}),
                                         option("good", {-0.4, -0.5, -0.6}),
                                         option("as good", {-0.42, -0.52, -0.62})};
  const auto ranks = rank_options(options, *study_criterion("chi_range"));
  ASSERT_EQ(ranks.size(), 3u);
  EXPECT_EQ(options[ranks[0].option].name, "good");
  EXPECT_EQ(ranks[0].rank, 1);
  EXPECT_EQ(options[ranks[1].option].name, "as good");
  EXPECT_EQ(ranks[1].rank, 1);
  EXPECT_GT(ranks[1].p, 0.05);
  EXPECT_EQ(options[ranks[2].option].name, "worst");
  EXPECT_EQ(ranks[2].rank, 3);
  EXPECT_NEAR(ranks[2].value.mean, 2.0, 1e-12);
  EXPECT_THAT(study_in_words(options, *study_criterion("chi_range")),
              testing::Contains(testing::HasSubstr("1. good: 1 +- 0.1 (tie)")));
  EXPECT_EQ(study_answer(options, *study_criterion("chi_range")),
            "These runs do not tell good and as good apart by χ of the toe less χ of the crest: their "
            "differences to the "
            "smallest mean, 1 ± 0.1 of good, are within the scatter of seeds; then worst, 2 ± 0.1.");
}

TEST(Study, OneSeedIsNotRanked) {
  const std::vector<StudyOption> options{option("one", {-0.1}), option("two", {-2.0, -2.1}),
                                         option("three", {-1.0, -1.1})};
  const auto ranks = rank_options(options, *study_criterion("chi_range"));
  ASSERT_EQ(ranks.size(), 3u);
  EXPECT_EQ(options[ranks[0].option].name, "three");
  EXPECT_EQ(ranks[0].rank, 1);
  EXPECT_EQ(ranks[1].rank, 2);
  EXPECT_EQ(options[ranks[2].option].name, "one") << "behind the others, though its value is the least";
  EXPECT_FALSE(ranks[2].rank.has_value());
  EXPECT_THAT(study_in_words(options, *study_criterion("chi_range")),
              testing::Contains("one: 0.6 (not ranked: of one run the scatter is not known)"));
  EXPECT_EQ(study_answer(options, *study_criterion("chi_range")),
            "three is best by χ of the toe less χ of the crest: 1.55 ± 0.071; then two, 2.55 ± 0.071; not "
            "ranked, with one run: one (0.6).");
  EXPECT_EQ(study_answer({option("one", {-0.1}), option("two", {-2.0, -2.1})}, *study_criterion("chi_range")),
            "Of two alone χ of the toe less χ of the crest is known with its scatter: 2.55 ± 0.071; not "
            "ranked, with one run: one (0.6).");
  EXPECT_EQ(study_answer({option("one", {-0.1})}, *study_criterion("chi_range")),
            "No option is ranked by χ of the toe less χ of the crest yet: it takes two runs of each.");
}

TEST(Study, RatiosAreToeOverCrest) {
  const auto ranks = rank_options({option("a", {-0.1, -0.2})}, *study_criterion("d50_ratio"));
  EXPECT_DOUBLE_EQ(ranks[0].value.mean, 5);
  EXPECT_EQ(study_criterion("beauty"), nullptr);
  EXPECT_TRUE(rank_options({option("a", {-0.1})}, *study_criterion("lateral_chi_std")).empty())
      << "no such number";
}

}  // namespace
}  // namespace scree
