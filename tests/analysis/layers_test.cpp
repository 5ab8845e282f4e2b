// Layers that are laid by hand on a slope of 45 degrees.
#include "analysis/pile/layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "analysis/pile/toe_share.h"

namespace scree {
namespace {

const double kRoot = std::sqrt(0.5);

VerticalSection section() {
  VerticalSection s;
  s.half_width = 2, s.cell = 1;
  s.bench = BenchOutline{10, 45};
  return s;
}

Grain grain(double along, double y, double off, double diameter, int dump) {
  Grain g;
  g.position = Vec3((along + off) * kRoot, y, 10 + (off - along) * kRoot);
  g.diameter = diameter;
  g.mass = 2700 * std::numbers::pi / 6 * std::pow(diameter, 3);
  g.dump = dump;
  return g;
}

/// A carpet on the slope, two rows of grains thick, on a lattice of `pitch`; sizes of its lower and upper
/// row.
void lay(std::vector<Grain>& pile, double off, double pitch, double lower, double upper, int dump) {
  for (double along = pitch / 2; along < 10 / kRoot; along += pitch)
    for (double y = -3 + pitch / 2; y < 3; y += pitch) {
      pile.push_back(grain(along, y, off + pitch / 2, lower, dump));
      pile.push_back(grain(along, y, off + 1.5 * pitch, upper, dump));
    }
}

TEST(Layers, ThicknessIsThatOfTheCarpet) {
  std::vector<Grain> pile;
  lay(pile, 0, 0.25, 0.25, 0.25, 1);
  lay(pile, 0.5, 0.25, 0.25, 0.25, 3);
  const double cubic = 1 - std::numbers::pi / 6;
  const Layers layers = analyse_layers(pile, pile, section(), cubic);
  EXPECT_NEAR(layers.slope_deg, 45, 0.5);
  ASSERT_EQ(layers.layers.size(), 2u);
  EXPECT_EQ(layers.layers[0].dump, 1);
  EXPECT_EQ(layers.layers[1].dump, 3);
  for (const Layer& layer : layers.layers) EXPECT_NEAR(layer.thickness, 0.5, 0.03);
  EXPECT_TRUE(std::isnan(layers.variance_between)) << "one size has no scatter";
}

TEST(Layers, CoarseBelowOrAbove) {
  std::vector<Grain> pile;
  lay(pile, 0, 0.25, 0.24, 0.12, 1);
  lay(pile, 0.5, 0.25, 0.12, 0.24, 2);
  const Layers layers = analyse_layers(pile, pile, section(), 0.4);
  ASSERT_EQ(layers.layers.size(), 2u);
  // 8/9 of the mass is coarse, so log10 d of the material lies log10(2)/9 below its coarsest quartile. One
  // half of a layer is coarse throughout (chi = 1), of the other 2/9 is fine (chi = 1 - 2).
  EXPECT_NEAR(layers.layers[0].chi, 0, 0.02);
  EXPECT_NEAR(layers.layers[0].chi_lower, 1, 0.02);
  EXPECT_NEAR(layers.layers[0].chi_upper, -1, 0.03);
  EXPECT_NEAR(layers.layers[0].coarsening_down, 2, 0.05);
  EXPECT_NEAR(layers.layers[1].coarsening_down, -2, 0.05);
  EXPECT_NEAR(layers.mean_coarsening_down, 0, 0.02);
  EXPECT_LT(layers.variance_between, 0.01) << "both dumps have the same sizes";
}

TEST(Layers, OneBlockAsThickAsTheLayerIsNoGrading) {
  std::vector<Grain> pile;
  for (double along = 0.5; along < 10 / kRoot;
       along += 1) {  // a block with fines at its middle on both sides
    pile.push_back(grain(along, 0, 0.5, 0.9, 1));
    for (const double y : {-0.6, -0.7, 0.6, 0.7}) pile.push_back(grain(along, y, 0.5, 0.1, 1));
  }
  const Layers layers = analyse_layers(pile, pile, section(), 0.4);
  ASSERT_EQ(layers.layers.size(), 1u);
  EXPECT_NEAR(layers.layers[0].coarsening_down, 0, 1e-6);
}

TEST(Layers, SizesThatDifferFromDumpToDump) {
  std::vector<Grain> pile;
  lay(pile, 0, 0.25, 0.12, 0.12, 1);
  lay(pile, 0.5, 0.25, 0.24, 0.24, 2);
  const Layers layers = analyse_layers(pile, pile, section(), 0.4);
  EXPECT_NEAR(layers.variance_between, 1, 1e-9);
  EXPECT_LT(layers.variance_by_chance, 0.02);
}

TEST(Layers, CoarseningDownTheSlopeIsNoLayering) {
  std::vector<Grain> pile;
  lay(pile, 0, 0.25, 0.1, 0.1, 1);
  lay(pile, 0.5, 0.25, 0.1, 0.1, 2);
  for (Grain& g : pile) {
    g.diameter = 0.05 + 0.015 * (g.position.x() + 10 - g.position.z()) * kRoot;  // of the place along it
    g.mass = 2700 * std::numbers::pi / 6 * std::pow(g.diameter, 3);
  }
  EXPECT_LT(analyse_layers(pile, pile, section(), 0.4).variance_between, 1e-6);
}

TEST(Layers, DumpsDealtByChance) {
  double between = 0, by_chance = 0;
  for (unsigned round = 0; round < 40; ++round) {
    std::mt19937 random(round);
    std::vector<Grain> pile;
    lay(pile, 0, 0.4, 0.2, 0.2, 1);
    for (Grain& g : pile) {
      g.dump = 1 + static_cast<int>(random() % 3);
      g.diameter = 0.1 + 0.3 * static_cast<double>(random() % 1000) / 1000;
      g.mass = 2700 * std::numbers::pi / 6 * std::pow(g.diameter, 3);
    }
    const Layers layers = analyse_layers(pile, pile, section(), 0.4);
    between += layers.variance_between, by_chance += layers.variance_by_chance;
  }
  EXPECT_NEAR(between / by_chance, 1, 0.15);
}

TEST(Layers, WithoutEnoughGrainsThereIsNoNumber) {
  const std::vector<Grain> few{grain(7, 0, 0.2, 0.2, 1), grain(7, 0.5, 0.2, 0.4, 1)};
  const Layers layers = analyse_layers(few, few, section(), 0.4);
  ASSERT_EQ(layers.layers.size(), 1u);
  EXPECT_EQ(layers.layers[0].grains, 2);
  EXPECT_TRUE(std::isnan(layers.layers[0].thickness) && std::isnan(layers.layers[0].chi));
  EXPECT_TRUE(std::isnan(layers.mean_coarsening_down));
  EXPECT_TRUE(analyse_layers({}, few, section(), 0.4).layers.empty());
}

TEST(Layers, RefusesBadArguments) {
  const std::vector<Grain> one{grain(7, 0, 0.2, 0.2, 1)};
  VerticalSection no_bench = section();
  no_bench.bench.reset();
  EXPECT_THROW(analyse_layers(one, one, no_bench, 0.4), std::invalid_argument);
  EXPECT_THROW(analyse_layers(one, one, section(), 1.0), std::invalid_argument);
  EXPECT_THROW(analyse_layers(one, one, section(), std::nan("")), std::invalid_argument);
  EXPECT_THROW(analyse_layers(one, one, section(), 0.4, 1), std::invalid_argument);
  EXPECT_THROW(analyse_layers(one, {}, section(), 0.4), std::invalid_argument);
}

TEST(ToeShare, OfTheCoarsestBlocks) {
  // 1000 kg a size; the blocks of 1 m are the coarsest tenth.
  std::vector<Grain> pile;
  for (int k = 0; k < 10; ++k) {
    Grain g;
    g.diameter = 0.1 * (k + 1);
    g.mass = 250;
    for (int part = 0; part < 4; ++part) {
      g.position.z() = k == 9 ? (part < 3 ? 1.6 : 10.5) : 5;
      pile.push_back(g);
    }
  }
  EXPECT_NEAR(share_reaching_toe(pile, 10, pile), 0.75, 1e-12);        // sixth of 10 m: 1.67 m
  EXPECT_NEAR(share_reaching_toe(pile, 10, pile, 0.8), 0.375, 1e-12);  // 0.9 m and 1 m
  EXPECT_NEAR(share_reaching_toe(pile, 9, pile), 0, 1e-12);            // 1.5 m
  EXPECT_NEAR(share_reaching_toe_above(pile, 10, 0.45), 0.125, 1e-12);
  EXPECT_TRUE(std::isnan(share_reaching_toe_above(pile, 10, 2)));
  EXPECT_TRUE(std::isnan(share_reaching_toe({}, 10, pile)));
  EXPECT_THROW(share_reaching_toe(pile, 0, pile), std::invalid_argument);
  EXPECT_THROW(share_reaching_toe(pile, 10, {}), std::invalid_argument);
  EXPECT_THROW(share_reaching_toe(pile, 10, pile, 1.1), std::invalid_argument);
}

}  // namespace
}  // namespace scree
