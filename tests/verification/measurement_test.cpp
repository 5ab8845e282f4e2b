// Each effect on measurement against a formula, on rock whose grading is one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analysis/pile/counted_grains.h"
#include "analysis/pile/half_cone.h"
#include "analysis/pile/heap_shape.h"
#include "analysis/pile/lateral.h"
#include "analysis/pile/seen_surface.h"
#include "sim/effects/effect.h"

namespace scree {
namespace {

constexpr double kD50 = 0.2;  // m

Measurement measured_with(const std::string& name, std::vector<double> values) {
  const EffectUse use{find_effect(name), std::move(values)};
  return modifications(std::span(&use, 1), {.d50 = kD50}).measurement;
}

// 4,000 grains of 1 kg whose ln d has these quantiles.
template <typename Quantile>
std::vector<Grain> rock(Quantile ln_d, double z = 1) {
  std::vector<Grain> grains(4000);
  for (std::size_t k = 0; k < grains.size(); ++k) {
    grains[k].id = static_cast<std::int64_t>(k);
    grains[k].diameter = std::exp(ln_d((static_cast<double>(k) + 0.5) / static_cast<double>(grains.size())));
    grains[k].mass = 1;
    grains[k].position = Vec3(0, 0, z);
    grains[k].dump = 1;
  }
  return grains;
}

// Evenly in ln d between D50 / spread and D50 spread.
std::vector<Grain> even_rock(double spread, double z = 1) {
  return rock([&](double p) { return std::log(kD50) + (2 * p - 1) * std::log(spread); }, z);
}

// Normal in ln d.
std::vector<Grain> lognormal_rock(double median, double deviation, double z = 1) {
  return rock(
      [&](double p) {
        double low = -8, high = 8;
        for (int k = 0; k < 60; ++k) {
          const double x = 0.5 * (low + high);
          (0.5 * std::erfc(-x / std::sqrt(2)) < p ? low : high) = x;
        }
        return std::log(median) + deviation * low;
      },
      z);
}

// The section of all rock of a slope 2 m high.
Section whole(const std::vector<Grain>& pile, const std::vector<Grain>& original,
              const Measurement& measured) {
  return analyse_sections(pile, original, 2, 1, measured).sections.front();
}

// Cut off sharply at L, rock even in ln d up to its largest diameter has D_p = L (largest / L)^p, and all of
// its weight.
TEST(DetectionLimit, SharpLimitCutsTheCurve) {
  const double spread = 5, limit = 0.4 * kD50, largest = spread * kD50;
  const auto grains = even_rock(spread);
  const Section seen = whole(grains, grains, measured_with("detection_limit", {0.4, 50}));
  EXPECT_NEAR(seen.d10 / (limit * std::pow(largest / limit, 0.1)), 1, 0.01);
  EXPECT_NEAR(seen.d50 / std::sqrt(limit * largest), 1, 0.01);
  EXPECT_NEAR(seen.mass, 4000, 1e-6);
  EXPECT_NEAR(seen.chi, 0, 1e-12);  // the rock as dumped is measured likewise
}

// Of two equal masses at the limit and far above it one half and all is seen: shares of 1/3 and 2/3.
TEST(DetectionLimit, HalfIsSeenAtTheLimit) {
  std::vector<Grain> two(2);
  two[0].diameter = 0.3 * kD50, two[1].diameter = 300 * kD50;
  two[0].mass = two[1].mass = 3;
  const CountedGrains seen = count_grains({&two[0], &two[1]}, measured_with("detection_limit", {0.3, 6}));
  EXPECT_NEAR(seen.masses[0], 2, 1e-9);
  EXPECT_NEAR(seen.masses[1], 4, 1e-9);
}

// Normal in ln d with deviation s, blurred by w: deviation sqrt(s^2 + w^2), D50 stays. The coarsest quartile
// of a normal distribution lies 1.2711 deviations above its mean, so chi of a part that is k times coarser is
// ln k / (1.2711 sqrt(s^2 + w^2)).
TEST(ImageBlur, WidensTheCurveAndLowersChi) {
  const double s = 0.6, w = 0.5, k = 1.3, both = std::hypot(s, w);
  const auto original = lognormal_rock(kD50, s), part = lognormal_rock(k * kD50, s);
  for (const bool blurred : {false, true}) {
    const double deviation = blurred ? both : s;
    const Section seen = whole(part, original, blurred ? measured_with("image_blur", {w}) : Measurement{});
    EXPECT_NEAR(seen.d50, k * kD50, 0.01 * k * kD50);
    EXPECT_NEAR(std::log(seen.d80 / seen.d50), 0.8416 * deviation, 0.02 * deviation);
    EXPECT_NEAR(seen.chi, std::log(k) / (1.2711 * deviation), 0.01);
  }
}

// What hardly blurs, biases, hides or shifts changes hardly anything, of few grains too: each effect on
// measurement goes over into none.
TEST(Measurement, IsContinuousWhereAnEffectBegins) {
  const auto original = lognormal_rock(kD50, 0.6);
  std::vector<Grain> pile;
  for (const Grain& grain : lognormal_rock(1.2 * kD50, 0.5))
    if (grain.id % 80 == 0) pile.push_back(grain);
  for (std::size_t k = 0; k < pile.size(); ++k)
    pile[k].position.z() =
        2 * (1 - (static_cast<double>(37 * k % pile.size()) + 0.5) / static_cast<double>(pile.size()));
  const auto seen = [&](const Measurement& measured) {
    std::vector<double> all;
    const SectionTable table = analyse_sections(pile, original, 2, 2, measured);
    for (const Section& s : table.sections) {
      all.insert(all.end(), {s.mass, s.chi, s.d10, s.d50, s.d80, s.d90, s.d95, s.d10_rel, s.d50_rel,
                             s.d90_rel, s.ksat_rel});
      all.insert(all.end(), s.passing.begin(), s.passing.end());
    }
    return all;
  };
  const std::vector<double> none = seen({});
  for (const auto& [name, values] :
       std::vector<std::pair<std::string, std::vector<double>>>{{"image_blur", {1e-6}},
                                                                {"detection_limit", {1e-6, 6}},
                                                                {"image_shape_bias", {1e-6}},
                                                                {"section_borders", {1e-6}},
                                                                {"surface_only", {1e-6}},
                                                                {"own_reference", {1e-6}}}) {
    const std::vector<double> with = seen(measured_with(name, values));
    ASSERT_EQ(with.size(), none.size()) << name;
    for (std::size_t k = 0; k < none.size(); ++k)
      EXPECT_NEAR(with[k], none[k], 1e-4 * std::max(1.0, std::abs(none[k]))) << name << " " << k;
  }
}

// One grain of diameter d is seen as a normal distribution of ln d by a rule of five points: the middle of
// the curve is d, p = 0 and 1 are its ends, and in between stands the point whose share of the mass holds p.
TEST(ImageBlur, SpreadsOneGrainAboutItsDiameter) {
  const double d = 0.3, w = 0.4, inner = 1.3556261799742659, outer = 2.8569700138728056;
  const PassingCurve curve({d}, {2000}, w);
  EXPECT_NEAR(curve.diameter(0.5), d, 1e-9);
  EXPECT_NEAR(curve.diameter(0.9), d * std::exp(inner * w), 1e-9);
  EXPECT_NEAR(curve.diameter(0.1), d * std::exp(-inner * w), 1e-9);
  EXPECT_NEAR(curve.diameter(1), d * std::exp(outer * w), 1e-9);
  EXPECT_NEAR(curve.diameter(0), d * std::exp(-outer * w), 1e-9);
  EXPECT_NEAR(curve.mean_log_diameter(), std::log10(d), 1e-12);
  EXPECT_DOUBLE_EQ(curve.mass(), 2000);
  EXPECT_THROW(PassingCurve({d}, {1}, -0.1), std::invalid_argument);
}

// d (d / D50)^b: relative diameters are raised to 1 + b, chi stays.
TEST(ImageShapeBias, RelativeDiametersAreRaisedToAPower) {
  const double b = 0.3, k = 1.4;
  const auto original = lognormal_rock(kD50, 0.5), part = lognormal_rock(k * kD50, 0.5);
  const Section truth = whole(part, original, {}),
                seen = whole(part, original, measured_with("image_shape_bias", {b}));
  EXPECT_NEAR(seen.d50_rel, std::pow(truth.d50_rel, 1 + b), 1e-9);
  EXPECT_NEAR(seen.d80, truth.d80 * std::pow(truth.d80 / kD50, b), 1e-9);
  EXPECT_NEAR(seen.chi, truth.chi, 1e-12);
}

// A slope with the same mass everywhere: of n sections the first has (1 + s) / n, the last (1 - s) / n.
TEST(SectionBorders, FirstGrowsAndLastShrinks) {
  const double height = 10;
  auto pile = lognormal_rock(kD50, 0.5);
  for (std::size_t k = 0; k < pile.size(); ++k)
    pile[k].position.z() = height * (1 - (static_cast<double>(k) + 0.5) / static_cast<double>(pile.size()));
  for (const double s : {-0.3, 0.25}) {
    const auto sections =
        analyse_sections(pile, pile, height, 4, measured_with("section_borders", {s})).sections;
    EXPECT_NEAR(sections[0].mass, 1000 * (1 + s), 1);
    EXPECT_NEAR(sections[1].mass, 1000, 1);
    EXPECT_NEAR(sections[3].mass, 1000 * (1 - s), 1);
  }
}

// Rings of a disc with the same mass everywhere: borders at (1 + s) / 3 and (2 + s) / 3 of the radius, so
// shares of ((1 + s) / 3)^2 and 1 - ((2 + s) / 3)^2.
TEST(SectionBorders, RingsMoveOutwards) {
  const double radius = 3, s = 0.4;
  auto heap = lognormal_rock(kD50, 0.5);
  for (std::size_t k = 0; k < heap.size(); ++k) {
    const double part = (static_cast<double>(k) + 0.5) / static_cast<double>(heap.size());
    heap[k].position = Vec3(radius * std::sqrt(part), 0, 0.1);
  }
  ReposeAngle read;
  read.radius = radius, read.height = 1, read.surface_step = 1, read.surface = {1, 1, 1, 1};
  const HeapShape shape = measure_heap_shape(heap, heap, read, measured_with("section_borders", {s}));
  EXPECT_NEAR(shape.mass_share[0], std::pow((1 + s) / 3, 2), 1e-3);
  EXPECT_NEAR(shape.mass_share[2], 1 - std::pow((2 + s) / 3, 2), 1e-3);
}

// In a half cone a border further down the flank lies lower and further out.
TEST(SectionBorders, CellsOfAHalfConeMoveDown) {
  constexpr double step = 0.012;
  std::vector<Grain> heap;
  for (double x = step / 2; x < 0.6; x += step)
    for (double y = -0.6; y < 0.6; y += step)
      for (double z = step / 2; z < 0.3; z += step) {
        if (z / 0.3 + std::hypot(x, y) / 0.6 > 1) continue;
        Grain grain;
        grain.position = Vec3(x, y, z), grain.diameter = 0.015, grain.mass = 1;
        heap.push_back(grain);
      }
  const auto mass_of_top = [&](double shift) {
    return analyse_half_cone(heap, heap, measured_with("section_borders", {shift})).surface.sections[0].mass;
  };
  // The top above (2 - s) / 3 of the height holds ((1 + s) / 3)^3 of a cone.
  EXPECT_NEAR(mass_of_top(0.5) / static_cast<double>(heap.size()), 0.125, 0.03);
  EXPECT_LT(mass_of_top(-0.3), mass_of_top(0.3));
}

// Strips across the slope lie in the same sections.
TEST(SectionBorders, StripsFollowTheSections) {
  auto pile = lognormal_rock(kD50, 0.5);
  for (std::size_t k = 0; k < pile.size(); ++k)
    pile[k].position = Vec3(0, 0, 10 * (1 - (static_cast<double>(k) + 0.5) / 4000));
  const Lateral lateral = analyse_lateral(pile, pile, 10, 4, 1, 4, measured_with("section_borders", {0.25}));
  EXPECT_NEAR(lateral.sections[0].mass[0], 1250, 1);
}

Grain grain_at(const Vec3& x, double diameter) {
  Grain grain;
  grain.position = x;
  grain.diameter = diameter;
  grain.mass = 2760 * std::numbers::pi / 6 * diameter * diameter * diameter;
  grain.dump = 1;
  return grain;
}

// Of the disc of a grain an equal one before it, d aside, covers the lens 2 r^2 acos(d / 2r) - d/2 (4 r^2 -
// d^2)^(1/2).
TEST(SeenShares, LeaveOutTheLensThatAnotherCovers) {
  const double r = 0.5, d = 0.6, angle = 30, slope = angle * std::numbers::pi / 180;
  const Vec3 down(std::cos(slope), 0, -std::sin(slope)), out(std::sin(slope), 0, std::cos(slope));
  const Vec3 behind(1, 2, 3);
  const std::vector<Grain> pile{
      grain_at(behind, 2 * r), grain_at(behind + d * down + 3 * r * out, 2 * r),
      grain_at(behind - 2 * r * out, r),  // wholly covered by the first
      grain_at(behind + 3 * down, 0.02),  // alone
  };
  const std::vector<double> seen = seen_shares(pile, angle);
  const double lens = 2 * r * r * std::acos(d / (2 * r)) - 0.5 * d * std::sqrt(4 * r * r - d * d);
  EXPECT_NEAR(seen[0], 1 - lens / (std::numbers::pi * r * r), 0.003);
  EXPECT_EQ(seen[1], 1);
  EXPECT_EQ(seen[2], 0);
  EXPECT_EQ(seen[3], 1);
  EXPECT_THROW(seen_shares(pile, 90), std::invalid_argument);
  EXPECT_TRUE(seen_shares({}, 30).empty());
}

// Blocks on a slope with stones behind each, which nobody sees who looks along its normal.
struct Facade {
  std::vector<Grain> pile, blocks, original;
  explicit Facade(double slope_deg) {
    const double slope = slope_deg * std::numbers::pi / 180;
    const Vec3 down(std::cos(slope), 0, -std::sin(slope)), out(std::sin(slope), 0, std::cos(slope));
    for (int i = 0; i * std::sin(slope) < 5.6; ++i)
      for (int j = -11; j <= 11; ++j) {
        const Vec3 block = Vec3(0.5, j, 5.7) + i * down;
        blocks.push_back(grain_at(block, j % 2 == 0 ? 0.9 : 0.8));
        pile.push_back(blocks.back());
        for (int k = 0; k < 4; ++k) pile.push_back(grain_at(block - (0.7 + 0.3 * k) * out, 0.2));
        for (int k = 0; k < 5; ++k) original.push_back(grain_at(block, 0.1 + 0.2 * k));
      }
  }
};

std::vector<double> chi_of(const SectionTable& table) {
  std::vector<double> all;
  for (const Section& s : table.sections) all.push_back(s.chi);
  return all;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double within) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], within) << k;
}

