// The whole chain on virtual photographs, whose truth is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>

#include "analysis/image/image_bias.h"
#include "analysis/image/render_photo.h"
#include "analysis/image/slope_view.h"
#include "sim/material/input_text.h"
#include "sim/material/random.h"

namespace scree {
namespace {

// CM0's middle, between 0.12 and 0.8 m: the few largest blocks of the whole grading would decide over a
// picture as small as these.
Grading rock() {
  return read_grading(SCREE_TEST_ASSETS "/gradings/CM0.csv").scalped(0.12, 0.8);
}

struct Sun {
  double azimuth, elevation;
};
constexpr Sun kSuns[] = {{90, 80}, {135, 60}, {20, 40}};

Photo photo_of(GrainLayout layout, double coverage, const Sun& sun, std::uint64_t seed = 7,
               double segregation = 0.6) {
  SceneSettings scene;
  scene.layout = layout;
  scene.coverage = coverage;
  scene.segregation = segregation;
  scene.target_margin = 0.65;
  scene.seed = seed;
  PhotoSettings photo;
  photo.sun_azimuth_deg = sun.azimuth;
  photo.sun_elevation_deg = sun.elevation;
  return render_photo(make_scene(rock(), scene), photo);
}

// The rock is spheres.
PhotoAnalysisSettings for_spheres() {
  PhotoAnalysisSettings settings;
  settings.model = SizeModel::sphere;
  settings.rock_within_frame = true;
  return settings;
}

struct Case {
  GrainLayout layout;
  double coverage;
  // Error of D50: the bars that are asked of the analysis, docs/image.md. Other pictures of this rock miss
  // them: 12 of 90 in bench/results/photographs.csv with the sun at 80, 60 and 40 degrees.
  double allowed;
};

class Chain : public testing::TestWithParam<Case> {};

TEST_P(Chain, FindsTheGradingInEveryLight) {
  const auto [layout, coverage, allowed] = GetParam();
  for (const Sun& sun : kSuns) {
    SCOPED_TRACE(testing::Message() << "sun " << sun.azimuth << ", " << sun.elevation);
    const Photo photo = photo_of(layout, coverage, sun);
    const PhotoAnalysis found = analyse_photo(photo.picture, for_spheres());
    EXPECT_NEAR(found.scale.at(0), 0.012, 0.01 * 0.012);
    const TruthCheck check = check_against_truth(found, photo.truth, for_spheres());
    EXPECT_NEAR(check.measured[0].d50 / check.known[0].d50, 1, allowed);
    if (layout != GrainLayout::apart) continue;
    for (std::size_t k = 1; k < check.known.size(); ++k)
      EXPECT_NEAR(check.measured[k].chi, check.known[k].chi, 0.15) << "S" << k;
  }
}
INSTANTIATE_TEST_SUITE_P(VirtualPhotos, Chain,
                         testing::Values(Case{GrainLayout::apart, 0.35, 0.10},
                                         Case{GrainLayout::touching, 0.5, 0.15},
                                         Case{GrainLayout::overlapping, 0.9, 0.25}));

TEST(VirtualPhoto, IsTheSameEveryTimeAndForAnyNumberOfThreads) {
  const Photo first = photo_of(GrainLayout::touching, 0.4, kSuns[1]);
  const Photo again = photo_of(GrainLayout::touching, 0.4, kSuns[1]);
  EXPECT_EQ(cv::norm(first.picture, again.picture, cv::NORM_INF), 0);
  const int threads = cv::getNumThreads();
  std::vector<PhotoAnalysis> found;
  for (const int n : {1, 2, 7}) {
    cv::setNumThreads(n);
    found.push_back(analyse_photo(first.picture, for_spheres()));
  }
  cv::setNumThreads(threads);
  for (const PhotoAnalysis& other : found) {
    ASSERT_EQ(other.grains.size(), found[0].grains.size());
    for (std::size_t i = 0; i < other.grains.size(); ++i)
      EXPECT_EQ(other.grains[i].size[0].mass, found[0].grains[i].size[0].mass);
  }
}

TEST(VirtualPhoto, ShadowsFallAwayFromTheSun) {
  RockScene scene{4, 4, {}, {}};
  scene.grains.push_back({.id = 1, .position = {2, 2, 0.5}, .diameter = 1, .mass = 1});
  PhotoSettings settings;
  settings.target_diameter = 0;
  settings.noise = settings.texture = 0;
  settings.sun_azimuth_deg = 0;  // from the right
  settings.sun_elevation_deg = 45;
  const cv::Mat3b picture = render_photo(scene, settings).picture;
  const auto grey = [&](double x, double y) {
    return picture(static_cast<int>(y / settings.m_per_px), static_cast<int>(x / settings.m_per_px))[1];
  };
  // The ball of radius 0.5 throws its shadow to x = 2 - 0.5 - 0.5 sqrt 2 at 45 degrees.
  EXPECT_LT(grey(1.4, 2), 0.8 * grey(2.6, 2));
  EXPECT_EQ(grey(0.5, 2), grey(3.5, 2));  // open ground
  EXPECT_GT(grey(2.3, 2), grey(1.7, 2));  // its lit side
}

TEST(VirtualPhoto, TruthSurvivesItsFile) {
  Photo photo = photo_of(GrainLayout::overlapping, 0.6, kSuns[0]);
  photo.truth.region = "0,10 999,700";
  const auto file = std::filesystem::temp_directory_path() / "scree_photo_truth_test.csv";
  std::ofstream(file) << truth_csv(photo.truth);
  const PhotoTruth read = read_truth(file);
  ASSERT_EQ(read.grains.size(), photo.truth.grains.size());
  EXPECT_NEAR(read.m_per_px, photo.truth.m_per_px, 1e-9);
  EXPECT_NEAR(read.scene_d50, photo.truth.scene_d50, 1e-6);
  EXPECT_EQ(read.region, photo.truth.region);
  EXPECT_NEAR(read.grains[5].diameter, photo.truth.grains[5].diameter, 1e-5);
  EXPECT_NEAR(read.grains[5].visible_share, photo.truth.grains[5].visible_share, 1e-3);
  std::ofstream(file) << "id,x_px\n1,2\n";
  EXPECT_THROW(read_truth(file), FileError);
  std::filesystem::remove(file);
}

TEST(VirtualPhoto, VisibleSharesAreThoseOfTheScene) {
  // A ball of 1 m over a ball of 1 m half a metre aside hides what two discs share:
  // 2 r^2 acos(s / 2r) - s/2 sqrt(4 r^2 - s^2).
  RockScene scene{4, 4, {}, {}};
  scene.grains.push_back({.id = 1, .position = {1.5, 2, 0.5}, .diameter = 1, .mass = 1});
  scene.grains.push_back({.id = 2, .position = {2.0, 2, 3.0}, .diameter = 1, .mass = 1});
  PhotoSettings settings;
  settings.m_per_px = 0.004;
  settings.target_diameter = 0;
  const PhotoTruth truth = render_photo(scene, settings).truth;
  const double lens = 2 * 0.25 * std::acos(0.5) - 0.25 * std::sqrt(1 - 0.25), disc = M_PI / 4;
  ASSERT_EQ(truth.grains.size(), 2u);
  EXPECT_NEAR(truth.grains[0].visible_share, 1 - lens / disc, 0.01);
  EXPECT_NEAR(truth.grains[1].visible_share, 1, 0.01);
  EXPECT_NEAR(truth.grains[1].x * settings.m_per_px, 2.0, 0.01);
}

TEST(ImageBias, RecoversALimitAndASlopePutIn) {
  // Outlines made by hand: detected by a step at 0.2 m of steepness 6, measured d^1.1 / 1 m^0.1.
  PhotoAnalysis found;
  PhotoTruth truth;
  truth.m_per_px = 0.01;
  truth.scene_d50 = 0.5;
  const int n = 4000;
  found.labels.of = cv::Mat1i(1, n, 0);
  Random random(3, 1, RandomPurpose::picture);
  for (int i = 0; i < n; ++i) {
    const double d = 0.1 * std::pow(10.0, random.uniform());
    truth.grains.push_back({i + 1, static_cast<double>(i), 0, d, d * d * d, d * d, 1, d, d});
    if (random.uniform() > 1 / (1 + std::pow(0.2 / d, 6))) continue;
    ImageGrain grain;
    grain.label = i + 1;
    grain.size[0] = {d * std::pow(d, 0.1), d * d * d};
    found.labels.of(0, i) = grain.label;
    found.grains.push_back(grain);
  }
  found.labels.count = n;
  found.region = PhotoRegion(found.labels.of.size(), {});
  const ImageBias bias = measure_bias({{&found, &truth}}, SizeModel::sphere);
  ASSERT_TRUE(bias.limit);
  EXPECT_NEAR(*bias.limit, 0.2, 0.01);
  EXPECT_NEAR(bias.steepness, 6, 0.6);
  EXPECT_NEAR(bias.exponent, 0.1, 1e-6);
  EXPECT_NEAR(bias.width, 0, 1e-6);
  EXPECT_EQ(bias.matched, static_cast<int>(found.grains.size()));
}

TEST(ImageBias, OfPerfectDetectionHasNoLimit) {
  PhotoAnalysis found;
  PhotoTruth truth;
  truth.m_per_px = 0.01;
  truth.scene_d50 = 0.5;
  found.labels.of = cv::Mat1i(1, 20, 0);
  for (int i = 0; i < 20; ++i) {
    const double d = 0.1 + 0.05 * i;
    truth.grains.push_back({i + 1, static_cast<double>(i), 0, d, d, d, 1, d, d});
    ImageGrain grain;
    grain.label = found.labels.of(0, i) = i + 1;
    grain.size[0] = {d, d};
    found.grains.push_back(grain);
  }
  found.labels.count = 20;
  found.region = PhotoRegion(found.labels.of.size(), {});
  const ImageBias bias = measure_bias({{&found, &truth}}, SizeModel::sphere);
  EXPECT_EQ(bias.limit, 0);
  EXPECT_NEAR(bias.exponent, 0, 1e-9);
}

// Twenty known grains of 0.1 to 1.05 m side by side, of which some are found as they are.
ImageBias bias_where(bool (*detected)(int grain), const std::vector<cv::Point>& region = {}) {
  PhotoAnalysis found;
  PhotoTruth truth;
  truth.m_per_px = 1;
  truth.scene_d50 = 0.5;
  found.labels.of = cv::Mat1i(10, 20, 0);
  found.labels.count = 20;
  found.region = PhotoRegion(found.labels.of.size(), region);
  for (int i = 0; i < 20; ++i) {
    const double d = 0.1 + 0.05 * i;
    truth.grains.push_back({i + 1, static_cast<double>(i), 0, d, d, d, 1, d, d});
    if (!detected(i)) continue;
    ImageGrain grain;
    grain.label = found.labels.of(0, i) = i + 1;
    grain.size[0] = {d, d};
    found.grains.push_back(grain);
  }
  return measure_bias({{&found, &truth}}, SizeModel::sphere);
}

TEST(ImageBias, HasNoLimitThatTheKnownGrainsDoNotTell) {
  // Not a single one, a third of all sizes, large ones less than small ones.
  EXPECT_FALSE(bias_where([](int) { return false; }).limit);
  EXPECT_FALSE(bias_where([](int i) { return i % 3 == 0; }).limit);
  EXPECT_FALSE(bias_where([](int i) { return i < 7; }).limit);
  const auto step = bias_where([](int i) { return i >= 7; }).limit;  // between 0.40 and 0.45 m
  ASSERT_TRUE(step);
  EXPECT_NEAR(*step, 0.425, 0.025);
}

TEST(ImageBias, IsThatOfTheRegionAlone) {
  // Every grain of the region is found, and none beyond it, where nobody looked.
  const ImageBias bias = bias_where([](int i) { return i < 10; }, {{0, 0}, {9, 0}, {9, 9}, {0, 9}});
  EXPECT_EQ(bias.limit, 0);
  int visible = 0;
  for (const BiasClass& size : bias.classes) visible += size.visible;
  EXPECT_EQ(visible, 10);
}

TEST(VirtualPhoto, ARegionIsHeldAgainstItsOwnRock) {
  const Photo photo = photo_of(GrainLayout::apart, 0.35, kSuns[0]);
  const int width = photo.picture.cols, height = photo.picture.rows;
  PhotoAnalysisSettings settings = for_spheres();
  settings.sections = 1;
  settings.region = {{width / 8, height / 8}, {7 * width / 8, height / 8}, {width / 2, 7 * height / 8}};
  const PhotoAnalysis found = analyse_photo(photo.picture, settings);
  const TruthCheck check = check_against_truth(found, photo.truth, settings);
  EXPECT_LT(check.known[0].grains, 0.5 * static_cast<double>(photo.truth.grains.size()));
  // Those that the border cuts are not taken for missed ones.
  const ImageBias bias = measure_bias({{&found, &photo.truth}}, SizeModel::sphere);
  for (const BiasClass& size : bias.classes) {
    if (size.low < 0.2) continue;
    EXPECT_GE(size.detected, 0.9 * size.visible) << size.low;
  }
}

TEST(Scene, FollowsItsGradingAndLiesApart) {
  SceneSettings settings;
  settings.coverage = 0.3;
  const RockScene scene = make_scene(rock(), settings);
  std::vector<double> diameters, masses;
  for (const Grain& grain : scene.grains) {
    diameters.push_back(grain.diameter);
    masses.push_back(grain.mass);
  }
  const PassingCurve curve(diameters, masses);
  const Grading wanted = rock();
  for (const Grading::Point& point : wanted.points())
    EXPECT_NEAR(curve.passing(point.diameter), point.passing, 0.06);
  double nearest = 1e9;
  for (std::size_t i = 0; i < scene.grains.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      nearest = std::min(nearest, (scene.grains[i].position - scene.grains[j].position).head<2>().norm() -
                                      (diameters[i] + diameters[j]) / 2);
  EXPECT_GE(nearest, 0.05);
}

// chi that the density 1 + s (2p - 1)(2t - 1) of mass gives at a share t of the height: the mean of log d is
// off that of all by s (2t - 1) times the integral of log d(p) (2p - 1) over p.
double chi_due(const Grading& grading, double segregation, double t) {
  constexpr int kSteps = 20000;
  double all = 0, coarsest = 0, moment = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double p = (k + 0.5) / kSteps, log = std::log(grading.diameter(p)) / kSteps;
    all += log, moment += log * (2 * p - 1);
    if (p > 0.75) coarsest += 4 * log;
  }
  return segregation * (2 * t - 1) * moment / (coarsest - all);
}

std::vector<double> chi_of(const std::vector<ImageGrading>& gradings) {
  std::vector<double> chi;
  for (std::size_t k = 1; k < gradings.size(); ++k) chi.push_back(gradings[k].chi);
  return chi;
}

struct Laid {
  GrainLayout layout;
  double coverage;
};
class Segregated : public testing::TestWithParam<Laid> {};

TEST_P(Segregated, HoldsInEveryPicture) {
  // The whole grading, few blocks of which hold a quarter of the mass, and a picture of the program's size.
  const Grading grading = read_grading(SCREE_TEST_ASSETS "/gradings/CM0.csv");
  SceneSettings settings;
  settings.layout = GetParam().layout;
  settings.coverage = GetParam().coverage;
  settings.width = 19.2, settings.height = 14.4;
  settings.target_margin = 0.675;
  for (const double segregation : {0.0, 0.5, 1.0, -0.5})
    for (settings.seed = 1; settings.seed <= 3; ++settings.seed) {
      SCOPED_TRACE(testing::Message() << "segregation " << segregation << ", seed " << settings.seed);
      settings.segregation = segregation;
      const RockScene scene = make_scene(grading, settings);
      std::vector<double> diameters, masses;
      std::vector<int> section;
      for (const Grain& grain : scene.grains) {
        diameters.push_back(grain.diameter), masses.push_back(grain.mass);
        section.push_back(static_cast<int>(grain.position.y() / settings.height * 6));
      }
      const std::vector<double> chi = chi_of(gradings_of(diameters, masses, section, 6));
      // One block may be a third of the mass of a section: chi cannot be met more closely.
      for (std::size_t k = 0; k < 6; ++k)
        EXPECT_NEAR(chi[k], chi_due(grading, segregation, (static_cast<double>(k) + 0.5) / 6), 0.15)
            << "S" << k + 1;
    }
}
INSTANTIATE_TEST_SUITE_P(Scene, Segregated,
                         testing::Values(Laid{GrainLayout::apart, 0.35}, Laid{GrainLayout::touching, 0.5},
                                         Laid{GrainLayout::overlapping, 1.5}));

TEST(VirtualPhoto, ShowsTheSegregationAskedFor) {
  // Of what can be seen, hidden grains left out; at a scale of 3 cm/px, 9 cm2 a pixel.
  for (const auto& [layout, coverage] : {Laid{GrainLayout::apart, 0.35}, Laid{GrainLayout::touching, 0.5},
                                         Laid{GrainLayout::overlapping, 1.5}})
    for (const double sign : {-1.0, 1.0})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(layout) << ", " << sign << ", seed " << seed);
        SceneSettings settings;
        settings.layout = layout, settings.coverage = coverage;
        settings.width = 19.2, settings.height = 14.4;
        settings.segregation = 0.5 * sign;
        settings.seed = seed;
        PhotoSettings camera;
        camera.m_per_px = 0.03;
        const Photo photo =
            render_photo(make_scene(read_grading(SCREE_TEST_ASSETS "/gradings/CM0.csv"), settings), camera);
        const std::vector<double> chi =
            chi_of(true_gradings(photo.truth, PhotoRegion(photo.picture.size(), {}), {}));
        EXPECT_GT(sign * (chi[5] - chi[0]), 0.2);                    // due: 0.37
        EXPECT_GT(sign * (chi[4] + chi[5] - chi[0] - chi[1]), 0.3);  // due: 0.59
      }
}

