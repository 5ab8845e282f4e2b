// The angle of a slope, of piles whose surface is known.
#include "analysis/pile/slope_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/material/random.h"

namespace scree {
namespace {

constexpr double kHeight = 10, kRadians = std::numbers::pi / 180;

Grain grain(double x, double y, double z, double diameter) {
  Grain g;
  g.position = {x, y, z};
  g.diameter = diameter;
  g.mass = diameter * diameter * diameter;
  return g;
}

// Grains of 0.2 to 0.6 m in three layers below a plane that falls at `angle` from the crest, about y0; the
// top of the bench behind it.
std::vector<Grain> slope(double angle, double y0, std::uint64_t seed, double height = kHeight) {
  Random random(seed, 0, RandomPurpose::positions);
  std::vector<Grain> pile;
  const double foot = height / std::tan(angle * kRadians);
  for (int k = 0; k < 60'000; ++k) {
    const double x = -6 + (foot + 6) * random.uniform(), d = 0.2 + 0.4 * random.uniform();
    const double surface = x < 0 ? height : height - x * std::tan(angle * kRadians);
    pile.push_back(grain(x, y0 + 8 * random.uniform() - 4, surface - d / 2 - random.uniform(), d));
  }
  return pile;
}

std::optional<SlopeLine> line_of(const std::vector<Grain>& pile) {
  return slope_line(slope_profile(pile, kHeight), kHeight);
}

// tan(angle) = height / length of the plane under which the grains lie.
TEST(SlopeProfile, AngleIsThatOfThePlane) {
  for (const double angle : {25.0, 37.0, 45.0})
    for (const double y0 : {0.0, 8.0}) {
      const auto line = line_of(slope(angle, y0, 3));
      ASSERT_TRUE(line) << angle << " " << y0;
      EXPECT_NEAR(line->angle, angle, 0.5) << y0;
      EXPECT_NEAR(line->z, kHeight - line->x * std::tan(angle * kRadians), 0.3)
          << "the line lies on the plane";
    }
}

// Between a face at 45 degrees and a surface at 37 degrees through the same crest rock is
// x (tan 45 - tan 37) cos 45 thick, normal to the face; on the face and between the heights of a fit x goes
// from 0.15 H / tan 37 to H / tan 45.
TEST(SlopeProfile, CoverIsTheThicknessOnTheFace) {
  const double from = 0.15 * kHeight / std::tan(37 * kRadians), to = kHeight;
  const double thick =
      0.5 * (from + to) * (std::tan(45 * kRadians) - std::tan(37 * kRadians)) * std::cos(45 * kRadians);
  EXPECT_NEAR(cover_on_face(slope_profile(slope(37, 0, 3), kHeight), {kHeight, 45}), thick, 0.15);
  EXPECT_TRUE(std::isnan(cover_on_face({}, {kHeight, 45})));
}

TEST(SlopeProfile, BlocksOnTheFloorAndHolesAtTheirFootDoNotTiltIt) {
  std::vector<Grain> pile = slope(37, 0, 5);
  const double before = line_of(pile)->angle;
  for (const double x : {17.0, 19.5, 23.0}) pile.push_back(grain(x, 0, 0.9, 1.8));
  EXPECT_NEAR(line_of(pile)->angle, before, 0.3);
  // A heap beyond a gap covers the whole band, and is no part of the slope either.
  for (double x = 18; x < 22; x += 0.4)
    for (double y = -4; y < 4; y += 0.4)
      for (double z = 0.2; z < 3; z += 0.4) pile.push_back(grain(x, y, z, 0.4));
  EXPECT_NEAR(line_of(pile)->angle, before, 0.3);
}

// A slope that ends 3 m above the floor, and rock beyond the gap as high as its end.
TEST(SlopeProfile, EndsAtItsFirstGap) {
  std::vector<Grain> pile = slope(37, 0, 6);
  std::erase_if(pile, [](const Grain& g) { return g.position.x() > 7 / std::tan(37 * kRadians); });
  const double before = line_of(pile)->angle;
  for (double x = 12; x < 17; x += 0.3)
    for (double y = -4; y < 4; y += 0.3) pile.push_back(grain(x, y, 2.8, 0.4));
  EXPECT_NEAR(line_of(pile)->angle, before, 0.1);
}

// Rock 8 m wide, as layers look at, whatever the height of the bench.
TEST(SlopeProfile, OfATallBenchIsThatOfItsMiddle) {
  const auto line = slope_line(slope_profile(slope(37, 0, 8, 80), 80), 80);
  ASSERT_TRUE(line);
  EXPECT_NEAR(line->angle, 37, 0.5);
}

TEST(SlopeProfile, HasNoAngleWhereThereIsNoSlope) {
  EXPECT_FALSE(line_of({}));
  EXPECT_FALSE(line_of({grain(0, 0, 9, 1), grain(3, 0, 5, 1), grain(6, 0, 2, 1)})) << "three grains";
  std::vector<Grain> flat;
  for (double x = 0; x < 20; x += 0.3)
    for (double y = -4; y < 4; y += 0.3) flat.push_back(grain(x, y, 0.2, 0.4));
  EXPECT_FALSE(line_of(flat)) << "a carpet on the floor";
  EXPECT_THROW(slope_profile(flat, 0), std::invalid_argument);
}

TEST(SlopeProfile, DoesNotFollowWhatLiesFarAway) {
  std::vector<Grain> pile = slope(37, 0, 7);
  const auto before = slope_profile(pile, kHeight);
  pile.push_back(grain(1e9, 0, 5, 0.5));
  EXPECT_EQ(slope_profile(pile, kHeight), before);
}

}  // namespace
}  // namespace scree
