#include "sim/scene/ground.h"

#include <cmath>
#include <numbers>

#include "sim/material/random.h"

namespace scree {
namespace {

constexpr double kDepth = 5.0;  // of the solid below the floor, m

double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}

// Balls of diameter d of one row of the layer, along y through (x, z) on the surface; (tx, tz) is the
// direction of steepest descent.
void add_row(std::vector<NewSphere>& balls, double x, double z, double tx, double tz, double half_width,
             bool shifted, BaseLayer layer, double d, Random& random) {
  const auto add = [&](const Vec3& position, double diameter) {
    NewSphere ball;
    ball.position = position;
    ball.diameter = diameter;
    ball.fixed = true;
    balls.push_back(ball);
  };
  for (double y = -half_width + (shifted ? 1.0 : 0.5) * d; y <= half_width - 0.25 * d; y += d) {
    if (layer == BaseLayer::homogeneous || random.uniform() < 0.5) {
      add({x, y, z}, d);
      continue;
    }
    for (const double along : {-0.25 * d, 0.25 * d})
      for (const double across : {-0.25 * d, 0.25 * d})
        add({x + along * tx, y + across, z + along * tz}, 0.5 * d);
  }
}

void add_quad(TriangleMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

}  // namespace

double toe_of(const BenchSpec& bench) {
  return bench.height / std::tan(radians(bench.slope_deg));
}

double ball_radius(BaseLayer layer, double diameter) {
  return layer == BaseLayer::none ? 0.0 : 0.5 * diameter;
}

double standing_height(const BenchSpec& b) {
  return b.height + (b.layer_on_top ? ball_radius(b.base_layer, b.ball_diameter) : 0.0);
}

TriangleMesh make_bench(const BenchSpec& b) {
  const double toe = toe_of(b), half = 0.5 * b.width;
  // Surface profile from the back of the top to the end of the floor, and the same below.
  const double x[] = {-b.top_length, 0.0, toe, toe + b.floor_length};
  const double z[] = {b.height, b.height, 0.0, 0.0};
  TriangleMesh mesh;
  mesh.name = "bench";
  for (const double y : {-half, half})
    for (int k = 0; k < 4; ++k) {
      mesh.vertices.push_back({x[k], y, z[k]});
      mesh.vertices.push_back({x[k], y, -kDepth});
    }
  const auto top = [](int k, int side) { return 8 * side + 2 * k; };
  const auto bottom = [](int k, int side) { return 8 * side + 2 * k + 1; };
  for (int k = 0; k < 3; ++k) {
    add_quad(mesh, top(k, 0), top(k + 1, 0), top(k + 1, 1), top(k, 1));
    add_quad(mesh, bottom(k, 0), bottom(k, 1), bottom(k + 1, 1), bottom(k + 1, 0));
    add_quad(mesh, bottom(k, 0), bottom(k + 1, 0), top(k + 1, 0), top(k, 0));
    add_quad(mesh, bottom(k, 1), top(k, 1), top(k + 1, 1), bottom(k + 1, 1));
  }
  add_quad(mesh, bottom(0, 0), top(0, 0), top(0, 1), bottom(0, 1));
  add_quad(mesh, bottom(3, 0), bottom(3, 1), top(3, 1), top(3, 0));
  update_closed(mesh);
  return mesh;
}

std::vector<NewSphere> make_base_layer(const BenchSpec& b, std::uint64_t seed) {
  std::vector<NewSphere> balls;
  if (b.base_layer == BaseLayer::none) return balls;
  Random random(seed, 0, RandomPurpose::base_layer);
  const double angle = radians(b.slope_deg), slope = b.height / std::sin(angle), half = 0.5 * b.width;
  const double d = b.ball_diameter, pitch = d * std::sqrt(0.75);
  // Rows at equal distances along the surface, one of them on the crest.
  const int first = b.layer_on_top ? -static_cast<int>((b.top_length - 0.5 * d) / pitch) : 1;
  const int last = static_cast<int>((slope + b.floor_length - 0.5 * d) / pitch);
  for (int row = first; row <= last; ++row) {
    const double s = row * pitch;
    const bool shifted = row % 2 != 0;
    if (s < 0)
      add_row(balls, s, b.height, 1, 0, half, shifted, b.base_layer, d, random);
    else if (s < slope)
      add_row(balls, s * std::cos(angle), b.height - s * std::sin(angle), std::cos(angle), -std::sin(angle),
              half, shifted, b.base_layer, d, random);
    else
      add_row(balls, toe_of(b) + s - slope, 0, 1, 0, half, shifted, b.base_layer, d, random);
  }
  return balls;
}

std::vector<NewSphere> make_floor_layer(double half_width, BaseLayer layer, double diameter,
                                        std::uint64_t seed) {
  std::vector<NewSphere> balls;
  if (layer == BaseLayer::none) return balls;
  Random random(seed, 0, RandomPurpose::base_layer);
  const double pitch = diameter * std::sqrt(0.75);
  bool shifted = false;
  for (double x = -half_width + 0.5 * diameter; x <= half_width - 0.5 * diameter;
       x += pitch, shifted = !shifted)
    add_row(balls, x, 0, 1, 0, half_width, shifted, layer, diameter, random);
  return balls;
}

double estimated_balls(double area, BaseLayer layer, double diameter) {
  if (layer == BaseLayer::none) return 0;
  const double places = area / (diameter * diameter * std::sqrt(0.75));
  return layer == BaseLayer::mixed ? 2.5 * places : places;  // four balls at half of the places
}

TriangleMesh make_tube(double inner_radius, double wall, double low, double high, int sides) {
  TriangleMesh mesh;
  mesh.name = "tube";
  const double corner = 1.0 / std::cos(std::numbers::pi / sides);
  for (int k = 0; k < sides; ++k) {
    const double a = 2.0 * std::numbers::pi * k / sides, c = std::cos(a) * corner, s = std::sin(a) * corner;
    for (const double r : {inner_radius, inner_radius + wall})
      for (const double z : {low, high}) mesh.vertices.push_back({r * c, r * s, z});
  }
  for (int k = 0; k < sides; ++k) {
    const int a = 4 * k, b = 4 * ((k + 1) % sides);  // inner low, inner high, outer low, outer high
    add_quad(mesh, a, a + 1, b + 1, b);
    add_quad(mesh, a + 2, b + 2, b + 3, a + 3);
    add_quad(mesh, a + 1, a + 3, b + 3, b + 1);
    add_quad(mesh, a, b, b + 2, a + 2);
  }
  update_closed(mesh);
  return mesh;
}

}  // namespace scree