// Mean log d, and so chi, is linear in the share.
TEST(SurfaceOnly, ShowsWhatIsNotCovered) {
  for (const double slope : {20.0, 37.0}) {
    const Facade wall(slope);
    const auto seen = [&](double share) {
      return analyse_sections(wall.pile, wall.original, 6, 3, measured_with("surface_only", {share}));
    };
    const auto truth = chi_of(seen(0)), half = chi_of(seen(0.5)), surface = chi_of(seen(1));
    expect_near(surface, chi_of(analyse_sections(wall.blocks, wall.original, 6, 3)), 1e-12);
    for (std::size_t s = 0; s < 3; ++s) {
      EXPECT_GT(surface[s], truth[s] + 0.01);
      EXPECT_NEAR(half[s], 0.5 * (truth[s] + surface[s]), 1e-12);
      EXPECT_NEAR(seen(1).sections[s].mass, seen(0).sections[s].mass, 1e-6) << "mass is not what is seen";
    }
    const auto strips = [&](const std::vector<Grain>& pile, const Measurement& measured) {
      std::vector<double> all;
      for (const LateralSection& s : analyse_lateral(pile, wall.original, 6, 3, 1, 8, measured).sections)
        all.insert(all.end(), s.chi.begin(), s.chi.end());
      return all;
    };
    EXPECT_GE(strips(wall.blocks, {}).size(), 6u);
    expect_near(strips(wall.pile, measured_with("surface_only", {1.0})), strips(wall.blocks, {}), 1e-12);
  }
}

