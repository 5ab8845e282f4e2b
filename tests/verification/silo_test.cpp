// Janssen's silo (Zeitschrift des Vereines Deutscher Ingenieure 39 (1895) 1045): walls with friction carry
// part of a column of rock. With the pressure p at depth z, dp/dz = rho g - p / lambda, the floor carries of
// the weight M of a column of height H the share (1 - exp(-x)) / x, x = H / lambda: lambda is one length
// for columns of all heights.
#include <algorithm>

#include "tests/verification/meshes.h"

namespace scree::verification {
namespace {

constexpr double kWidth = 1, kRadius = 0.05;  // m
constexpr double kFriction = 0.5;             // of the walls

struct Column {
  double weight = 0, on_floor = 0;  // N
  double height = 0;                // m
};

// Spheres settle between four walls, which then rise slowly, so that friction acts upwards all along them.
Column column(int layers, double wall_friction) {
  WorldSettings settings;
  settings.sleep = false;
  settings.material.mu = 0.4;
  settings.material.mu_r = 0.1;
  RrlinearWorld world(settings);
  Random random(3, 0, RandomPurpose::positions);
  std::vector<NewSphere> rock;
  constexpr int kAcross = 8;
  const double cell = kWidth / kAcross;
  for (int k = 0; k < layers; ++k)
    for (int i = 0; i < kAcross; ++i)
      for (int j = 0; j < kAcross; ++j) {
        const double radius = kRadius * random.uniform(0.85, 1.15);
        const auto at = [&](int n) {
          return (n + 0.5) * cell - 0.5 * kWidth + random.uniform(-1, 1) * (0.5 * cell - radius);
        };
        const double x = at(i), y = at(j);
        rock.push_back(ball({x, y, (k + 0.5) * cell}, radius));
      }
  world.add_spheres(rock);
  add_floor(world, {0.4, 0.1});
  MeshMaker walls;
  const double half = 0.5 * kWidth, height = 2 + layers * cell;
  const Vec3 up(0, 0, height), low(0, 0, -0.5);
  walls.patch(low + Vec3(-half, -half, 0), {kWidth, 0, 0}, up, 1, 1);
  walls.patch(low + Vec3(half, -half, 0), {0, kWidth, 0}, up, 1, 1);
  walls.patch(low + Vec3(half, half, 0), {-kWidth, 0, 0}, up, 1, 1);
  walls.patch(low + Vec3(-half, half, 0), {0, -kWidth, 0}, up, 1, 1);
  constexpr double kSettled = 2, kRisen = 4, kSpeed = 0.005;
  Pose risen;
  risen.position = {0, 0, kSpeed * (kRisen - kSettled)};
  world.add_mesh(walls.mesh(), {wall_friction, 0},
                 Motion({{0, Pose{}}, {kSettled, Pose{}}, {kRisen, risen}}));
  Column result;
  constexpr int kReadings = 20;
  for (int reading = 0; reading < kReadings; ++reading) {
    world.advance_to(kRisen - 1 + 1.0 * reading / kReadings);
    for (const Grain& g : world.snapshot().grains) {
      const double r = 0.5 * g.diameter, overlap = r - g.position.z();
      if (overlap > 0) result.on_floor += wall_stiffness(settings.material, r) * overlap / kReadings;
      result.height = std::max(result.height, g.position.z());
      result.weight += ball_mass(settings.material, r) * kGravity / kReadings;
    }
  }
  return result;
}

// What a floor carries of a column x times as high as lambda.
double share(double x) {
  return (1 - std::exp(-x)) / x;
}

TEST(Silo, PressureSaturatesAsJanssensDoes) {
  const Column smooth = column(20, 0), low = column(20, kFriction), high = column(40, kFriction);
  EXPECT_NEAR(smooth.on_floor, smooth.weight, 1e-3 * smooth.weight) << "without friction all of it";
  double x = 1;  // of the low column, by Newton's method
  for (int k = 0; k < 20; ++k) {
    const double slope = (std::exp(-x) - share(x)) / x;
    x -= (share(x) - low.on_floor / low.weight) / slope;
  }
  const double foretold = share(x * high.weight / low.weight);
  // Six seeds: 0 to 5 % below.
  EXPECT_NEAR(high.on_floor / high.weight, foretold, 0.07 * foretold);
  EXPECT_LT(high.on_floor / high.weight, 0.75 * low.on_floor / low.weight);
  // lambda = width / (4 friction K), K the pressure sideways over that downwards: between that of rock that
  // yields (Rankine, at most 45 degrees) and that of a fluid.
  const double ratio = x * kWidth / (4 * kFriction * low.height);
  EXPECT_GT(ratio, 0.17);
  EXPECT_LT(ratio, 1);
}

}  // namespace
}  // namespace scree::verification
