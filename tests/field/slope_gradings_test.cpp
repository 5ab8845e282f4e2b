// Tables of gradings by picture and section, as users write them.
#include "analysis/field/slope_gradings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "sim/material/input_text.h"

namespace scree {
namespace {

using testing::HasSubstr;

class SlopeGradingsTable : public testing::Test {
 protected:
  void SetUp() override {
    file = std::filesystem::temp_directory_path() / ("scree_slope_" + std::to_string(getpid()) + ".csv");
  }
  void TearDown() override { std::filesystem::remove(file); }
  SlopeGradings read(const std::string& text) {
    std::ofstream(file) << text;
    return read_slope_gradings(file);
  }
  std::string error(const std::string& text) {
    try {
      read(text);
    } catch (const FileError& wrong) {
      return wrong.what();
    }
    return "no error";
  }
  std::filesystem::path file;
};

TEST_F(SlopeGradingsTable, CharacteristicDiameters) {
  const SlopeGradings gradings = read(
      "# a comment\nimage,section,d10_cm,d50_cm,d90_cm,chi\n"
      "a,whole,10.0,20.0,40.0,\na,1,5.0,10.0,20.0,-0.5\nb,S2,10,30,90,0.2\n");
  ASSERT_EQ(gradings.pictures.size(), 2u);
  EXPECT_EQ(gradings.sections, 2);
  EXPECT_DOUBLE_EQ(gradings.half_digit, 0.0005);
  const auto& a = gradings.pictures[0];
  ASSERT_TRUE(a.curves[0] && a.curves[1] && !a.curves[2]);
  EXPECT_NEAR(a.curves[0]->diameter(0.5), 0.20, 1e-12);
  // Straight on in log d: from D50 to D90 the diameter doubles over 0.4, so by 2^(1/4) over 0.1.
  EXPECT_NEAR(a.curves[0]->max_diameter(), 0.40 * std::pow(2, 0.25), 1e-12);
  EXPECT_NEAR(a.curves[0]->min_diameter(), 0.10 / std::pow(2, 0.25), 1e-12);
  EXPECT_DOUBLE_EQ(a.given_chi[1], -0.5);
  EXPECT_TRUE(std::isnan(a.given_chi[0]));
  EXPECT_NEAR(gradings.pictures[1].curves[2]->diameter(0.9), 0.9, 1e-12);
}

TEST_F(SlopeGradingsTable, PassingCurves) {
  const SlopeGradings gradings = read(
      "image,section,diameter_mm,passing_pct\n1,S1,100,0\n1,S1,200,40\n1,S1,400,100\n1,0,100,0\n1,0,800,"
      "100\n");
  EXPECT_NEAR(gradings.pictures[0].curves[1]->passing(0.2), 0.4, 1e-12);
  EXPECT_NEAR(gradings.pictures[0].curves[0]->max_diameter(), 0.8, 1e-12);
  EXPECT_EQ(gradings.half_digit, 0);
}

// Sieves that nothing or all passes, fine or coarse first.
TEST_F(SlopeGradingsTable, TheOrderOfSievesIsOfNoWeight) {
  const std::string head = "image,section,diameter_mm,passing_pct\n";
  const SlopeGradings fine = read(head + "a,1,10,0\na,1,20,0\na,1,100,50\na,1,200,100\na,1,400,100\n"),
                      coarse = read(head + "a,1,400,100\na,1,200,100\na,1,100,50\na,1,20,0\na,1,10,0\n");
  for (const SlopeGradings& gradings : {fine, coarse}) {
    const Grading& curve = *gradings.pictures[0].curves[1];
    EXPECT_DOUBLE_EQ(curve.min_diameter(), 0.02);
    EXPECT_DOUBLE_EQ(curve.max_diameter(), 0.2);
  }
}

TEST_F(SlopeGradingsTable, GrainsCountByTheirVolume) {
  // 8 grains of 1 and one of 2: half of the volume each.
  std::string text = "image,section,diameter_m\n1,1,2\n";
  for (int k = 0; k < 8; ++k) text += "1,1,1\n";
  const Grading curve = *read(text).pictures[0].curves[1];
  EXPECT_NEAR(curve.passing(1), 0.5, 1e-12);
  EXPECT_NEAR(curve.diameter(1), 2, 1e-12);
}

TEST_F(SlopeGradingsTable, WhatIsWrongIsNamedWithItsLine) {
  EXPECT_THAT(error("image,d50_cm\n1,2\n"), HasSubstr(":1: the header has no section"));
  EXPECT_THAT(error("image,section,d10_cm,d50_cm\n1,1,2,3\n"), HasSubstr("three columns"));
  EXPECT_THAT(error("image,section,d10_cm,d50_cm,d90_cm\n1,top,1,2,3\n"), HasSubstr(":2: section 'top'"));
  EXPECT_THAT(error("image,section,d10_cm,d50_cm,d90_cm\n1,1,1,2,3\n1,S1,1,2,3\n"),
              HasSubstr(":3: image 1 section 1 stands already in line 2"));
  EXPECT_THAT(error("image,section,d10_cm,d50_cm,d90_cm\n1,1,3,2,4\n"),
              HasSubstr(":2: image 1 section 1: diameters must rise"));
  EXPECT_THAT(error("image,section,d10_cm,d50_cm,d90_cm\n1,1,-3,2,4\n"), HasSubstr("above 0"));
  EXPECT_THAT(error("image,section,d10_cm,d50_cm,d90_cm\n1,0,1,2,4\n"), HasSubstr("no sections"));
  EXPECT_THAT(error("image,section,d10_cm,d50_cm,d90_cm\n"), HasSubstr("no grading"));
  EXPECT_THAT(error("image,section,d10_cm,d50_cm,d101_cm\n1,1,1,2,3\n"), HasSubstr("D0 to D100"));
  EXPECT_THAT(error("image,section,diameter_mm,passing_pct\n1,1,10,0\n1,1,20,140\n"),
              HasSubstr(":3: passing_pct"));
  EXPECT_THAT(error("image,section,diameter_mm\n1,1,10\n"), HasSubstr("two sizes"));
}

}  // namespace
}  // namespace scree