// Sections of which nothing is seen have a mass and no grading; slopes that rise are seen from where others
// are.
TEST(SurfaceOnly, WhatIsHiddenHasNoGrading) {
  std::vector<Grain> pile;
  for (int j = -3; j <= 3; ++j) {
    pile.push_back(
        grain_at(Vec3(1, 0.2 * j, 1), 0.1));  // in the lower half, under a boulder in the upper one
    pile.push_back(grain_at(Vec3(1 + 5 * std::sin(0.6), 0, 1 + 5 * std::cos(0.6)), 2.5));
  }
  const auto sections = analyse_sections(pile, pile, 8, 2, measured_with("surface_only", {1.0})).sections;
  EXPECT_TRUE(std::isfinite(sections[0].chi));
  EXPECT_TRUE(std::isnan(sections[1].chi) && std::isnan(sections[1].d50));
  EXPECT_NEAR(sections[1].mass, 7 * pile[0].mass, 1e-9);
  Facade wall(37);
  for (Grain& grain : wall.pile) grain.position.x() *= -1;
  for (const double chi :
       chi_of(analyse_sections(wall.pile, wall.original, 6, 3, measured_with("surface_only", {1.0}))))
    EXPECT_TRUE(std::isfinite(chi));
}

// Both, as on photographs of a slope: the blocks against the blocks.
TEST(SurfaceOnly, ThePileItselfIsWhatIsSeenOfIt) {
  const Facade wall(37);
  Measurement both = measured_with("surface_only", {1.0});
  both.own_reference = 1;
  expect_near(chi_of(analyse_sections(wall.pile, wall.original, 6, 3, both)),
              chi_of(analyse_sections(wall.blocks, wall.blocks, 6, 3)), 1e-12);
}

