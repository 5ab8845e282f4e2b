// scree_oblique: what is left of the speed along a plate after an impact, over the angle at which a sphere
// comes.
//
// Chung & Ooi, Granular Matter 13 (2011) 643, test 4: radius 2.5 mm, 3.9 m/s, restitution 0.98, friction
// 0.092. Writes a table to stdout: incidence_deg,stiffness_ratio,tangential_restitution. docs/verification.md
// shows it beside the measurement.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "sim/io/mesh.h"
#include "sim/world/rrlinear_world.h"

namespace scree {
namespace {

constexpr double kRadius = 2.5e-3, kSpeed = 3.9, kFriction = 0.092;  // m, m/s
// Of the critical damping; restitution 0.98 of the oscillator that never pulls (Schwager & Poeschel 2007, eq.
// 21).
constexpr double kDamping = 0.00646;

double tangential_restitution(double incidence, double stiffness_ratio) {
  WorldSettings settings;
  settings.gravity = Vec3::Zero();
  settings.material.density = 4000;
  settings.material.effective_modulus = 1e9;
  settings.material.stiffness_ratio = stiffness_ratio;
  settings.material.local_damping = 0;
  settings.material.normal_damping_ratio = kDamping;
  settings.fixed_time_step = 2e-8;
  RrlinearWorld world(settings);
  NewSphere sphere;
  sphere.position = {0, 0, kRadius + 1e-6};
  sphere.diameter = 2 * kRadius;
  sphere.dump = 1;
  sphere.velocity = {kSpeed * std::sin(incidence), 0, -kSpeed * std::cos(incidence)};
  world.add_spheres({sphere});
  world.add_mesh(make_box({-1, -1, -1}, {1, 1, 0}), {kFriction, 0}, Motion::fixed(Pose{}));
  while (world.spheres().velocity[0].vec().z() < 0 || world.spheres().place[0].z < kRadius)
    world.advance_to(world.time() + settings.fixed_time_step);
  return world.spheres().velocity[0].x / sphere.velocity.x();
}

}  // namespace
}  // namespace scree

int main() {
  fmt::print("incidence_deg,stiffness_ratio,tangential_restitution\n");
  for (const double ratio : {1.15, 2.5})
    for (double incidence = 1; incidence <= 70; incidence += 1)
      fmt::print("{},{},{:.4f}\n", incidence, ratio,
                 scree::tangential_restitution(incidence * std::numbers::pi / 180, ratio));
}