TEST(Scene, RefusesWhatDoesNotFit) {
  SceneSettings settings;
  settings.width = settings.height = 1;
  EXPECT_THROW(make_scene(rock(), settings), std::invalid_argument);
  settings.width = settings.height = 8;
  settings.coverage = 0.95;  // more than discs apart can cover
  EXPECT_THROW(make_scene(rock(), settings), std::invalid_argument);
}

TEST(Scene, OfAPileIsSeenFromTheToe) {
  // Two balls on a slope of 45 degrees towards +x; one stands at +y, which is on the right of who looks up
  // it.
  std::vector<Grain> pile(2);
  pile[0] = {.id = 1, .position = {0, 0, 10}, .diameter = 1, .mass = 1};
  pile[1] = {.id = 2, .position = {5, 3, 5}, .diameter = 1, .mass = 1};
  const RockScene scene = view_of_slope(pile, {}, 45, 1);
  EXPECT_NEAR(scene.grains[1].position.x() - scene.grains[0].position.x(), 3, 1e-9);
  EXPECT_NEAR(scene.grains[1].position.y() - scene.grains[0].position.y(), std::sqrt(50.0), 1e-9);
  EXPECT_NEAR(scene.grains[1].position.z(), scene.grains[0].position.z(), 1e-9);
  EXPECT_NEAR(scene.grains[0].position.y(), 1.5, 1e-9);  // half a diameter and the margin
  EXPECT_NEAR(scene.width, 3 + 1 + 2, 1e-9);
}

