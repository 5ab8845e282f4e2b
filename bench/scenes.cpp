#include "bench/scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "sim/material/grading.h"
#include "sim/scene/ground.h"
#include "sim/scene/load.h"

namespace scree::bench {
namespace {

constexpr double kDensity = 2760.0;  // kg/m3
constexpr double kBucket = 0.35;     // diameter of the laboratory bucket, m
constexpr double kBucketHeight = 0.60;
constexpr double kLift = 0.5;  // m/s
constexpr std::uint64_t kSeed = 10001;

std::vector<double> diameters(const char* grading, double mass) {
  const auto file = std::filesystem::path(SCREE_ASSETS) / "gradings" / (std::string(grading) + ".csv");
  return generate_diameters(read_grading(file), mass, kDensity, kSeed, 1);
}

WorldSettings world_settings(double mu, const SceneSettings& s) {
  WorldSettings settings;
  settings.material.mu = settings.material.mu_r = mu;
  settings.fixed_time_step = s.time_step;
  settings.sleep = s.sleep;
  settings.threads = s.threads;
  return settings;
}

// Floor of the laboratory and the bucket, as tall as the packing needs.
void add_lab_meshes(RockWorld& world, double height, const Motion& motion) {
  const Surface rock{0.2, 0.2};
  world.add_mesh(make_box({-3, -3, -0.5}, {3, 3, 0}), rock, Motion());
  world.add_mesh(make_tube(0.5 * kBucket, 0.02, 0.0, height, 64), rock, motion);
}

BenchSpec field_bench() {
  BenchSpec bench;
  bench.height = 14;
  bench.top_length = 10;
  bench.floor_length = 60;
  bench.width = 80;
  return bench;
}

double heap_width(const Packing& packing) {
  double x = 0;
  for (const NewSphere& s : packing) x = std::max(x, -s.position.x() + 0.5 * s.diameter);
  return x;
}

}  // namespace

Packing lab_packing(double mass, double bucket_height) {
  const Load load = fill_region({{kBucket, 0, bucket_height}}, diameters("Lab0", mass), kSeed, 1);
  const std::vector<double> d = diameters("Lab0", mass);
  Packing packing;
  for (std::size_t k = 0; k < d.size(); ++k) {
    NewSphere s;
    s.position = load.positions[k];
    s.diameter = d[k];
    s.dump = 1;
    packing.push_back(s);
  }
  WorldSettings settings = world_settings(0.2, {});
  const auto world = make_rrlinear_world(settings);
  world->add_spheres(packing);
  add_lab_meshes(*world, load.height + 0.1, Motion());
  do {
    world->advance_to(world->time() + 0.1);
  } while (world->time() < 5.0 && (world->time() < 1.0 || world->moving_mass_share(0.005) > 0));
  const Snapshot at_rest = world->snapshot();
  packing.clear();
  for (const Grain& g : at_rest.grains) {
    NewSphere s;
    s.position = g.position;
    s.diameter = g.diameter;
    s.dump = 1;
    packing.push_back(s);
  }
  return packing;
}

Packing field_packing(double mass) {
  const std::vector<double> d = diameters("QB0", mass);
  const double width = 8.0, length = 24.0;
  const Load load = fill_region({{width, length, 4.0}}, d, kSeed, 1);
  Packing packing;
  for (const NewSphere& ball : make_base_layer(field_bench(), kSeed))
    if (ball.position.x() > -2.0 && ball.position.x() < 50.0 && std::abs(ball.position.y()) < 25.0)
      packing.push_back(ball);
  for (std::size_t k = 0; k < d.size(); ++k) {
    NewSphere s;
    s.position = load.positions[k] + Vec3(width + 0.5, 0, field_bench().height + 1.5);
    s.diameter = d[k];
    s.dump = 1;
    packing.push_back(s);
  }
  return packing;
}

Packing heap_packing(int count) {
  // About 7.7 spheres of QB0 a tonne.
  const std::vector<double> d = diameters("QB0", 1000.0 * count / 7.7);
  double volume = 0;
  for (const double x : d) volume += std::numbers::pi / 6.0 * x * x * x;
  const double width = std::max(std::cbrt(volume / 0.35), 6.0);
  const Load load = fill_region({{width, width, volume / 0.4 / width / width}}, d, kSeed, 1);
  Packing packing;
  for (std::size_t k = 0; k < d.size(); ++k) {
    NewSphere s;
    s.position = load.positions[k];
    s.diameter = d[k];
    s.dump = 1;
    packing.push_back(s);
  }
  return packing;
}

void write_packing(const Packing& packing, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << "x_m,y_m,z_m,diameter_m,fixed\n";
  for (const NewSphere& s : packing)
    out << fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{}\n", s.position.x(), s.position.y(), s.position.z(),
                       s.diameter, s.fixed ? 1 : 0);
  out.close();
  if (!out) throw std::runtime_error(file.string() + ": cannot be written");
}

