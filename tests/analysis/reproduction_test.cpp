// The cases of the thesis beside ours.
#include "analysis/cases/reproduction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scree_version.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;

CaseResult runs(const char* name, std::initializer_list<double> chi) {
  CaseResult result;
  result.name = name;
  for (const double value : chi)
    result.runs.seeds.push_back({{"sections", 6}, {"dumps", 4}, {"chi_S1", value}, {"chi_S6", 0.3}});
  return result;
}

TEST(Trends, WelchByHand) {
  // Means 3 and 1, variances 1 and 4, three values each: t = 2 / sqrt(1/3 + 4/3) = 1.549, degrees of freedom
  // (5/3)^2 / ((1/3)^2 / 2 + (4/3)^2 / 2) = 2.941; two-sided p = 0.221, t at 0.975 is 3.220.
  const std::vector<CaseResult> cases{runs("b1", {2, 3, 4}), runs("a1", {-1, 1, 3})};
  Trend trend{"B1", "A1", "chi", "S1", 0.28, false, false, "T"};
  const auto compared = compare_trends(cases, {trend});
  ASSERT_EQ(compared.size(), 1u);
  EXPECT_DOUBLE_EQ(compared[0].difference, 2);
  EXPECT_NEAR(compared[0].p, 0.221, 0.002);
  EXPECT_NEAR(compared[0].high - compared[0].difference, 3.220 * std::sqrt(5.0 / 3), 0.01);
  EXPECT_EQ(compared[0].verdict, TrendVerdict::undecided) << "0.28 lies within -2.2 to 6.2";
  trend.difference = 6.5;
  EXPECT_EQ(compare_trends(cases, {trend})[0].verdict, TrendVerdict::not_seen);
  trend.relative = true;  // over |1|; deviation of 3 / 1 is sqrt(1/3 + 9 * 4/3)
  EXPECT_DOUBLE_EQ(compare_trends(cases, {trend})[0].difference, 2);
  // Its degrees of freedom: (1/3 + 12)^2 / ((1/3)^2 / 2 + 12^2 / 2) = 2.111, t 4.093.
  EXPECT_NEAR(compare_trends(cases, {trend})[0].high - 2, 4.093 * std::sqrt(1.0 / 3 + 12), 0.02);
}

// chi of S1 as PFC3D's repeats have it.
ReferenceValue printed_chi(double mean, std::optional<double> std, int repeats) {
  ReferenceValue row{"D", "chi", "S1", "pfc3d", mean, std, "-", "eq", "T"};
  row.repeats = repeats;
  return row;
}

