// Pictures of sweeps: drawn, with what they are to show; the same map twice is the same picture.
#include "analysis/report/sweep_chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

namespace scree {
namespace {

class SweepChart : public testing::Test {
 protected:
  void SetUp() override {
    file = fs::temp_directory_path() / ("scree_chart_" + std::to_string(getpid()) + ".svg");
  }
  void TearDown() override { fs::remove(file); }
  template <class Chart>
  std::string drawn(const Chart& chart) {
    draw(chart, file);
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }
  ContourMap map() {
    return {"lab", "mu", "mu_r", "angle", {{0.1, 0.2}, {0.1, 0.2}, {{12.75, 21.5}, {13, 25.75}}}, {}, {}};
  }
  fs::path file;
};

TEST_F(SweepChart, MapHasItsNumbersAndTheOneBesideIt) {
  ContourMap one = map();
  const std::string alone = drawn(one);
  EXPECT_THAT(alone, HasSubstr("25.8"));
  EXPECT_THAT(alone, HasSubstr(">lab<"));
  EXPECT_EQ(alone, drawn(one));
  one.beside = ParameterMap{{0.1, 0.2}, {0.1, 0.2}, {{11.75, 21}, {14, 31.5}}};
  const std::string both = drawn(one);
  EXPECT_THAT(both, HasSubstr("lab: simulated"));
  EXPECT_THAT(both, HasSubstr("lab: printed"));
  EXPECT_THAT(both, HasSubstr("25.8"));
  EXPECT_THAT(both, HasSubstr("31.5"));
}

TEST_F(SweepChart, NodesThatAreNotKnownAreLeftOut) {
  ContourMap one = map();
  EXPECT_THAT(drawn(one), HasSubstr(">12.8<"));
  one.map.value[0][0] = NAN;
  EXPECT_THAT(drawn(one), Not(HasSubstr(">12.8<")));
  for (auto& row : one.map.value)
    for (double& value : row) value = 20;
  EXPECT_THROW(draw(one, file), std::invalid_argument);
}

TEST_F(SweepChart, LineShowsWhatWasPrinted) {
  LineChart chart{"lab", "mu", "angle", {{0.1, {12, 1, 3}, NAN}, {0.2, {25, 1, 3}, NAN}}};
  EXPECT_THAT(drawn(chart), Not(HasSubstr("printed")));
  chart.points[0].printed = 11.8;
  EXPECT_THAT(drawn(chart), HasSubstr("printed"));
}

}  // namespace
}  // namespace scree
