// Cells of sections through packings that are known.
#include "analysis/pile/inside.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "analysis/pile/segregation.h"
#include "analysis/pile/surface_height.h"

namespace scree {
namespace {

constexpr double kDensity = 2700;  // kg/m3

Grain grain(const Vec3& at, double diameter, int dump = 1) {
  Grain g;
  g.position = at;
  g.diameter = diameter;
  g.mass = kDensity * std::numbers::pi / 6 * std::pow(diameter, 3);
  g.dump = dump;
  return g;
}

/// Touching grains on a simple cubic lattice, in a block from (0, 0, 0) to (nx, ny, nz) times their diameter.
std::vector<Grain> cubic(int nx, int ny, int nz, double d, const Vec3& corner = Vec3::Zero(), int dump = 1) {
  std::vector<Grain> block;
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k) {
        block.push_back(grain(corner + d * Vec3(i + 0.5, j + 0.5, k + 0.5), d, dump));
        block.back().id = static_cast<std::int64_t>(block.size());
      }
  return block;
}

/// Two sizes, so that the material has a coarser quartile.
std::vector<Grain> two_sizes() {
  std::vector<Grain> original(64, grain(Vec3::Zero(), 0.25));
  original.push_back(grain(Vec3::Zero(), 1.0));
  return original;
}

const double kCubic = 1 - std::numbers::pi / 6;  // porosity of simple cubic packing

VerticalSection section(double y0, double half_width, double cell) {
  VerticalSection s;
  s.y0 = y0, s.half_width = half_width, s.cell = cell;
  return s;
}

TEST(Inside, SimpleCubicPacking) {
  const std::vector<Grain> block = cubic(16, 16, 16, 0.25);  // 4 m wide
  const Inside inside = analyse_inside(block, {}, block, section(2, 1, 1));
  ASSERT_EQ(inside.nx, 4);
  ASSERT_EQ(inside.nz, 4);
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k) {
      const InsideCell& cell = inside.at(i, k);
      EXPECT_EQ(cell.place, CellPlace::interior) << i << " " << k;
      EXPECT_EQ(cell.grains, 4 * 8 * 4);
      EXPECT_NEAR(cell.porosity, kCubic, 1e-9);
      EXPECT_NEAR(cell.mass, kDensity * 2 * std::numbers::pi / 6, 1e-5);
      EXPECT_NEAR(cell.d50, 0.25, 1e-12);
      EXPECT_NEAR(cell.cu, 1, 1e-12);
      EXPECT_TRUE(std::isnan(cell.chi)) << "one size has no coarsest quartile";
      EXPECT_NEAR(cell.ksat_kozeny_carman, 1, 1e-6);
    }
  EXPECT_EQ(inside.at(0, 3).place, CellPlace::surface) << "its top lies at the tops of the highest grains";
  EXPECT_TRUE(std::isnan(inside.at(0, 3).porosity));
  EXPECT_NEAR(inside.mean_porosity, kCubic, 1e-9);
  EXPECT_NEAR(inside.original_void_ratio, kCubic / (1 - kCubic), 1e-8);
}

TEST(Inside, CellWallsThroughGrainsLoseNothing) {
  const std::vector<Grain> block = cubic(10, 10, 10, 0.4);
  const VerticalSection cut = section(2.03, 1.13, 0.7);
  const Inside inside = analyse_inside(block, {}, block, cut);
  double mass = 0, solid = 0, expected = 0;
  for (const InsideCell& cell : inside.cells) {
    mass += cell.mass, solid += cell.solid_volume;
    if (cell.place != CellPlace::interior) continue;
    EXPECT_NEAR(cell.porosity, kCubic, 0.12);
  }
  for (const Grain& g : block) {  // what lies between two planes: whole less two caps
    const double r = 0.2, y = std::abs(g.position.y() - cut.y0);
    const double h = std::clamp(cut.half_width - y + r, 0.0, 2 * r);
    expected += std::numbers::pi * h * h * (3 * r - h) / 3;
  }
  EXPECT_NEAR(solid, expected, 1e-8 * expected);
  EXPECT_NEAR(mass, kDensity * expected, 1e-8 * kDensity * expected);
}

