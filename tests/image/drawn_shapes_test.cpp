// Shapes drawn with known axes, measured.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/image/grain_shape.h"
#include "analysis/image/grain_size.h"

namespace scree {
namespace {

using std::numbers::pi;

// Pixels whose middle lies within an ellipse with the axes a and b, turned by `angle` degrees.
cv::Mat1b drawn_ellipse(double a, double b, double angle) {
  const int side = static_cast<int>(a) + 8;
  const double c = std::cos(angle * pi / 180), s = std::sin(angle * pi / 180), middle = side / 2.0 + 0.3;
  cv::Mat1b mask(side, side, static_cast<uchar>(0));
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double dx = x - middle, dy = middle - y;
      const double u = dx * c + dy * s, v = dy * c - dx * s;
      if (std::pow(2 * u / a, 2) + std::pow(2 * v / b, 2) <= 1) mask(y, x) = 255;
    }
  return mask;
}

TEST(DrawnShapes, EllipsesGiveTheirAxesAnglesAndFerets) {
  for (const double a : {24.0, 60.0, 151.0})
    for (const double ratio : {1.0, 0.8, 0.5})
      for (const double angle : {0.0, 30.0, 77.0, 135.0}) {
        SCOPED_TRACE(testing::Message() << "a " << a << " b/a " << ratio << " angle " << angle);
        const double b = ratio * a;
        const GrainShape shape = shape_of(drawn_ellipse(a, b, angle));
        EXPECT_NEAR(shape.major, a, 0.02 * a);
        EXPECT_NEAR(shape.minor, b, 0.02 * b);
        // The Feret diameters of an ellipse are its axes; half a pixel is what a grid knows at either end.
        EXPECT_NEAR(shape.feret_max, a, std::max(0.02 * a, 1.0));
        EXPECT_NEAR(shape.feret_min, b, std::max(0.02 * b, 1.0));
        if (ratio < 1) {
          // Half a pixel at the end of the long axis; the rounder, the less an outline knows of its
          // direction.
          const double off = std::remainder(shape.angle_deg - angle, 180.0);
          EXPECT_NEAR(off, 0, 180 / pi * (0.5 / a) / (1 - ratio));
        }
        EXPECT_NEAR(shape.elongation(), ratio, 0.02);
        // 4 (pi/4 a b) / (pi a^2) = b / a; the largest Feret diameter is up to a pixel longer than a.
        EXPECT_NEAR(shape.roundness(), ratio, ratio * 2 / a + 0.01);
        // Ramanujan's perimeter of an ellipse.
        const double h = std::pow((1 - ratio) / (1 + ratio), 2);
        const double perimeter = pi * (a + b) / 2 * (1 + 3 * h / (10 + std::sqrt(4 - 3 * h)));
        EXPECT_NEAR(shape.perimeter, perimeter, 0.03 * perimeter);
      }
}

TEST(DrawnShapes, DiscsAreRoundAndSquaresAreNot) {
  const GrainShape disc = shape_of(drawn_ellipse(80, 80, 0));
  EXPECT_NEAR(disc.circularity(), 1, 0.03);
  EXPECT_NEAR(disc.equal_area_diameter(), 80, 0.8);
  const GrainShape square = shape_of(cv::Mat1b(60, 60, static_cast<uchar>(255)));
  EXPECT_NEAR(square.feret_max, 60 * std::sqrt(2.0), 0.02 * 60 * std::sqrt(2.0));
  EXPECT_NEAR(square.feret_min, 60, 0.5);
  EXPECT_NEAR(square.roundness(), 4 * 3600 / (pi * 7200), 0.02);
  // Crofton's formula with four directions: pi times the mean width of a square, (2 + 2 sqrt 2) / 4 sides.
  const double seen = pi * (2 + 2 * std::sqrt(2.0)) / 4;
  EXPECT_NEAR(square.circularity(), 4 * pi / (seen * seen), 0.02);
}

TEST(DrawnShapes, OnePixelHasASize) {
  const GrainShape pixel = shape_of(cv::Mat1b(1, 1, static_cast<uchar>(255)));
  EXPECT_EQ(pixel.area, 1);
  EXPECT_EQ(pixel.feret_max, 1);
  EXPECT_NEAR(pixel.major, pixel.minor, 1e-12);
}

TEST(GrainSize, ModelsMakeBodiesOfOutlines) {
  GrainShape shape;
  shape.area = pi / 4 * 50 * 30;
  shape.major = 50;
  shape.minor = 30;
  shape.feret_max = 52;
  shape.feret_min = 31;
  const double m = 0.01, density = 2700, lambda = 0.53;
  const GrainSize sphere = size_of(shape, m, SizeModel::sphere, lambda, density);
  EXPECT_NEAR(sphere.diameter, std::sqrt(0.5 * 0.3), 1e-12);
  EXPECT_NEAR(sphere.mass, density * pi / 6 * std::pow(0.5 * 0.3, 1.5), 1e-9);
  const GrainSize ellipsoid = size_of(shape, m, SizeModel::ellipsoid, lambda, density);
  EXPECT_NEAR(ellipsoid.diameter, 0.3, 1e-12);
  EXPECT_NEAR(ellipsoid.mass, density * pi / 6 * 0.5 * 0.3 * (0.53 * 0.3), 1e-9);
  const GrainSize feret = size_of(shape, m, SizeModel::feret, lambda, density);
  EXPECT_NEAR(feret.diameter, 0.31, 1e-12);
  EXPECT_NEAR(feret.mass, density * pi / 6 * 0.52 * 0.31 * (0.53 * 0.31), 1e-9);
}

TEST(ShapeFactor, MakesTheMassFromImagesTheOneWeighed) {
  const std::vector<WeighedFraction> fractions{{"coarse", 53, 100}, {"fine", 12, 20}};
  const ShapeFactor factor = calibrate_shape_factor(fractions);
  EXPECT_NEAR(factor.value * (100 + 20), 53 + 12, 1e-12);
  EXPECT_NEAR(factor.by_fraction[0], 0.53, 1e-12);
  EXPECT_NEAR(factor.by_fraction[1], 0.60, 1e-12);
  EXPECT_THROW(calibrate_shape_factor({}), std::invalid_argument);
  EXPECT_THROW(calibrate_shape_factor(std::vector<WeighedFraction>{{"empty", 5, 0}}), std::invalid_argument);
}

}  // namespace
}  // namespace scree
