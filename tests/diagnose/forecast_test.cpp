#include "analysis/diagnose/forecast.h"

#include <gtest/gtest.h>

#include "tests/diagnose/synthetic.h"

namespace scree {
namespace {

// Errors of variance g (1 + f v): g and f are found; none at all leave them what they usually are.
TEST(Widening, IsWhatTheErrorsSay) {
  EXPECT_EQ(widening({}).scatter, 1);
  EXPECT_NEAR(widening({}).covariance, 1.5, 0.04);
  Random random(1, 0, RandomPurpose::design);
  for (const double scatter : {1.0, 2.0})
    for (const double factor : {1.0, 4.0, 16.0}) {
      std::vector<Forecast> forecasts;
      for (int k = 0; k < 3000; ++k) {
        const double variance = k % 2 == 0 ? 0 : std::pow(10, random.uniform(-2, -0.3));
        const double z = std::sqrt(-2 * std::log(1 - random.uniform())) *
                         std::cos(2 * std::numbers::pi * random.uniform());
        forecasts.push_back({variance, z * z * scatter * (1 + factor * variance)});
      }
      const Widening found = widening(forecasts);
      EXPECT_NEAR(found.scatter, scatter, 0.25 * scatter);
      EXPECT_NEAR(found.covariance, scatter * factor, 0.25 * scatter * factor);
    }
}

// Errors that the scatter of one run explains say nothing of a surface that is sure of itself. Larger ones
// between seeds say that the scatter is larger, and with it what is not known of the surface; between points
// they do not: the surface may be wrong.
TEST(Widening, OfASurfaceKnownWellIsThatOfItsScatter) {
  const Widening as_said = widening(std::vector<Forecast>(50, {1e-6, 1.0}));
  EXPECT_EQ(as_said.scatter, 1);
  EXPECT_NEAR(as_said.covariance, 1.5, 0.04);
  const Widening larger = widening(std::vector<Forecast>(400, {0, 2.0}));
  EXPECT_NEAR(larger.scatter, 2, 0.2);
  EXPECT_NEAR(larger.covariance, 1.5 * larger.scatter, 0.1);
  EXPECT_EQ(widening(std::vector<Forecast>(400, {0.1, 2.0})).scatter, 1);
}

TEST(Widening, IsSmallWhereTheSurfaceIsOfTheKindThatItLearns) {
  const SyntheticWorld world;
  const DesignRuns learnt = world.design(4), fresh = world.design(5);
  for (std::size_t e = 0; e < 2; ++e) {
    const ResponseSurface surface(world.space, world.experiments[e], learnt[e]);
    const std::vector<Forecast> forecasts = surface.forecasts(fresh[e]);
    EXPECT_EQ(forecasts.size(), fresh[e].size() * static_cast<std::size_t>(surface.outputs()));
    EXPECT_LT(widening(forecasts).covariance, 2.0);
    EXPECT_LT(widening(forecasts).scatter, 1.5);
  }
}

// An effect has a narrow peak between two amplitudes that were simulated: nothing in those runs says so.
TEST(Widening, IsLargeWhereTheSurfaceIsSureAndWrong) {
  ModelSpace space;
  space.base = {{"material.mu", 0, -1, 1}};
  space.effects = {{"sticky", "sticky", 0, {{"effects.sticky.size", "", 0, 1}}, {"one"}}};
  Random random(3, 0, RandomPurpose::design);
  const auto run = [&](double base, double x) {
    ModelPoint at{Eigen::VectorXd::Constant(1, base), {}};
    if (x != 0) at.effects.push_back({0, Eigen::VectorXd::Constant(1, x)});
    const double y =
        2 * base + 4 * x + 12 * std::exp(-std::pow((x - 0.55) / 0.02, 2)) + random.uniform(-1, 1);
    return DesignRun{at, Eigen::VectorXd::Constant(1, y)};
  };
  std::vector<DesignRun> learnt, near, far;
  for (int k = 0; k < 20; ++k) learnt.push_back(run(random.uniform(-1, 1), 0));
  for (int k = 1; k <= 10; ++k) learnt.push_back(run(random.uniform(-1, 1), k / 10.0));
  for (int k = 0; k < 12; ++k) {
    near.push_back(run(random.uniform(-1, 1), 0.55));
    far.push_back(run(random.uniform(-1, 1), 0.3));
  }
  const ResponseSurface surface(space, "one", learnt);
  EXPECT_GT(widening(surface.forecasts(near)).covariance, 1.5 * widening(surface.forecasts(far)).covariance);
}

}  // namespace
}  // namespace scree
