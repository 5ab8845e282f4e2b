// Loads that are pushed over the crest of a bench.
//
// A load lies on the bench top between two side walls, the blade behind it and a gate before it. It settles,
// the gate opens, the blade advances over the crest. On a base layer load and blade stand on the balls.
#include <array>

#include "sim/scene/dump_loads.h"
#include "sim/scene/ground.h"
#include "sim/scene/stage.h"

namespace scree {
namespace {

constexpr double kWall = 0.3;  // thickness of side walls and gate, m

// The walls around a load but for the blade, in the frame of its box; the gate comes last.
std::array<TriangleMesh, 3> walls(const Vec3& box, double height) {
  const double l = box.x(), h = 0.5 * box.y(), top = std::max(box.z(), height) + 1.0;
  return {make_box({-l, -h - kWall, 0}, {0, -h, top}), make_box({-l, h, 0}, {0, h + kWall, top}),
          make_box({0, -h - kWall, 0}, {kWall, h + kWall, top})};
}

}  // namespace

RunOutcome run_push_dump(const Scenario& scenario, const PushDump& e, std::uint64_t seed, int threads,
                         const RunHooks& hooks) {
  const double toe = toe_of(e.bench), half = 0.5 * e.bench.width;
  const double ground = e.bench.height + ball_radius(e.bench.base_layer);
  const Vec3 low(-e.bench.top_length - 2, -half - 2, -3);
  const Vec3 high(toe + e.bench.floor_length + 2, half + 2, ground + 3 * e.load_box.norm());
  Stage stage(scenario, seed, threads, hooks, low, high);
  RockWorld& world = stage.world();

  const auto box_at = [&](double y) {
    Pose pose;
    pose.position = {-e.distance, y, ground};
    return pose;
  };
  const DumpLoads loads = make_dump_loads(scenario, e.payload, e.dumps, e.points, {e.load_box}, seed, box_at);
  stage.begin(make_base_layer(e.bench, seed), loads.spheres);
  world.add_mesh(make_bench(e.bench), stage.surface({}, {}), Motion());
  stage.add_tools();

  const TriangleMesh blade_mesh = stage.read(e.blade.mesh, e.blade.scale);
  const Surface surface = stage.surface(e.blade.mu, e.blade.mu_r);
  for (int dump = 1; dump <= e.dumps; ++dump) {
    const auto k = static_cast<std::size_t>(dump - 1);
    const double share = static_cast<double>(dump - 1) / e.dumps, part = 1.0 / e.dumps;
    const Pose box = box_at(loads.points[k]);
    Pose behind = box, over = box;
    behind.position.x() -= e.load_box.x();
    over.position.x() = e.blade.overshoot;
    stage.set_dump(dump, e.dumps);
    const int blade = world.add_mesh(blade_mesh, surface, Motion::fixed(behind));
    std::vector<int> sides;
    for (TriangleMesh& wall : walls(e.load_box, loads.heights[k]))
      sides.push_back(world.add_mesh(std::move(wall), surface, Motion::fixed(box)));
    // What stands higher than the box is held from behind until it has settled.
    const double h = 0.5 * e.load_box.y() + kWall;
    const int guard = loads.heights[k] > e.load_box.z()
                          ? world.add_mesh(make_box({-e.load_box.x() - kWall, -h, e.load_box.z()},
                                                    {-e.load_box.x(), h, loads.heights[k] + 1.0}),
                                           surface, Motion::fixed(box))
                          : -1;
    stage.add_load();
    if (!stage.advance(e.settle_s, "settling", share, share + 0.05 * part)) return stage.finish();
    if (guard >= 0) world.remove_mesh(guard);
    world.remove_mesh(sides.back());
    const double seconds = (over.position.x() - behind.position.x()) / e.blade.velocity, start = world.time();
    world.set_mesh_motion(blade, Motion({{start, behind}, {start + seconds, over}}));
    if (!stage.advance(seconds, "pushing", share + 0.05 * part, share + 0.8 * part)) return stage.finish();
    if (!stage.advance_to_rest("coming to rest", share + 0.8 * part, share + 0.9 * part))
      return stage.finish();
    world.remove_mesh(blade);
    world.remove_mesh(sides[0]);
    world.remove_mesh(sides[1]);
    if (!stage.advance_to_rest("blade leaves", share + 0.9 * part, share + part)) return stage.finish();
    stage.dump_done(dump, e.dumps);
  }
  return stage.finish();
}

}  // namespace scree