TEST(Trends, ThePrintedDifferenceScattersLikeItsRepeats) {
  // Ours as above: 2 +- 4.157. Five repeats of a deviation of 1 in both: sqrt(2 / 5) with 8 degrees of
  // freedom (t 2.306), half of the interval 1.458; together sqrt(4.157^2 + 1.458^2) = 4.405.
  std::vector<CaseResult> cases{runs("b1", {2, 3, 4}), runs("a1", {-1, 1, 3})};
  const auto print = [&](std::size_t k, const std::vector<ReferenceValue>& rows) {
    cases[k].comparison = compare_with_reference(cases[k].runs.seeds, rows, {"D"});
  };
  const auto judge = [&](double difference, bool relative) {
    return compare_trends(cases, {{"b1", "a1", "chi", "S1", difference, relative, false, "T"}})[0];
  };
  print(0, {printed_chi(5.4, 1, 5)});
  print(1, {printed_chi(-1, 1, 5)});
  EXPECT_NEAR(judge(6.4, false).printed.half, 1.458, 1e-3);
  EXPECT_EQ(judge(6.38, false).verdict, TrendVerdict::undecided);
  EXPECT_EQ(judge(6.43, false).verdict, TrendVerdict::not_seen);
  // Relative to the magnitude of -1: 0.28 more is 0.72 of it, and the deviation sqrt(1/5 + 0.72^2 / 5);
  // degrees of freedom (1 + 0.5184)^2 / ((1 + 0.5184^2) / 4) = 7.27, t 2.347.
  EXPECT_NEAR(judge(0.28, true).printed.half, 2.347 * std::sqrt(1.5184 / 5), 1e-3);
  // One that is not printed takes the other's, of which 4 degrees of freedom are known: t 2.776.
  print(0, {printed_chi(5.4, std::nullopt, 5)});
  EXPECT_NEAR(judge(6.4, false).printed.half, 2.776 * std::sqrt(0.4), 1e-3);
  EXPECT_FALSE(judge(6.4, false).printed.at_most);
  // Or is a bound of its own.
  ReferenceValue scatter = printed_chi(2, std::nullopt, 5);
  scatter.quantity = "chi_scatter", scatter.relation = "max";
  print(0, {printed_chi(5.4, std::nullopt, 5), scatter});
  EXPECT_TRUE(judge(6.4, false).printed.at_most);
  // sqrt(4/5 + 1/5), 25 / (17 / 4) = 5.88 degrees of freedom, t 2.459.
  EXPECT_NEAR(judge(6.4, false).printed.half, 2.459, 1e-3);
  // The scale |b| of a relative difference is PFC3D's, too: 5.4 is b + 6.4 |b|, so b is 0.7297.
  print(0, {printed_chi(5.4, 1, 5)});
  cases[1].comparison.clear();
  EXPECT_NEAR(judge(6.4, true).printed.half, 2.776 * std::sqrt((1 + 7.4 * 7.4) / 5) / 0.7297, 1e-2);
  print(1, {printed_chi(-1, 1, 0)});
  print(0, {printed_chi(5.4, std::nullopt, 5)});
  EXPECT_EQ(judge(6.4, false).printed.half, 0) << "of how many repeats is not known";
}

TEST(Trends, OppositeOnlyWhereThePrintedSizeIsExcluded) {
  EXPECT_EQ(judged(-0.15, -0.25, -0.05, 0.01, 0.28, 0.5), TrendVerdict::undecided);
  EXPECT_EQ(judged(-0.15, -0.25, -0.05, 0.01, 0.28, 0.1), TrendVerdict::opposite);
}

TEST(Trends, ScatterIsToldWhateverTheSeeds) {
  std::vector<CaseResult> cases{runs("b1", {2}), runs("a1", {-1})};
  for (CaseResult& each : cases)
    each.comparison = compare_with_reference(each.runs.seeds, {printed_chi(1, 1, 5)}, {"D"});
  const auto compared = compare_trends(cases, {{"b1", "a1", "chi", "S1", 1, false, false, "T"}});
  EXPECT_EQ(compared[0].verdict, TrendVerdict::unknown);
  EXPECT_NEAR(compared[0].printed.half, 1.458, 1e-3);
}

TEST(Trends, AreJudgedByDirectionSizeAndBound) {
  // Means 0.5 and 0, standard error sqrt(2 * 1e-4 / 3), 4 degrees of freedom: 0.5 +- 0.023.
  const std::vector<CaseResult> cases{runs("b1", {0.49, 0.5, 0.51}), runs("a1", {-0.01, 0, 0.01})};
  const auto verdict = [&](double printed, bool bound) {
    return compare_trends(cases, {{"b1", "a1", "chi", "S1", printed, false, bound, "T"}})[0].verdict;
  };
  EXPECT_EQ(verdict(0.51, false), TrendVerdict::agrees);
  EXPECT_EQ(verdict(0.3, false), TrendVerdict::other_size);
  EXPECT_EQ(verdict(-0.5, false), TrendVerdict::opposite);
  EXPECT_EQ(verdict(0.6, true), TrendVerdict::within);
  EXPECT_EQ(verdict(0.4, true), TrendVerdict::beyond);
  EXPECT_EQ(verdict(0.5, true), TrendVerdict::undecided);
}

