// Charts along a slope: that their key can be read.
#include "analysis/report/profile_chart.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace scree {
namespace {

using testing::HasSubstr;
using testing::Not;

class ProfileChartTest : public testing::Test {
 protected:
  ~ProfileChartTest() override { std::filesystem::remove(file_); }

  std::string drawn(const ProfileChart& chart) const {
    draw(chart, file_);
    std::ifstream in(file_);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  static ChartSeries series(const std::string& name, ChartSeries::Kind kind) {
    return {name, kind, 0, {{0.25, -0.5, 0.1}, {0.75, 0.5, 0.1}}};
  }

  const std::filesystem::path file_ = std::filesystem::path(testing::TempDir()) /
                                      ("scree_profile_chart_" + std::to_string(getpid()) + ".svg");
};

struct Place {
  double x = 0, y = 0;  // pixels from the upper left corner
};

/// Where a text of an SVG of gnuplot's begins.
Place place_of(const std::string& svg, const std::string& text) {
  static const std::string kMove = "translate(";
  const std::size_t word = svg.find(text);
  EXPECT_NE(word, std::string::npos) << text;
  const std::size_t move = svg.rfind(kMove, word);
  std::istringstream numbers(svg.substr(move + kMove.size(), 40));
  Place place;
  char comma = 0;
  numbers >> place.x >> comma >> place.y;
  return place;
}

TEST_F(ProfileChartTest, TheKeyLiesBelowTheLabelOfTheAxis) {
  for (const int cases : {1, 2, 9}) {
    ProfileChart chart{"Title", "along the slope", "chi", true, {}};
    for (int k = 0; k < cases; ++k) {
      chart.series.push_back(series(fmt::format("case{}", k), ChartSeries::Kind::ours));
      chart.series.push_back(series(fmt::format("case{}", k), ChartSeries::Kind::pfc3d));
    }
    const std::string svg = drawn(chart);
    const double label = place_of(svg, "along the slope").y;
    for (int k = 0; k < cases; ++k) {
      const Place key = place_of(svg, cases == 1 ? "PFC3D" : fmt::format("case{}, PFC3D", k));
      EXPECT_GE(key.y, label + 15) << cases;  // letters are 13 pixels high
      EXPECT_LE(key.x + 80, 760) << "the width of the picture";
    }
  }
}

TEST_F(ProfileChartTest, LongNamesGoToFurtherRows) {
  ProfileChart chart{"", "along the slope", "chi", true, {}};
  for (int k = 0; k < 4; ++k)
    chart.series.push_back(
        series(fmt::format("option {} of a study with a name of forty letters", k), ChartSeries::Kind::ours));
  const std::string svg = drawn(chart);
  for (int k = 0; k < 4; ++k)
    EXPECT_LE(place_of(svg, fmt::format("option {} of", k)).x, 400) << "50 letters of 7 pixels fit beside it";
}

TEST_F(ProfileChartTest, ALabelStandsForNameAndKind) {
  ProfileChart chart{"", "along the slope", "chi", true, {}};
  chart.series = {series("slope", ChartSeries::Kind::ours), series("slope", ChartSeries::Kind::measured)};
  EXPECT_THAT(drawn(chart), HasSubstr("here"));
  chart.series[0].label = "known rock";
  const std::string svg = drawn(chart);
  EXPECT_THAT(svg, HasSubstr("known rock"));
  EXPECT_THAT(svg, Not(HasSubstr("here")));
  EXPECT_THAT(svg, HasSubstr("measured"));
}

}  // namespace
}  // namespace scree