Packing read_packing(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line) || line != "x_m,y_m,z_m,diameter_m,fixed")
    throw std::runtime_error(file.string() + ": not a packing; make one with scree_bench pack");
  Packing packing;
  while (std::getline(in, line)) {
    NewSphere s;
    char comma = 0;
    int fixed = 0;
    std::istringstream row(line);
    row >> s.position.x() >> comma >> s.position.y() >> comma >> s.position.z() >> comma >> s.diameter >>
        comma >> fixed;
    if (!row) throw std::runtime_error(fmt::format("{}: bad row '{}'", file.string(), line));
    s.fixed = fixed != 0;
    s.dump = s.fixed ? 0 : 1;
    packing.push_back(s);
  }
  return packing;
}

Packing lifted_above(Packing packing, const Packing& other) {
  constexpr double kGap = 0.3;  // m
  double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300, bottom = 1e300, top = -1e300;
  for (const NewSphere& s : packing) {
    const double r = 0.5 * s.diameter;
    x0 = std::min(x0, s.position.x() - r), x1 = std::max(x1, s.position.x() + r);
    y0 = std::min(y0, s.position.y() - r), y1 = std::max(y1, s.position.y() + r);
    bottom = std::min(bottom, s.position.z() - r);
  }
  for (const NewSphere& s : other) {
    const double r = 0.5 * s.diameter;
    if (s.position.x() + r > x0 && s.position.x() - r < x1 && s.position.y() + r > y0 &&
        s.position.y() - r < y1)
      top = std::max(top, s.position.z() + r);
  }
  for (NewSphere& s : packing) s.position.z() += top + kGap - bottom;
  return packing;
}

std::unique_ptr<RockWorld> make_scene(const std::string& name, const Packing& packing,
                                      const SceneSettings& scene) {
  if (name == "lab") {
    auto world = make_rrlinear_world(world_settings(0.2, scene));
    world->add_spheres(packing);
    double height = kBucketHeight;
    for (const NewSphere& s : packing) height = std::max(height, s.position.z() + s.diameter);
    Pose up;
    up.position.z() = 2.0 * height;
    add_lab_meshes(*world, height, Motion({{0.0, Pose{}}, {2.0 * height / kLift, up}}));
    return world;
  }
  if (name == "field") {
    auto world = make_rrlinear_world(world_settings(0.44, scene));
    world->add_spheres(packing);
    world->add_mesh(make_bench(field_bench()), Surface{}, Motion());
    return world;
  }
  if (name == "heap") {
    auto world = make_rrlinear_world(world_settings(0.44, scene));
    world->add_spheres(packing);
    const double w = heap_width(packing), t = 2.0;
    double high = 0;
    for (const NewSphere& s : packing) high = std::max(high, s.position.z() + s.diameter);
    world->add_mesh(make_box({-w - t, -0.5 * w - t, -2 * t}, {t, 0.5 * w + t, 0}), Surface{}, Motion());
    world->add_mesh(make_box({-w - t, -0.5 * w, -t}, {-w, 0.5 * w, high}), Surface{}, Motion());
    world->add_mesh(make_box({0, -0.5 * w, -t}, {t, 0.5 * w, high}), Surface{}, Motion());
    world->add_mesh(make_box({-w, -0.5 * w - t, -t}, {0, -0.5 * w, high}), Surface{}, Motion());
    world->add_mesh(make_box({-w, 0.5 * w, -t}, {0, 0.5 * w + t, high}), Surface{}, Motion());
    return world;
  }
  throw std::invalid_argument(fmt::format("scene '{}': one of lab, field, heap", name));
}

}  // namespace scree::bench
