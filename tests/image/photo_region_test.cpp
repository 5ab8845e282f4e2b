// What a region's border cuts, and what others count for it.
#include "analysis/image/photo_region.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "analysis/image/photo_analysis.h"

namespace scree {
namespace {

using Polygon = std::vector<cv::Point>;
const cv::Size kPicture(120, 90);

PhotoAnalysis analysed(const std::vector<cv::Point>& discs, int radius, const Polygon& region,
                       bool within_frame = false) {
  cv::Mat3b picture(kPicture, cv::Vec3b(50, 50, 50));
  for (const cv::Point& at : discs) cv::circle(picture, at, radius, cv::Scalar(200, 200, 200), cv::FILLED);
  PhotoAnalysisSettings settings;
  settings.m_per_px = 0.01;
  settings.sections = 1;
  settings.region = region;
  settings.rock_within_frame = within_frame;
  return analyse_photo(picture, settings);
}

TEST(PhotoRegion, GrainsThatReachOverItsBorderAreLeftOut) {
  // One in the middle, one that ends two pixels within, one over the border, one beyond it.
  const PhotoAnalysis found =
      analysed({{60, 45}, {41, 45}, {89, 45}, {108, 45}}, 9, {{30, 15}, {89, 15}, {89, 74}, {30, 74}});
  ASSERT_EQ(found.grains.size(), 2u);
  EXPECT_EQ(found.cut.size(), 1u);
  // 60 x 60 pixels; a grain of 19 is seen as one of 18, whole in 42 x 42 places.
  for (const ImageGrain& grain : found.grains) EXPECT_NEAR(grain.weight, 60.0 * 60 / (42 * 42), 0.05);
  // Two discs and a half of 19 pixels.
  EXPECT_NEAR(found.rock_share, 2.5 * std::numbers::pi / 4 * 19 * 19 / 3600, 0.03);
}

// A slim grain along a slim region: a disc of its length fits nowhere, and yet it counts for few.
TEST(PhotoRegion, SlimOnesHaveRoom) {
  const PhotoRegion strip(kPicture, {{10, 5}, {30, 5}, {110, 85}, {90, 85}});
  const double weight = strip.weight({{40, 40}, 50, 6}, false);
  EXPECT_GT(weight, 1);
  EXPECT_LT(weight, 6);
}

// Miles's identity: over all places of a grain, the weights where it is whole add up to the places within the
// region. It is counted as often as it is there, whatever its size.
class Counted : public testing::TestWithParam<Polygon> {};

TEST_P(Counted, AsOftenAsThere) {
  const PhotoRegion region(kPicture, GetParam());
  for (const bool within_frame : {false, true})
    for (const int radius : {6, 12}) {
      // Places of an even sequence (Roberts's R2, powers of the plastic number), as far as the frame allows.
      const int rim = within_frame ? radius + 1 : 0;
      const cv::Rect places =
          region.box() & cv::Rect(rim, rim, kPicture.width - 2 * rim, kPicture.height - 2 * rim);
      double there = 0, counted = 0;
      for (int k = 1; k <= 300; ++k) {
        const auto even = [&](double power) {
          return std::fmod(k / std::pow(1.32471795724474603, power), 1);
        };
        const cv::Point at(places.x + static_cast<int>(even(1) * places.width),
                           places.y + static_cast<int>(even(2) * places.height));
        there += region.has(at.x, at.y) ? 1 : 0;
        try {
          for (const ImageGrain& grain : analysed({at}, radius, GetParam(), within_frame).grains)
            counted += grain.weight;
        } catch (const std::runtime_error&) {
          // It is cut, and there is no other.
        }
      }
      // Half a pixel all around the 1500 places of the larger disc in the triangle, whose outline is 190
      // long, is 6 % of them; so are two of the thirty places of the sequence that are among them.
      EXPECT_NEAR(counted / there, 1, 0.12) << radius << (within_frame ? " within the frame" : "");
    }
}
INSTANTIATE_TEST_SUITE_P(PhotoRegion, Counted,
                         testing::Values(Polygon{},  // the whole picture
                                         Polygon{{15, 15}, {104, 15}, {104, 74}, {15, 74}},
                                         Polygon{{38, 4}, {116, 4}, {79, 86}, {4, 86}},
                                         Polygon{{60, 2}, {117, 87}, {2, 87}}));

}  // namespace
}  // namespace scree