TEST(Trends, NeedTwoSeedsOfBothCases) {
  const Trend trend{"b1", "a1", "chi", "S1", 0.28, false, false, "T"};
  EXPECT_TRUE(compare_trends({runs("b1", {2, 3})}, {trend}).empty());
  EXPECT_EQ(compare_trends({runs("b1", {2, 3}), runs("a1", {1})}, {trend})[0].verdict, TrendVerdict::unknown);
  EXPECT_NE(compare_trends({runs("b1", {2, 3}), runs("a1", {1, 2})}, {trend})[0].verdict,
            TrendVerdict::unknown);
}

TEST(Trends, FileOfTheProjectIsReadAndWrongOnesAreNamed) {
  const fs::path source = SCREE_SOURCE_DIR;
  const auto trends = read_trends(source / "assets/reference/trends.csv");
  EXPECT_GE(trends.size(), 15u);
  for (const Trend& trend : trends) EXPECT_NE(trend.case_name, trend.against);
  const fs::path file = fs::path(testing::TempDir()) / "scree_trends.csv";
  std::ofstream(file) << "case,against,quantity,section,difference,relative,relation,source\n"
                         "B1,A1,chi,S1,0.28,perhaps,eq,line 1\n";
  try {
    read_trends(file);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("scree_trends.csv:2: relative 'perhaps' is none of no yes"));
  }
}

TEST(Bounds, AreKeptOrPassed) {
  ReferenceValue least{"a1", "chi", "S1", "pfc3d", -1.04, std::nullopt, "-", "min", "T"};
  const std::vector<Outputs> seeds = runs("a1", {-1.2, -1.0}).runs.seeds;  // mean -1.1, deviation sqrt(0.02)
  const auto passed = compare_with_reference(seeds, {least}, {"a1"});
  ASSERT_EQ(passed.size(), 1u);
  EXPECT_NEAR(passed[0].z.value(), -0.06 / std::sqrt(0.02), 1e-9);
  least.value = -2;
  EXPECT_EQ(compare_with_reference(seeds, {least}, {"a1"})[0].z.value(), 0) << "kept";
  ReferenceValue range = least;
  range.relation = "range";
  range.upper = -1.5;
  EXPECT_NEAR(compare_with_reference(seeds, {range}, {"a1"})[0].z.value(), 0.4 / std::sqrt(0.02), 1e-9);
  range.upper = -1;
  EXPECT_EQ(compare_with_reference(seeds, {range}, {"a1"})[0].z.value(), 0);
  least.kind = "measured";
  EXPECT_TRUE(compare_with_reference(seeds, {least}, {"a1"}).empty()) << "of single places";
}

TEST(Reproduction, SaysWhatAgreesAndWhatDoesNot) {
  CaseResult a1 = runs("a1", {-1.0, -1.1});
  const ReferenceValue near{"A1", "chi", "S1", "pfc3d", -1.04, 0.33, "-", "eq", "line 1840"};
  const ReferenceValue far{"A1", "chi", "S6", "pfc3d", 0.9, 0.09, "-", "eq", "line 1855"};
  a1.comparison = compare_with_reference(a1.runs.seeds, {near, far}, {"A1"});
  a1.runs.missing = 3;
  const ReproductionWords words = reproduction_in_words({a1}, {});
  EXPECT_THAT(words.runs,
              Contains("a1: 2 runs done, 3 not run, 0 failed, 0 left out because they did not come to rest"));
  EXPECT_THAT(words.counts,
              Contains("1 of 2 values printed of PFC3D agree within two standard deviations (50 %)"));
  EXPECT_THAT(words.apart, Contains(HasSubstr("does not agree: A1 chi S6 (PFC3D): printed 0.9, here 0.3")));
}

