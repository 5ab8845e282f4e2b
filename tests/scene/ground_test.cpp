// Bench, base layer and loads: what the experiments stand on.
#include "sim/scene/ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "sim/scene/load.h"

namespace scree {
namespace {

double volume(const TriangleMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles)
    six += mesh.vertices[t[0]].dot(mesh.vertices[t[1]].cross(mesh.vertices[t[2]]));
  return six / 6;
}

TEST(Bench, IsAClosedSolidOfTheRightVolume) {
  BenchSpec bench;
  bench.height = 15, bench.slope_deg = 40;
  const TriangleMesh mesh = make_bench(bench);
  EXPECT_TRUE(mesh.closed);
  const double toe = 15 / std::tan(40 * M_PI / 180);
  EXPECT_NEAR(toe_of(bench), toe, 1e-12);
  // Cross-section: 5 m of ground under everything, the top and half of the slope.
  const double section = 5 * (40 + toe + 80) + 15 * 40 + 0.5 * 15 * toe;
  EXPECT_NEAR(volume(mesh), section * bench.width, 1e-6 * section * bench.width);
}

TEST(Bench, BaseLayerLiesOnTheSurfaceWithoutHoles) {
  BenchSpec bench;
  bench.top_length = 6, bench.floor_length = 8, bench.width = 12;
  const double toe = toe_of(bench);
  const auto surface = [&](double x) { return x <= 0 ? bench.height : x >= toe ? 0.0 : bench.height - x; };
  const auto balls = make_base_layer(bench, 1);
  for (const NewSphere& ball : balls) {
    EXPECT_TRUE(ball.fixed);
    EXPECT_EQ(ball.diameter, 1.0);
    EXPECT_NEAR(ball.position.z(), surface(ball.position.x()), 1e-9);
  }
  // Seen along the surface's normal, no place away from the edges is further than a triangle's circumradius
  // from a ball.
  for (double x = -5; x <= toe + 7; x += 0.1)
    for (double y = -5; y <= 5; y += 0.1) {
      double nearest = 1e300;
      for (const NewSphere& ball : balls)
        nearest = std::min(nearest, (ball.position - Vec3(x, y, surface(x))).norm());
      EXPECT_LT(nearest, 1 / std::sqrt(3.0) + 0.05) << x << ' ' << y;
    }
}

TEST(Bench, PlaneTopHasNoBallAboveIt) {
  BenchSpec bench;
  for (const double slope : {37.0, 45.0})
    for (const BaseLayer layer : {BaseLayer::homogeneous, BaseLayer::mixed}) {
      bench.slope_deg = slope, bench.base_layer = layer, bench.layer_on_top = false;
      const auto plane = make_base_layer(bench, 1);
      EXPECT_EQ(standing_height(bench), bench.height);
      double highest = 0;
      for (const NewSphere& ball : plane) {
        EXPECT_GT(ball.position.x(), 0);
        highest = std::max(highest, ball.position.z() + 0.5 * ball.diameter);
      }
      EXPECT_LE(highest, bench.height);
      EXPECT_GT(highest, bench.height - 0.4) << "the slope is rough up to the crest";
      bench.layer_on_top = true;
      EXPECT_EQ(standing_height(bench), bench.height + 0.5);
      EXPECT_GT(make_base_layer(bench, 1).size(), plane.size());
    }
}

TEST(Bench, MixedLayerHasBothSizesAndDependsOnTheSeed) {
  BenchSpec bench;
  bench.width = 20, bench.base_layer = BaseLayer::mixed;
  const auto count = [](const std::vector<NewSphere>& balls, double d) {
    return std::count_if(balls.begin(), balls.end(), [d](const NewSphere& b) { return b.diameter == d; });
  };
  const auto first = make_base_layer(bench, 1), same = make_base_layer(bench, 1),
             other = make_base_layer(bench, 2);
  const auto small = count(first, 0.5), large = count(first, 1.0);
  EXPECT_EQ(small + large, static_cast<long>(first.size()));
  EXPECT_EQ(small % 4, 0);
  EXPECT_NEAR(static_cast<double>(small / 4) / static_cast<double>(small / 4 + large), 0.5, 0.03);
  ASSERT_EQ(first.size(), same.size());
  for (std::size_t k = 0; k < first.size(); ++k) ASSERT_EQ(first[k].position, same[k].position);
  EXPECT_TRUE(first.size() != other.size() || first[7].position != other[7].position ||
              count(other, 0.5) != small);
  bench.base_layer = BaseLayer::none;
  EXPECT_TRUE(make_base_layer(bench, 1).empty());
}

// A bench and its balls at a quarter of the size: the same layer at a quarter of the size (powers of two, so
// to the last bit but for the slope).
TEST(Bench, BaseLayerScalesWithItsBalls) {
  for (const BaseLayer layer : {BaseLayer::homogeneous, BaseLayer::mixed}) {
    BenchSpec bench;
    bench.base_layer = layer, bench.width = 20, bench.top_length = 8, bench.floor_length = 8;
    const auto whole = make_base_layer(bench, 1);
    for (double* length :
         {&bench.height, &bench.width, &bench.top_length, &bench.floor_length, &bench.ball_diameter})
      *length *= 0.25;
    const auto quarter = make_base_layer(bench, 1);
    ASSERT_EQ(quarter.size(), whole.size());
    for (std::size_t k = 0; k < whole.size(); ++k) {
      EXPECT_EQ(quarter[k].diameter, 0.25 * whole[k].diameter);
      EXPECT_LT((quarter[k].position - 0.25 * whole[k].position).norm(), 1e-12);
    }
    EXPECT_EQ(standing_height(bench), 2.5 + 0.125);
    EXPECT_NEAR(estimated_balls((2 + 2.5 * std::sqrt(2.0) + 2) * 5, layer, 0.25),
                static_cast<double>(quarter.size()), 0.12 * static_cast<double>(quarter.size()));
  }
  for (const NewSphere& ball : make_floor_layer(1, BaseLayer::homogeneous, 0.1, 1))
    EXPECT_EQ(ball.diameter, 0.1);
}

TEST(Load, FillsBoxAndCylinderWithoutOverlap) {
  std::vector<double> diameters{2.0, 1.5, 1.5, 1.0};
  for (int k = 0; k < 400; ++k) diameters.push_back(0.6 - 0.001 * k);
  for (const LoadRegion& region : {LoadRegion{{4, 4, 3}}, LoadRegion{{4, 0, 3}}}) {
    const Load load = fill_region(region, diameters, 1, 1);
    ASSERT_EQ(load.positions.size(), diameters.size());
    for (std::size_t i = 0; i < diameters.size(); ++i) {
      const Vec3& x = load.positions[i];
      const double r = 0.5 * diameters[i];
      if (region.length.y() > 0) {
        EXPECT_TRUE(x.x() <= -r && x.x() >= -4 + r && std::abs(x.y()) <= 2 - r);
      } else {
        EXPECT_LE(std::hypot(x.x(), x.y()), 2 - r + 1e-12);
      }
      EXPECT_TRUE(x.z() >= r && x.z() <= load.height - r + 1e-12);
      for (std::size_t j = 0; j < i; ++j)
        ASSERT_GE((x - load.positions[j]).norm(), 0.5 * (diameters[i] + diameters[j]));
    }
  }
}

TEST(Load, ClumpsFillBoxAndCylinderWithoutOverlapInAllDirections) {
  const Clumps clumps{0.8};
  std::vector<double> diameters{2.0, 1.5, 1.0};
  for (int k = 0; k < 400; ++k) diameters.push_back(0.6 - 0.001 * k);
  for (const LoadRegion& region : {LoadRegion{{4, 4, 3}}, LoadRegion{{4, 0, 3}}}) {
    const Load load = fill_region(region, diameters, 1, 1, clumps);
    ASSERT_EQ(load.axes.size(), diameters.size());
    double upright = 0;
    std::vector<std::pair<Vec3, double>> spheres;
    for (std::size_t i = 0; i < diameters.size(); ++i) {
      ASSERT_NEAR(load.axes[i].norm(), 1, 1e-12);
      upright += load.axes[i].z() * load.axes[i].z();
      const double r = 0.5 * clumps.size() * diameters[i];
      for (const double side : {-1.0, 1.0}) {
        const Vec3 x = load.positions[i] + side * clumps.elongation * r * load.axes[i];
        if (region.length.y() > 0) {
          EXPECT_TRUE(x.x() <= -r + 1e-12 && x.x() >= -4 + r - 1e-12 && std::abs(x.y()) <= 2 - r + 1e-12);
        } else {
          EXPECT_LE(std::hypot(x.x(), x.y()), 2 - r + 1e-12);
        }
        EXPECT_TRUE(x.z() >= r - 1e-12 && x.z() <= load.height - r + 1e-12);
        for (std::size_t j = 0; j < 2 * i; ++j)
          ASSERT_GE((x - spheres[j].first).norm(), r + spheres[j].second - 1e-12);
        spheres.emplace_back(x, r);
      }
    }
    EXPECT_NEAR(upright / static_cast<double>(diameters.size()), 1.0 / 3, 0.06);
  }
  EXPECT_THROW(fill_region({{2, 2, 1}}, {1.5}, 1, 1, clumps), std::invalid_argument);
}

TEST(Load, GrowsWhenFullAndRefusesWhatCannotFit) {
  const std::vector<double> many(300, 0.5);
  const Load load = fill_region({{2, 2, 1}}, many, 1, 1);
  EXPECT_GT(load.height, 1.0);  // 300 spheres of 0.065 m3 need far more than 4 m3
  EXPECT_THROW(fill_region({{2, 2, 1}}, {2.5}, 1, 1), std::invalid_argument);
}

TEST(Load, RegionThatHasGrownHoldsTheSameMixAtEveryHeight) {
  std::vector<double> diameters(60, 0.5);
  diameters.resize(6060, 0.12);  // coarse and fine rock, half of the volume each
  const Load load = fill_region({{2, 2, 2}}, diameters, 1, 1);
  ASSERT_GT(load.height, 2.0);
  double fine = 0, above = 0;
  for (std::size_t k = 60; k < diameters.size(); ++k) {
    fine += 1;
    above += load.positions[k].z() > 0.75 * load.height;
  }
  // Large spheres keep half a diameter from the top, so a little more than a quarter of the fines lies there.
  EXPECT_LT(above / fine, 0.32);
}

}  // namespace
}  // namespace scree