TEST(Inside, TwoKnownLayers) {
  // Coarse blocks of the second dump below fines of the first.
  std::vector<Grain> pile = cubic(4, 4, 2, 1.0, Vec3::Zero(), 2);
  const std::vector<Grain> fines = cubic(16, 16, 12, 0.25, Vec3(0, 0, 2), 1);
  pile.insert(pile.end(), fines.begin(), fines.end());
  const std::vector<Grain> original = two_sizes();
  InsideOptions options;
  options.fewest_grains = 4;
  options.original_void_ratio = kCubic / (1 - kCubic);
  const Inside inside = analyse_inside(pile, {}, original, section(2, 2, 2), options);
  ASSERT_EQ(inside.nz, 3);
  const InsideCell &coarse = inside.at(0, 0), &fine = inside.at(0, 1);
  // Original: half of the mass is of 0.25 m and half of 1 m; its coarsest quartile is 1 m.
  const double mean = 0.5 * std::log10(0.25);
  EXPECT_NEAR(coarse.chi, 1, 1e-9);
  EXPECT_NEAR(fine.chi, (std::log10(0.25) - mean) / (0 - mean), 1e-9);
  EXPECT_EQ(coarse.dump, 2);
  EXPECT_EQ(fine.dump, 1);
  EXPECT_NEAR(coarse.porosity, kCubic, 1e-9);
  EXPECT_NEAR(fine.porosity, kCubic, 1e-9);
  // The original's D10 is 0.25, D50 is 0.25, D60 lies between: 4^(1/5) of it on the logarithmic curve.
  EXPECT_NEAR(coarse.ksat_taylor, 8, 1e-6);  // 4^1.5
  EXPECT_NEAR(fine.ksat_taylor, 1, 1e-6);
  EXPECT_NEAR(coarse.ksat_kozeny_carman / fine.ksat_kozeny_carman, 16, 1e-6);
  EXPECT_NEAR(fine.ksat_kozeny_carman, std::pow(4.0, -0.2 / 3), 1e-6);
  EXPECT_NEAR(fine.ksat_grading, fine.ksat_kozeny_carman, 1e-9) << "the voids are the original's";
  EXPECT_NEAR(inside.at(0, 2).ksat_grading, fine.ksat_grading, 1e-9) << "at the surface too";
  EXPECT_NEAR(inside.ksat_contrast, 16, 1e-6);
  EXPECT_NEAR(inside.ksat_grading_contrast, 16, 1e-6);
  EXPECT_NEAR(inside.mean_abs_chi, 1, 1e-9);
}

TEST(Inside, GroundAndFixedBallsAreNoPores) {
  const std::vector<Grain> block = cubic(32, 8, 24, 0.25);  // x to 8 m, z to 6 m
  VerticalSection cut = section(1, 1, 1);
  cut.bench = BenchOutline{4, 45};
  const Inside inside = analyse_inside(block, {}, block, cut);
  EXPECT_EQ(inside.at(0, 2).place, CellPlace::ground);  // x 0 to 1, ground falls from 4 to 3
  EXPECT_EQ(inside.at(0, 3).place, CellPlace::ground);  // half of it below the slope
  EXPECT_EQ(inside.at(0, 4).place, CellPlace::interior);
  EXPECT_EQ(inside.at(4, 0).place, CellPlace::interior);  // before the toe
  EXPECT_TRUE(std::isnan(inside.at(0, 3).porosity));

  const Inside with_balls = analyse_inside(block, {grain(Vec3(6.5, 1, 0), 1.0)}, block, cut);
  EXPECT_EQ(with_balls.at(6, 0).place, CellPlace::ground);
  EXPECT_EQ(with_balls.at(5, 0).place, CellPlace::interior);
  EXPECT_NEAR(with_balls.at(6, 0).mass, inside.at(6, 0).mass, 1e-9) << "fixed balls are no rock";
}