TEST(Signs, OfSeedsAreTestedToOneSide) {
  // chi(S1) -1, -2, -3: p 0.0371 by hand (ordered_trend_test.cpp); chi(S6) is 0.3 in every seed: no scatter.
  CaseResult a1 = runs("a1", {-1, -2, -3});
  a1.runs.seeds[0]["chi_zero_x_over_l"] = 0.6, a1.runs.seeds[1]["chi_zero_x_over_l"] = 0.8;
  const auto signs = segregation_signs({a1, runs("b1", {-1}), runs("c1", {})});
  ASSERT_EQ(signs.size(), 2u) << "c1 has no runs";
  EXPECT_NEAR(signs[0].p_crest, 0.0371, 1e-4);
  EXPECT_NEAR(signs[0].zero.mean, 0.7, 1e-12);
  EXPECT_EQ(signs[0].zero.n, 2);
  EXPECT_EQ(signs[0].as_expected, 3);
  EXPECT_TRUE(std::isnan(signs[1].p_crest));
  const auto lines = reproduction_in_words({a1, runs("b1", {-1}), runs("d1", {1, -2})}, {}).trends;
  EXPECT_THAT(lines,
              Contains("a1: chi(S1) -2.00 +- 1.00: below 0, p 0.037; chi(S6) 0.30 +- 0.00: no scatter; chi "
                       "changes sign at x/L 0.70 +- 0.14"));
  EXPECT_THAT(lines, Contains(HasSubstr("b1: chi(S1) -1.00: one seed; chi(S6) 0.30: one seed")));
  // Mean -0.5, deviation 2.121, t = 1/3 with one degree of freedom: p = 1/2 - atan(1/3) / pi.
  EXPECT_THAT(lines, Contains(HasSubstr("d1: chi(S1) -0.50 +- 2.12: not shown to be below 0, p 0.398")));
}

TEST(VelocityTrend, OverAllSeedsBesidePfc3ds) {
  // Velocities 1, 2, 3 with chi 1, 3 | 2, 4 | 3, 5: slope 1, sum of squares left 6, error sqrt(6 / 4 / 4),
  // t = 1.633 with 4 degrees of freedom (t at 0.975 is 2.776): p 0.178. Jonckheere-Terpstra, by
  // pairs of groups 3, 3.5, 3: of (1,3)(2,4) 3 rise, of (1,3)(3,5) 3 and a tie, of (2,4)(3,5) 3; mean 6.
  std::vector<CaseResult> cases{runs("d3", {3, 5}), runs("d1", {1, 3}), runs("d2", {2, 4})};
  for (std::size_t k = 0; k < 3; ++k) cases[k].blade_velocity = k == 0 ? 3.0 : static_cast<double>(k);
  for (std::size_t k = 0; k < 2; ++k)
    cases[k].comparison = compare_with_reference(
        cases[k].runs.seeds,
        {printed_chi(k == 0 ? 0.5 : -0.5, k == 0 ? std::optional(0.3) : std::nullopt, 4)}, {"D"});
  const auto trends = velocity_trends(cases);
  ASSERT_EQ(trends.size(), 1u) << "no D50 ratio in these runs";
  EXPECT_EQ(trends[0].first, "d1");
  EXPECT_EQ(trends[0].runs, 6u);
  EXPECT_NEAR(trends[0].here.slope, 1, 1e-12);
  EXPECT_NEAR(trends[0].here.high, 1 + 2.776 * std::sqrt(1.5 / 4), 1e-3);
  EXPECT_NEAR(trends[0].here.p, 0.178, 5e-4);
  EXPECT_DOUBLE_EQ(trends[0].order.statistic, 9.5);
  EXPECT_DOUBLE_EQ(trends[0].order.expected, 6);
  EXPECT_NEAR(trends[0].printed_slope, 0.5, 1e-12);
  // 1 over 2 m/s, both of a deviation of 0.3 in 4 repeats: sqrt(2 * 0.09 / 4) / 2, t of 3 degrees 3.182.
  EXPECT_NEAR(trends[0].printed_slope_half.half, 3.182 * std::sqrt(0.045) / 2, 1e-3);
  EXPECT_EQ(trends[0].verdict, TrendVerdict::undecided);
  ASSERT_EQ(trends[0].means.size(), 3u);
  EXPECT_EQ(trends[0].means[1].x, 2);
  EXPECT_EQ(trends[0].means[1].y, 3);
  EXPECT_THAT(
      reproduction_in_words(cases, {}).trends,
      Contains(HasSubstr("chi of S1 over the velocity of the blade, d1 to d3, 6 runs: slope +1.00 per m/s "
                         "(95 % -0.70 to +2.70, p 0.178); Jonckheere-Terpstra p 0.")));
  cases.pop_back();
  EXPECT_TRUE(velocity_trends(cases).empty()) << "two velocities are no trend";
}