// Against the pile itself, measured as it is, the mean of chi by mass is 0; log d_0 is linear in the share.
// Strips of a section refer to the whole slope.
TEST(OwnReference, ComparesWithThePile) {
  auto pile = lognormal_rock(1.3 * kD50, 0.5);
  const auto original = lognormal_rock(kD50, 0.4);
  for (std::size_t k = 0; k < pile.size(); ++k)  // finer above, and on the left
    pile[k].position = Vec3(0, static_cast<double>(k % 100) * 0.1 - 5,
                            10 * (1 - (static_cast<double>(k) + 0.5) / static_cast<double>(pile.size())));
  const auto table = [&](double share) {
    return analyse_sections(pile, original, 10, 4, measured_with("own_reference", {share}));
  };
  double moment = 0;
  for (const Section& s : table(1).sections) moment += s.mass * s.chi;
  EXPECT_NEAR(moment / 4000, 0, 1e-9);
  EXPECT_NEAR(table(1).d0_log, std::log10(1.3 * kD50), 1e-6);
  EXPECT_NEAR(table(0.25).d0_log, 0.75 * table(0).d0_log + 0.25 * table(1).d0_log, 1e-12);
  EXPECT_LT(table(1).sections[0].chi, -0.2);
  const Lateral lateral = analyse_lateral(pile, original, 10, 4, 1, 4, measured_with("own_reference", {1.0}));
  for (std::size_t s = 0; s < 4; ++s) {
    const LateralSection& strips = lateral.sections[s];
    double of_strips = 0;
    for (std::size_t k = 0; k < strips.chi.size(); ++k) of_strips += strips.mass[k] * strips.chi[k];
    EXPECT_NEAR(of_strips, table(1).sections[s].mass * table(1).sections[s].chi, 1e-6);
  }
}

}  // namespace
}  // namespace scree