TEST(Inside, FewGrainsHaveNoGrading) {
  const std::vector<Grain> block = cubic(4, 4, 4, 0.5);
  InsideOptions options;
  options.fewest_grains = 17;  // a cell of 1 m across 2 m holds 16
  const Inside inside = analyse_inside(block, {}, two_sizes(), section(1, 1, 1), options);
  for (const InsideCell& cell : inside.cells) {
    EXPECT_TRUE(std::isnan(cell.chi) && std::isnan(cell.d10) && std::isnan(cell.d50) && std::isnan(cell.cu));
    EXPECT_TRUE(std::isnan(cell.dump) && std::isnan(cell.ksat_grading) &&
                std::isnan(cell.ksat_kozeny_carman) && std::isnan(cell.ksat_taylor));
  }
  EXPECT_TRUE(std::isnan(inside.mean_abs_chi) && std::isnan(inside.ksat_contrast));
  EXPECT_NEAR(inside.mean_porosity, kCubic, 1e-9) << "but it has voids";
}

TEST(Inside, ACornerOfAGrainIsNoGrading) {
  std::vector<Grain> block = cubic(4, 4, 4, 0.5);
  for (const double y : {0.3, 0.6, 0.9, 1.2, 1.5, 1.8}) block.push_back(grain(Vec3(1.5, y, 2.0), 0.2));
  const Inside inside = analyse_inside(block, {}, two_sizes(), section(1, 1, 1));
  const InsideCell& cell = inside.at(1, 2);  // six half grains in 2 m3
  EXPECT_EQ(cell.grains, 6);
  EXPECT_NEAR(cell.solid_volume, 6 * std::numbers::pi / 12 * 0.008, 1e-9);
  EXPECT_TRUE(std::isnan(cell.chi));
}

TEST(Inside, NothingInTheBandIsNoNumber) {
  const std::vector<Grain> block = cubic(4, 4, 4, 0.5);
  const Inside inside = analyse_inside(block, {}, block, section(50, 1, 1));
  EXPECT_TRUE(inside.cells.empty());
  EXPECT_TRUE(std::isnan(inside.mean_porosity) && std::isnan(inside.mean_abs_chi) &&
              std::isnan(inside.ksat_contrast));
  EXPECT_THROW(inside.at(0, 0), std::out_of_range);
}

TEST(Inside, RefusesBadArguments) {
  const std::vector<Grain> block = cubic(2, 2, 2, 0.5);
  EXPECT_THROW(analyse_inside(block, {}, {}, section(0, 1, 1)), std::invalid_argument);
  EXPECT_THROW(analyse_inside(block, {}, block, section(0, 0, 1)), std::invalid_argument);
  EXPECT_THROW(analyse_inside(block, {}, block, section(0, 1, -1)), std::invalid_argument);
  EXPECT_THROW(analyse_inside(block, {}, block, section(std::nan(""), 1, 1)), std::invalid_argument);
  VerticalSection cut = section(0, 1, 1);
  cut.bench = BenchOutline{10, 90};
  EXPECT_THROW(analyse_inside(block, {}, block, cut), std::invalid_argument);
  InsideOptions options;
  options.fewest_grains = 0;
  EXPECT_THROW(analyse_inside(block, {}, block, section(0, 1, 1), options), std::invalid_argument);
  options = {};
  options.original_void_ratio = 0.0;
  EXPECT_THROW(analyse_inside(block, {}, block, section(0, 1, 1), options), std::invalid_argument);
}

TEST(BenchOutline, GroundFollowsTopSlopeAndFloor) {
  const BenchOutline bench{10, 45};
  EXPECT_NEAR(bench.toe(), 10, 1e-12);
  EXPECT_EQ(bench.ground(-3), 10);
  EXPECT_NEAR(bench.ground(4), 6, 1e-12);
  EXPECT_EQ(bench.ground(30), 0);
}

TEST(SurfaceHeight, OfOneGrain) {
  const std::vector<Grain> one{grain(Vec3(0.5, 0.5, 2), 1)};
  const SurfaceHeight surface(one, 0, 1, 0.01);
  // Seen from above, the disc within which a sphere of radius 1/2 stands higher than h over its centre.
  EXPECT_NEAR(surface.share_above(0, 1, 2.3), std::numbers::pi * (0.25 - 0.09), 0.01);
  EXPECT_EQ(surface.share_above(0, 1, 2.0), 1) << "the corners of its square belong to it";
  EXPECT_EQ(surface.share_above(0, 1, 2.51), 0);
  EXPECT_EQ(surface.share_above(7, 8, 0), 0);
  EXPECT_THROW(SurfaceHeight(one, 0, 1, 0), std::invalid_argument);
  EXPECT_THROW(SurfaceHeight(one, 1, 1, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace scree
