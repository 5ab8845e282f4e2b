// Passing curves of grains, sections of a slope, and the segregation degree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "analysis/pile/segregation.h"
#include "scree_version.h"
#include "sim/material/grading.h"

namespace scree {
namespace {

constexpr double density = 2760;  // kg/m3

Grain grain(double diameter, double z, double mass) {
  Grain g;
  g.position = Vec3(0, 0, z);
  g.velocity = Vec3::Zero();
  g.diameter = diameter;
  g.mass = mass;
  return g;
}

/// Spheres of the QB0 grading, 300 t, at height z.
std::vector<Grain> load(double z = 1.0) {
  const Grading grading =
      read_grading(std::filesystem::path(SCREE_SOURCE_DIR) / "assets" / "gradings" / "QB0.csv");
  std::vector<Grain> grains;
  for (const double d : generate_diameters(grading, 300e3, {density}, 1, 1))
    grains.push_back(grain(d, z, density * std::numbers::pi / 6 * d * d * d));
  return grains;
}

TEST(PassingCurve, StepsAtEachGrain) {
  const PassingCurve curve({0.4, 0.1, 0.2, 0.2}, {4, 1, 2, 3});
  EXPECT_DOUBLE_EQ(curve.mass(), 10);
  EXPECT_DOUBLE_EQ(curve.passing(0.09), 0);
  EXPECT_DOUBLE_EQ(curve.passing(0.1), 0.1);  // 1 of 10 kg
  EXPECT_DOUBLE_EQ(curve.passing(0.19), 0.1);
  EXPECT_DOUBLE_EQ(curve.passing(0.2), 0.6);  // (1 + 2 + 3) of 10 kg
  EXPECT_DOUBLE_EQ(curve.passing(0.4), 1);
}

TEST(PassingCurve, DiameterIsLinearInLogBetweenGrains) {
  const PassingCurve curve({0.1, 0.2, 0.4}, {1, 5, 4});
  EXPECT_DOUBLE_EQ(curve.diameter(0.0), 0.1);
  EXPECT_DOUBLE_EQ(curve.diameter(0.1), 0.1);
  EXPECT_NEAR(curve.diameter(0.35), 0.1 * std::sqrt(2), 1e-12);  // half way from 0.1 to 0.6
  EXPECT_NEAR(curve.diameter(0.8), 0.2 * std::sqrt(2), 1e-12);   // half way from 0.6 to 1
  EXPECT_DOUBLE_EQ(curve.diameter(1.0), 0.4);
}

TEST(PassingCurve, QuartilesSplitTheGrainAcrossTheirBound) {
  // 8 kg; coarsest quartile 2 kg: all of the 0.5 kg at 1 m and 1.5 kg of the 3.5 kg at 0.1 m.
  const PassingCurve curve({0.01, 0.1, 1.0}, {4, 3.5, 0.5});
  EXPECT_NEAR(curve.mean_log_diameter(), (4 * -2 + 3.5 * -1 + 0.5 * 0) / 8, 1e-12);
  EXPECT_NEAR(curve.coarsest_quartile_log_diameter(), (1.5 * -1 + 0.5 * 0) / 2, 1e-12);
}

TEST(PassingCurve, RefusesEmptyAndUnequal) {
  EXPECT_THROW(PassingCurve({}, {}), std::invalid_argument);
  EXPECT_THROW(PassingCurve({1}, {1, 2}), std::invalid_argument);
  EXPECT_THROW(PassingCurve({1, 0}, {1, 2}), std::invalid_argument);
  EXPECT_THROW(PassingCurve({1, 1}, {1, -2}), std::invalid_argument);
}

TEST(PassingCurve, SieveSumConvergesToTheMassMean) {
  // log d = sum (P_i - P_i-1) log10 sqrt(D_i D_i-1): with n sieves a decade each grain is misplaced by at
  // most half a class, 1 / (2 n).
  std::vector<double> diameters, masses;
  for (const Grain& g : load()) {
    diameters.push_back(g.diameter);
    masses.push_back(g.mass);
  }
  const PassingCurve curve(diameters, masses);
  double error_before = 1;
  for (const int per_decade : {5, 50, 500}) {
    double sum = 0;
    for (int i = 0; i <= 2 * per_decade; ++i) {  // from 0.05 m to 5 m
      const double fine = 0.05 * std::pow(10, static_cast<double>(i) / per_decade);
      const double coarse = fine * std::pow(10, 1.0 / per_decade);
      sum += (curve.passing(coarse) - curve.passing(fine)) * std::log10(std::sqrt(fine * coarse));
    }
    const double error = std::abs(sum - curve.mean_log_diameter());
    EXPECT_LT(error, 0.5 / per_decade);
    EXPECT_LT(error, error_before);
    error_before = error;
  }
}

TEST(Sections, SmallCaseByHand) {
  // Original: 3 kg of 0.1 m and 1 kg of 1 m. log d0 = (3 * -1 + 1 * 0) / 4 = -0.75; D75 parts them, log d_CQ
  // = 0.
  const std::vector<Grain> original{grain(0.1, 0, 3), grain(1.0, 0, 1)};
  // Crest at 2 m, two sections: above 1 m only 0.1 m grains, below both sizes; one grain above the crest.
  const std::vector<Grain> pile{grain(0.1, 1.5, 1), grain(0.1, 0.5, 1), grain(1.0, 0.4, 1),
                                grain(0.1, 2.5, 1)};
  const SectionTable table = analyse_sections(pile, original, 2.0, 2);
  ASSERT_EQ(table.sections.size(), 2u);
  EXPECT_NEAR(table.d0_log, -0.75, 1e-12);
  EXPECT_NEAR(table.dcq_log, 0, 1e-12);
  EXPECT_DOUBLE_EQ(table.mass_outside, 1);
  EXPECT_EQ(table.sections[0].name, "S1");
  EXPECT_DOUBLE_EQ(table.sections[0].x_over_l, 0.25);  // (2 k - 1) / (2 n)
  EXPECT_DOUBLE_EQ(table.sections[1].x_over_l, 0.75);
  EXPECT_NEAR(table.sections[0].chi, (-1 + 0.75) / 0.75, 1e-12);
  EXPECT_NEAR(table.sections[1].chi, (-0.5 + 0.75) / 0.75, 1e-12);  // log d = (1 * -1 + 1 * 0) / 2
  EXPECT_DOUBLE_EQ(table.sections[1].mass, 2);
  EXPECT_EQ(table.sections[1].grains, 2);
}

TEST(Sections, OriginalMaterialHasChi0AndItsCoarsestQuartile1) {
  const auto original = load();
  const SectionTable same = analyse_sections(original, original, 2.0, 1);
  EXPECT_NEAR(same.sections[0].chi, 0, 1e-12);
  EXPECT_NEAR(same.sections[0].d50_rel, 1, 1e-12);
  EXPECT_NEAR(same.sections[0].d90_rel, 1, 1e-12);

  // Equal masses in four sizes: the coarsest size is the coarsest quartile.
  std::vector<Grain> four;
  for (const double d : {0.1, 0.2, 0.4, 0.8}) four.push_back(grain(d, 1, 1));
  EXPECT_NEAR(analyse_sections({four[3]}, four, 2.0, 1).sections[0].chi, 1, 1e-12);
}

TEST(Sections, MassMeanOfChiIs0WhenThePileIsAllThereIs) {
  // chi is linear in log d, and log d is a mean over mass.
  auto pile = load();
  for (std::size_t i = 0; i < pile.size(); ++i)
    pile[i].position.z() = 10.0 * std::fmod(0.618 * static_cast<double>(i), 1.0);
  const SectionTable table = analyse_sections(pile, pile, 10.0, 6);
  double sum = 0, mass = 0;
  for (const Section& section : table.sections) {
    sum += section.mass * section.chi;
    mass += section.mass;
  }
  EXPECT_NEAR(sum / mass, 0, 1e-9);
  EXPECT_NEAR(mass, 300e3, 0.005 * 300e3);
}

TEST(Sections, EmptySectionIsNaNAndLowGrainsCountBelow) {
  const auto original = load();
  const SectionTable table = analyse_sections({grain(1, 0, 5), grain(1, -0.2, 5)}, original, 10, 6);
  EXPECT_TRUE(std::isnan(table.sections[0].chi));
  EXPECT_TRUE(std::isnan(table.sections[0].d50));
  EXPECT_TRUE(std::isnan(table.sections[0].d50_rel));
  EXPECT_EQ(table.sections[0].grains, 0);
  EXPECT_EQ(table.sections[5].grains, 2);
  EXPECT_TRUE(
      std::any_of(table.sieves.begin(), table.sieves.end(), [](double s) { return std::abs(s - 1) < 1e-9; }));
  EXPECT_DOUBLE_EQ(table.original_passing.front(), 0);
  EXPECT_DOUBLE_EQ(table.original_passing.back(), 1);
}

TEST(Sections, RefusesNoOriginalNoHeightNoSections) {
  const auto original = load();
  EXPECT_THROW(analyse_sections({}, {}, 1, 6), std::invalid_argument);
  EXPECT_THROW(analyse_sections({}, original, 0, 6), std::invalid_argument);
  EXPECT_THROW(analyse_sections({}, original, 1, 0), std::invalid_argument);
}

TEST(Sections, ChiOfTheSimulatedLaboratoryCurvesIsAsPrinted) {
  // Curves of table C.5, printed to 1 %; D0 = 28.87 mm and D_CQ = 77.33 mm as derived (psd_constraints.csv,
  // Sim0). A grain of the geometric mean diameter of each class gives the sum over sieves. Printed: -0.07,
  // 0.16, 0.33 (line 1556).
  std::ifstream stream(std::filesystem::path(SCREE_SOURCE_DIR) /
                       "assets/reference/lab_segregation_pfc3d_psd.csv");
  ASSERT_TRUE(stream);
  std::map<std::pair<std::string, std::string>, std::vector<std::pair<double, double>>> curves;
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::istringstream fields(line);
    std::string section, repeat, diameter, passing;
    for (std::string* field : {&section, &repeat, &diameter, &passing}) std::getline(fields, *field, ',');
    curves[{section, repeat}].emplace_back(std::stod(diameter), std::stod(passing));
  }
  ASSERT_EQ(curves.size(), 15u);
  std::map<std::string, double> chi;
  for (const auto& [key, points] : curves) {
    std::vector<double> diameters, masses;
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (points[i].second <= points[i - 1].second) continue;
      diameters.push_back(std::sqrt(points[i].first * points[i - 1].first));
      masses.push_back(points[i].second - points[i - 1].second);
    }
    const double log_d = PassingCurve(diameters, masses).mean_log_diameter();
    chi[key.first] += (log_d - std::log10(28.87)) / (std::log10(77.33) - std::log10(28.87)) / 5;
  }
  EXPECT_NEAR(chi["top"], -0.07, 0.006);
  EXPECT_NEAR(chi["middle"], 0.16, 0.006);
  EXPECT_NEAR(chi["bottom"], 0.33, 0.006);
}

}  // namespace
}  // namespace scree