// Slope sum (x - 2) y / 14 over 0, 1, 5: variances of means 0.04 (4 degrees of freedom), 0.36 (3) and, taken
// from these, their mean; weighted 4, 1, 9, so that the first two count 4 + 9/2 and 1 + 9/2. A scatter
// without a mean is one of those that are taken, of three: 4 + 3, 1 + 3 and 3.
TEST(VelocityTrend, PrintedSlopeScattersLikeItsMeans) {
  std::vector<PrintedMean> printed{
      {1.0, 0.2 * std::sqrt(5), false, 5}, {2.0, 0.6 * std::sqrt(4), false, 4}, {3.0, {}, false, 5}};
  // Parts 0.34 and 1.98: freedom 2.32^2 / (0.34^2 / 4 + 1.98^2 / 3) = 4.028, t 2.770.
  EXPECT_NEAR(half_of_slope({0, 1, 5}, printed).half, 2.770 * std::sqrt(2.32) / 14, 1e-3);
  printed.push_back({{}, 0.4 * std::sqrt(6), true, 6});
  // Parts 0.28, 1.44, 0.48: freedom 2.2^2 / (0.28^2 / 4 + 1.44^2 / 3 + 0.48^2 / 5) = 6.400, t 2.411.
  const PrintedHalf more = half_of_slope({0, 1, 5, 9}, printed);
  EXPECT_NEAR(more.half, 2.411 * std::sqrt(2.2) / 14, 1e-3);
  EXPECT_TRUE(more.at_most);
  printed[2].std = 0.1 * std::sqrt(5);  // nothing is borrowed any more
  EXPECT_FALSE(half_of_slope({0, 1, 5, 9}, printed).at_most);
  EXPECT_EQ(half_of_slope({0, 1}, {{1.0, {}, false, 5}, {2.0, {}, false, 5}}).half, 0);
}

TEST(Reproduction, ReportHasItsTablesAndFigures) {
  const fs::path folder = fs::path(testing::TempDir()) / "scree_reproduction";
  fs::remove_all(folder);
  CaseResult a1 = runs("a1", {-1.0, -1.1}), b1 = runs("b1", {-0.5, -0.6});
  for (CaseResult* each : {&a1, &b1})
    for (Outputs& seed : each->runs.seeds)
      for (int k = 2; k < 6; ++k) seed["chi_S" + std::to_string(k)] = 0.1 * k;
  a1.comparison = compare_with_reference(
      a1.runs.seeds, {{"A1", "chi", "S1", "pfc3d", -1.04, 0.33, "-", "eq", "line 1840"}}, {"A1"});
  const auto trends = compare_trends({a1, b1}, {{"b1", "a1", "chi", "S1", 0.28, false, false, "line 1840"}});
  write_reproduction({a1, b1}, trends, folder);
  std::ifstream in(folder / "report.html");
  std::ostringstream page;
  page << in.rdbuf();
  for (const char* text : {"same direction, size within both scatters", "2 of 2" /* seeds with both signs */,
                           "p of χ &lt; 0", "x/L where χ changes sign", "figure 6.7 of the thesis"})
    EXPECT_NE(page.str().find(text), std::string::npos) << text;
  EXPECT_TRUE(fs::exists(folder / "pictures" / "payload_chi.svg"));
  EXPECT_FALSE(fs::exists(folder / "pictures" / "lab_chi.svg")) << "no such runs";
  fs::remove_all(folder);
}

}  // namespace
}  // namespace scree
