// Small runs of every experiment beside the stored ones: a change of physics shows, a change of roundings
// does not. The runs have other seeds than the stored ones, so that they already lie as far off as a change
// of roundings would put them.
#include "tests/regression/small_runs/small_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "sim/material/random.h"

namespace scree {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kByChance = 0.01;  // probability that the test fails where only roundings changed

// Half of it is for the scenes, each with its share, half for all together.
double bound() {
  return kByChance / 2 / static_cast<double>(scene_names().size());
}

std::string in_words(const SceneShift& shift) {
  std::string text;
  for (std::size_t k = 0; k < shift.numbers.size() && k < 8; ++k) {
    const SceneShift::Number& each = shift.numbers[k];
    text += each.name + " " + std::to_string(each.now.mean) + ", stored " + std::to_string(each.stored.mean) +
            " +- " + std::to_string(each.stored.std) + ", z " + std::to_string(each.z) + "\n";
  }
  return text;
}

// 40 runs of 10 numbers, and 8 of the same kind.
struct Made {
  SceneNumbers stored, now;
  explicit Made(std::uint64_t seed) {
    Random draw(seed, 0, RandomPurpose::measurement);
    for (int number = 0; number < 10; ++number) {
      const std::string name = "number" + std::to_string(number);
      for (int k = 0; k < kStoredSeeds; ++k) stored[name].push_back(draw.uniform());
      for (int k = 0; k < kTestedSeeds; ++k) now[name].push_back(draw.uniform());
    }
  }
};

TEST(SmallRunsTest, OfTheSameKindPassByTheirProbability) {
  int below = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Made made(seed);
    below += shift_of(made.stored, made.now).p < 0.2 ? 1 : 0;
  }
  EXPECT_LE(below, 20) << "of 60; 12 are expected at most, deviation 3.1";
}

TEST(SmallRunsTest, OneNumberOfManyIsEnough) {
  Made made(1);
  for (double& value : made.now["number3"]) value += 1;
  const SceneShift shift = shift_of(made.stored, made.now);
  EXPECT_EQ(shift.p, 2.0 / (1 + kDraws)) << "no draw is as far";
  EXPECT_EQ(shift.numbers.front().name, "number3");
  // All 8 above all 40: the mean of their ranks is 20 above the mean, its deviation sqrt(49 * 40 / (12 * 8)).
  EXPECT_NEAR(shift.numbers.front().z, 20 / std::sqrt(49.0 * 40 / (12 * 8)), 1e-9);
  EXPECT_LT(2.0 / (1 + kDraws), bound());
}

TEST(SmallRunsTest, MissingValuesRankLowest) {
  Made made(1);
  for (double& value : made.now["number3"]) value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_LT(shift_of(made.stored, made.now).p, bound());
  made.now.erase("number3");
  EXPECT_LT(shift_of(made.stored, made.now).p, bound());
  EXPECT_THAT(shift_of(made.stored, made.now).broken, ElementsAre(HasSubstr("number3")));
}

TEST(SmallRunsTest, WhatNoSeedChangesIsTheSameToAMillionth) {
  const SceneNumbers stored{{"rebound", std::vector<double>(kStoredSeeds, 0.5)}};
  const auto now = [&](double value) {
    return shift_of(stored, {{"rebound", std::vector<double>(kTestedSeeds, value)}});
  };
  EXPECT_THAT(now(0.5 + 4e-7).broken, IsEmpty());
  EXPECT_EQ(now(0.5 + 4e-7).p, 1);
  EXPECT_THAT(now(0.500001).broken, ElementsAre(HasSubstr("rebound")));
}

// Fisher: -2 ln p is chi-square of 2 degrees of freedom; of one scene p itself; of two p1 p2 (1 - ln(p1 p2)).
TEST(SmallRunsTest, SmallProbabilitiesAddUp) {
  EXPECT_NEAR(together({0.03}), 0.03, 1e-12);
  EXPECT_NEAR(together({0.03, 0.2}), 0.006 * (1 - std::log(0.006)), 1e-12);
}

TEST(SmallRuns, AreWhatTheyWere) {
  const auto stored = read_numbers(stored_numbers_file());
  std::vector<double> p;
  for (const std::string& scene : scene_names()) {
    const SceneShift shift = shift_of_tested(stored, scene);
    EXPECT_THAT(shift.broken, IsEmpty()) << scene;
    EXPECT_GT(shift.p, bound()) << scene << "\n" << in_words(shift);
    p.push_back(shift.p);
    std::printf("%-20s %3zu numbers, p %.4f\n", scene.c_str(), shift.numbers.size(), shift.p);
  }
  EXPECT_GT(together(p), kByChance / 2);
}

TEST(SmallRuns, EverySceneIsStoredWithItsMainNumbers) {
  std::vector<std::string> stored;
  for (const auto& [scene, numbers] : read_numbers(stored_numbers_file())) {
    stored.push_back(scene);
    EXPECT_TRUE(numbers.contains("angle_deg") || numbers.contains("chi_S3") ||
                numbers.contains("chi_bottom") || numbers.contains("rebound_height_m"))
        << scene;
  }
  EXPECT_EQ(stored, scene_names());
}

// That the bound is not too wide to notice anything.
TEST(SmallRuns, NoticeLocalDampingAQuarterLower) {
  EXPECT_LT(
      shift_of_tested(read_numbers(stored_numbers_file()), "end_dump", {"material.local_damping=0.3"}).p,
      bound());
}

TEST(SmallRuns, NoticeAnotherRebound) {
  EXPECT_THAT(
      shift_of_tested(read_numbers(stored_numbers_file()), "drop", {"material.local_damping=0.401"}).broken,
      testing::Not(IsEmpty()));
}

}  // namespace
}  // namespace scree
