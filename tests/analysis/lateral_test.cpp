// Segregation across a slope.
#include "analysis/pile/lateral.h"

#include <gtest/gtest.h>

#include <cmath>

namespace scree {
namespace {

Grain grain(double y, double z, double diameter, int dump) {
  Grain g;
  g.position = Vec3(0, y, z);
  g.diameter = diameter;
  g.mass = std::pow(diameter, 3);
  g.dump = dump;
  return g;
}

// Two strips of the lowest of two sections, fine at y = 0 and coarse at y = 4; the upper section has one
// strip.
std::vector<Grain> two_strips() {
  std::vector<Grain> pile;
  for (int i = 0; i < 40; ++i) {
    pile.push_back(grain(-1 + 0.05 * i, 1, 0.1, 1));
    pile.push_back(grain(3 + 0.05 * i, 1, 1.0, 2));
    pile.push_back(grain(-1 + 0.05 * i, 6, 0.1, 1));
  }
  pile.push_back(grain(20, 1, 1.0, 1));  // alone in its strip
  return pile;
}

TEST(Lateral, StripsOfASectionAreHeldApart) {
  const std::vector<Grain> pile = two_strips();
  const Lateral lateral = analyse_lateral(pile, pile, 10, 2, 2);
  ASSERT_EQ(lateral.sections.size(), 2u);
  const LateralSection& low = lateral.sections[1];
  ASSERT_EQ(low.y, (std::vector<double>{0, 4}));
  EXPECT_LT(low.chi[0], low.chi[1]);
  EXPECT_DOUBLE_EQ(low.chi_range, low.chi[1] - low.chi[0]);
  EXPECT_DOUBLE_EQ(low.chi_std, low.chi_range / std::sqrt(2.0));  // of two values, n - 1
  EXPECT_NEAR(low.mass[0], 40 * 1e-3, 1e-12);
  EXPECT_TRUE(std::isnan(lateral.sections[0].chi_std)) << "one strip has no deviation";
}

TEST(Lateral, ToeWidthIsOfTheFirstPointAlone) {
  // Dump 3 comes from the first of two points again. 100 equal grains at y = 0, 0.1 ... 9.9: the 3rd and the
  // 98th are the first to reach 2.5 % and 97.5 %.
  std::vector<Grain> pile;
  for (int i = 0; i < 100; ++i) pile.push_back(grain(0.1 * i, 1, 0.5, i % 2 == 0 ? 1 : 3));
  for (int i = 0; i < 100; ++i) pile.push_back(grain(50, 1, 0.5, 2));
  EXPECT_NEAR(analyse_lateral(pile, pile, 10, 6, 2).point1_toe_width, 9.7 - 0.2, 1e-9);
  for (Grain& g : pile) g.position.z() = 9;
  EXPECT_TRUE(std::isnan(analyse_lateral(pile, pile, 10, 6, 2).point1_toe_width));
}

TEST(Lateral, NonsenseIsRefused) {
  const std::vector<Grain> pile = two_strips();
  EXPECT_THROW(analyse_lateral(pile, pile, 10, 6, 0), std::invalid_argument);
  EXPECT_THROW(analyse_lateral(pile, pile, 10, 6, 1, 0), std::invalid_argument);
  EXPECT_THROW(analyse_lateral(pile, {}, 10, 6, 1), std::invalid_argument);
}

}  // namespace
}  // namespace scree