// A pile on a slope of 35 degrees from a crest of 10 m, rock on the bench's top and on the floor.
std::vector<Grain> pile_on_a_slope() {
  const double fall = std::tan(35 * M_PI / 180), toe = 10 / fall, d = 0.4;
  std::vector<Grain> pile;
  for (double x = -6; x < toe + 6; x += 0.3)
    for (double y = -6; y <= 6; y += 0.35) {
      const double surface = std::clamp(10 - x * fall, 0.0, 10.0);
      // Its top lies on the surface along the normal.
      const double z = surface - (x > 0 && x < toe ? d / 2 / std::cos(35 * M_PI / 180) : d / 2);
      pile.push_back({.id = static_cast<std::int64_t>(pile.size()) + 1,
                      .position = {x, y, z},
                      .diameter = d,
                      .mass = 100});
    }
  return pile;
}

TEST(SlopeRegion, IsWhereTheRunHasItsSections) {
  const std::vector<Grain> pile = pile_on_a_slope();
  const auto slope = slope_of_pile(pile, 10);
  ASSERT_TRUE(slope);
  EXPECT_NEAR(slope->angle, 35, 1);
  EXPECT_NEAR(slope->crest_x, 0, 0.4);
  EXPECT_NEAR(slope->toe_x, 10 / std::tan(35 * M_PI / 180), 0.4);
  const RockScene scene = view_of_slope(pile, {}, slope->angle, 0.5);
  const double m_per_px = 0.02;
  const auto corners = slope_region(scene, *slope, m_per_px);
  ASSERT_TRUE(corners);
  const auto [left, top, right, bottom] = *corners;
  EXPECT_EQ(left, 0);
  EXPECT_NEAR(right, scene.width / m_per_px, 1.5);
  // Sections by height in the picture's region are those by height in the pile, but for grains at borders.
  const PhotoRegion region(
      {static_cast<int>(scene.width / m_per_px), static_cast<int>(scene.height / m_per_px)},
      {{left, top}, {right, top}, {right, bottom}, {left, bottom}});
  int on_slope = 0, same = 0;
  for (std::size_t i = 0; i < pile.size(); ++i) {
    const Vec3& at = pile[i].position;
    if (at.x() < 0.3 || at.x() > slope->toe_x - 0.3) continue;
    ++on_slope;
    const double y = scene.grains[i].position.y() / m_per_px;
    const double surface = 10 - at.x() * std::tan(35 * M_PI / 180);
    same += section_of(y, region, 5) == std::min(4, static_cast<int>((10 - surface) / 2));
  }
  EXPECT_GT(on_slope, 1000);
  EXPECT_GT(same, 0.85 * on_slope);
  // Nothing is known of the bench: from the surface at its highest, which is the same here.
  const auto fitted = slope_of_pile(pile, std::nullopt);
  ASSERT_TRUE(fitted);
  EXPECT_NEAR(fitted->crest_z, 10, 0.3);
  // A pile that falls towards -x has none.
  std::vector<Grain> mirrored = pile;
  for (Grain& grain : mirrored) grain.position.x() *= -1;
  EXPECT_FALSE(slope_of_pile(mirrored, 10));
}

}  // namespace
}  // namespace scree
