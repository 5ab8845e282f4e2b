#include "analysis/pile/heaviest_cut.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

Grain grain(double y, double mass) {
  Grain one;
  one.position = Vec3(0, y, 0);
  one.mass = mass;
  return one;
}

TEST(HeaviestCut, ShowsWhatItWasWeighedBy) {
  // Of depth 1.5: from -0.3 it shows 110 kg, from 0 only 10; a band of 1.5 to both sides of 0 holds 110 too.
  const std::vector<Grain> pile{grain(-0.3, 100), grain(0, 10), grain(3, 20)};
  const double cut = heaviest_cut(pile, 1.5);
  EXPECT_EQ(cut, -0.3);
  EXPECT_TRUE(in_cut(pile[0], cut, 1.5) && in_cut(pile[1], cut, 1.5));
  EXPECT_FALSE(in_cut(pile[2], cut, 1.5));
}

TEST(HeaviestCut, StraysDoNotHideThePile) {
  std::vector<Grain> pile{grain(-1000, 1), grain(1000, 1)};
  for (int k = 0; k < 10; ++k) pile.push_back(grain(7.31 + 0.01 * k, 5));
  EXPECT_EQ(heaviest_cut(pile, 0.1), 7.31);
}

TEST(HeaviestCut, LiesInTheMiddleOfAnEvenPile) {
  std::vector<Grain> pile;
  for (int k = -40; k <= 40; ++k) pile.push_back(grain(0.25 * k, 2));
  EXPECT_EQ(heaviest_cut(pile, 2), 0);
}

TEST(HeaviestCut, OfOneGrainIsAtIt) {
  EXPECT_EQ(heaviest_cut({grain(-4, 1)}, 0.5), -4);
}

}  // namespace
}  // namespace scree
