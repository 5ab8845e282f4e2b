// Generated spheres honour the grading and the mass with any seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <set>

#include "scree_version.h"
#include "sim/material/grading.h"

namespace scree {
namespace {

constexpr double density = 2760;  // kg/m3

Grading from_assets(const std::string& name) {
  return read_grading(std::filesystem::path(SCREE_SOURCE_DIR) / "assets" / "gradings" / (name + ".csv"));
}

double mass_of(double d, double exponent = 0) {
  return density * std::pow(d / 0.3, exponent) * std::numbers::pi / 6 * d * d * d;
}

struct Load {
  std::string grading;
  double mass;          // kg
  double exponent = 0;  // of size in the density
};

class GeneratedLoad : public testing::TestWithParam<Load> {};

TEST_P(GeneratedLoad, KeepsPassingWithin2PointsAndMassWithinHalfAPercent) {
  const Grading grading = from_assets(GetParam().grading);
  const double exponent = GetParam().exponent;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const auto diameters =
        generate_diameters(grading, GetParam().mass, {density, exponent, 0.3}, seed, seed % 4 + 1);
    ASSERT_TRUE(std::is_sorted(diameters.rbegin(), diameters.rend()));
    ASSERT_LE(diameters.front(), grading.max_diameter());
    ASSERT_GE(diameters.back(), grading.min_diameter());
    double total = 0;
    for (const double d : diameters) total += mass_of(d, exponent);
    EXPECT_NEAR(total, GetParam().mass, 0.005 * GetParam().mass) << "seed " << seed;
    for (const auto& point : grading.points()) {
      double finer = 0;
      for (const double d : diameters)
        if (d <= point.diameter) finer += mass_of(d, exponent);
      EXPECT_NEAR(finer / total, point.passing, 0.02) << "seed " << seed << " at " << point.diameter << " m";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Loads, GeneratedLoad,
                         testing::Values(Load{"CM0", 300e3}, Load{"QB0", 300e3}, Load{"QB0", 100e3},
                                         Load{"Lab0", 75}, Load{"Lab0", 20}, Load{"CM0", 300e3, 0.2},
                                         Load{"CM0", 300e3, -0.5}),
                         [](const auto& load) {
                           const double e = load.param.exponent;
                           return load.param.grading + "_" + std::to_string(std::lround(load.param.mass)) +
                                  "kg" +
                                  (e > 0   ? "_dense_blocks"
                                   : e < 0 ? "_light_blocks"
                                           : "");
                         });

TEST(GenerateDiameters, Qb0DumpHasThePrintedNumberOfSpheres) {
  // Printed: 9,200 in 4 dumps of 300 t.
  double count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    count +=
        static_cast<double>(generate_diameters(from_assets("QB0"), 300e3, {density}, seed, 1).size()) / 20;
  EXPECT_NEAR(count, 2300, 0.02 * 2300);
}

TEST(GenerateDiameters, IsAFunctionOfSeedAndDump) {
  const Grading qb = from_assets("QB0");
  const auto first = generate_diameters(qb, 300e3, {density}, 10001, 1);
  EXPECT_EQ(first, generate_diameters(qb, 300e3, {density}, 10001, 1));
  EXPECT_NE(first, generate_diameters(qb, 300e3, {density}, 10002, 1));
  EXPECT_NE(first, generate_diameters(qb, 300e3, {density}, 10001, 2));
}

TEST(GenerateDiameters, SeedsVaryTheCoarsestSpheres) {
  // The share of the largest size class differs between loads as it does between truck loads.
  const Grading qb = from_assets("QB0");
  std::vector<double> largest;
  for (std::uint64_t seed = 1; seed <= 50; ++seed)
    largest.push_back(generate_diameters(qb, 300e3, {density}, seed, 1).front());
  const double mean = std::accumulate(largest.begin(), largest.end(), 0.0) / largest.size();
  double variance = 0;
  for (const double d : largest) variance += (d - mean) * (d - mean) / (largest.size() - 1);
  EXPECT_GT(std::sqrt(variance), 0.015 * mean);
  EXPECT_EQ(std::set<double>(largest.begin(), largest.end()).size(), largest.size());
}

TEST(GenerateDiameters, ManyLoadsTogetherApproachTheCurveBetweenItsPointsToo) {
  // 60 loads: errors of single loads (up to one sphere's mass) are independent and average out.
  const Grading qb = from_assets("QB0");
  std::vector<double> all;
  for (std::uint64_t dump = 1; dump <= 60; ++dump) {
    const auto load = generate_diameters(qb, 300e3, {density}, 1, dump);
    all.insert(all.end(), load.begin(), load.end());
  }
  double total = 0;
  for (const double d : all) total += mass_of(d);
  for (const double diameter : {0.5, 1.0, 1.3, 1.8, 2.2, 2.5}) {
    double finer = 0;
    for (const double d : all)
      if (d <= diameter) finer += mass_of(d);
    EXPECT_NEAR(finer / total, qb.passing(diameter), 0.01) << diameter;
  }
}

TEST(GenerateDiameters, SmallLoadErrsByNoMoreThanOneSphere) {
  // 10 t of QB0: the header promises an error below one sphere's share, here of the largest drawn.
  const Grading qb = from_assets("QB0");
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto diameters = generate_diameters(qb, 10e3, {density}, seed, 1);
    double total = 0, finer = 0;
    for (const double d : diameters) total += mass_of(d);
    EXPECT_NEAR(total, 10e3, mass_of(diameters.front()));
    for (const auto& point : qb.points()) {
      finer = 0;
      for (const double d : diameters)
        if (d <= point.diameter) finer += mass_of(d);
      EXPECT_NEAR(finer / 10e3, point.passing, mass_of(std::max(point.diameter, diameters.front())) / 10e3);
    }
  }
}

TEST(GenerateDiameters, RefusesWhatCannotBeMade) {
  const Grading qb = from_assets("QB0");
  EXPECT_THROW(generate_diameters(qb, 0, {density}, 1, 1), std::invalid_argument);
  EXPECT_THROW(generate_diameters(qb, std::nan(""), {density}, 1, 1), std::invalid_argument);
  EXPECT_THROW(generate_diameters(qb, 300e3, {-1}, 1, 1), std::invalid_argument);
  EXPECT_THROW(generate_diameters(qb, 1, {density}, 1, 1), std::invalid_argument);  // a 0.1 m sphere: 1.4 kg
  EXPECT_THROW(generate_diameters(from_assets("G0"), 1e3, {density}, 1, 1),
               std::invalid_argument);  // 0.075 mm
}

}  // namespace
}  // namespace scree
