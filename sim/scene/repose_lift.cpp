// Rock in a container that is lifted: the repose angle test.
#include <cmath>

#include "sim/material/grading.h"
#include "sim/scene/ground.h"
#include "sim/scene/load.h"
#include "sim/scene/stage.h"

namespace scree {

RunOutcome run_repose_lift(const Scenario& scenario, const ReposeLift& e, std::uint64_t seed, int threads,
                           const RunHooks& hooks) {
  const double r = e.floor_radius;
  const EffectiveModel model = effective_model(scenario);
  const std::vector<double> diameters =
      generate_diameters(model.grading, e.mass, density_of(model.material), seed, 1);
  const double floor = ball_radius(e.base_layer, e.ball_diameter);  // the container stands on the balls
  const Load load = fill_region({{e.diameter, 0, e.height}}, diameters, seed, 1, model.changes.clumps);
  const double lift = e.height + 2.0 * diameters.front();
  Stage stage(scenario, seed, threads, hooks, {-r, -r, -0.5 * e.height},
              {r, r, floor + 4.0 * std::max(load.height, lift)});
  RockWorld& world = stage.world();

  std::vector<NewSphere> spheres;
  for (std::size_t k = 0; k < diameters.size(); ++k)
    spheres.push_back({.position = load.positions[k] + Vec3(0, 0, floor),
                       .diameter = diameters[k],
                       .dump = 1,
                       .axis = load.axes.empty() ? Vec3::Zero() : load.axes[k]});
  stage.begin(make_floor_layer(r, e.base_layer, e.ball_diameter, seed), {spheres});
  world.add_mesh(make_box({-r, -r, -0.2 * r}, {r, r, 0}), stage.ground_surface(e.floor_mu, e.floor_mu_r),
                 Motion());
  stage.add_tools();

  const Surface wall = stage.tool_surface(e.container_mu, e.container_mu_r);
  Pose rest;
  rest.position = {0, 0, floor};
  const int container = world.add_mesh(stage.read(e.container_mesh, e.scale), wall, Motion::fixed(rest));
  // A loose load stands higher than the container; a guard of the same width holds it until it has settled.
  const int guard = load.height > e.height
                        ? world.add_mesh(make_tube(0.5 * e.diameter, 0.05 * e.diameter, e.height,
                                                   load.height + 0.2 * e.height, 64),
                                         wall, Motion::fixed(rest))
                        : -1;
  stage.set_dump(1, 1);
  stage.add_load();
  if (!stage.advance_to_rest("settling", 0.0, 0.35)) return stage.finish();
  if (guard >= 0) world.remove_mesh(guard);

  const double start = world.time(), seconds = lift / e.lift_velocity;
  Pose up = rest;
  up.position.z() += lift;
  world.set_mesh_motion(container, Motion({{start, rest}, {start + seconds, up}}));
  if (!stage.advance(seconds, "lifting", 0.35, 0.7)) return stage.finish();
  world.remove_mesh(container);
  if (!stage.advance_to_rest("coming to rest", 0.7, 1.0)) return stage.finish();
  return stage.finish();
}

}  // namespace scree
