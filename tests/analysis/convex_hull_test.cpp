#include "analysis/statistics/convex_hull.h"

#include <gtest/gtest.h>

#include <random>

namespace scree {
namespace {

// All 0/1 corners of a cube.
Eigen::MatrixXd corners(int dimensions) {
  Eigen::MatrixXd points(1 << dimensions, dimensions);
  for (int k = 0; k < points.rows(); ++k)
    for (int d = 0; d < dimensions; ++d) points(k, d) = k >> d & 1;
  return points;
}

TEST(ConvexHull, OfACubesCornersIsTheCube) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(-0.5, 1.5);
  for (int dimensions = 1; dimensions <= 3; ++dimensions)
    for (int k = 0; k < 300; ++k) {
      Eigen::VectorXd at(dimensions);
      for (double& x : at) x = anywhere(random);
      const Eigen::VectorXd nearest = at.cwiseMax(0).cwiseMin(1);
      EXPECT_LT((nearest_in_hull(corners(dimensions), at) - nearest).norm(), 1e-6) << at.transpose();
    }
}

TEST(ConvexHull, OfPointsOnALineIsThatLine) {
  Eigen::MatrixXd points(10, 2);  // each twice, as with two seeds
  for (int k = 0; k < 10; ++k) points.row(k).setConstant(k / 2 / 4.0);
  EXPECT_LT((nearest_in_hull(points, Eigen::Vector2d(0, 1)) - Eigen::Vector2d(0.5, 0.5)).norm(), 1e-6);
  EXPECT_LT((nearest_in_hull(points, Eigen::Vector2d(0.3, 0.3)) - Eigen::Vector2d(0.3, 0.3)).norm(), 1e-6);
  EXPECT_LT((nearest_in_hull(points, Eigen::Vector2d(2, 2)) - Eigen::Vector2d(1, 1)).norm(), 1e-6);
}

// The nearest point x of a hull is the one with (p - x) . (at - x) <= 0 for all of its points p.
TEST(ConvexHull, NearestPointToScatteredPoints) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(0, 1);
  int outside = 0;
  for (int round = 0; round < 200; ++round) {
    Eigen::MatrixXd points(4 + round, 3);
    for (double& x : points.reshaped()) x = anywhere(random);
    const Eigen::Vector3d at(anywhere(random), anywhere(random), anywhere(random));
    const Eigen::VectorXd x = nearest_in_hull(points, at);
    outside += (at - x).norm() > 1e-6;
    EXPECT_LT(((points.rowwise() - x.transpose()) * (at - x)).maxCoeff(), 1e-9);
  }
  EXPECT_GT(outside, 20);
}

}  // namespace
}  // namespace scree
