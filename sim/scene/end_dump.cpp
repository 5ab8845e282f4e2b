// Truck loads over the crest of a bench.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/scene/dump_loads.h"
#include "sim/scene/ground.h"
#include "sim/scene/stage.h"

namespace scree {
namespace {

constexpr double kGuardWall = 0.3;     // thickness of the guard that holds a heaped load while it settles, m
constexpr double kAcceleration = 0.5;  // m/s2, of a truck that drives off with rock in its bed
constexpr double kSpeed = 2;           // m/s, of it
constexpr double kBedLeaves = 0.5;     // s given to rock that leans on the truck when it drives off
constexpr double kHoistPause = 2.0;    // s that the bed stays up after hoisting

Quaternion tilt(double degrees) {
  return Quaternion(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Vec3::UnitY()));
}

Pose truck_pose(const EndDump& e, double y, double tilt_deg) {
  return {{-e.truck.setback, y, e.bench.height + e.truck.drop_height}, tilt(tilt_deg)};
}

// What lies in the bed, up to `height` (m) over its floor.
auto in_bed(const Pose& bed, const Vec3& box, double height) {
  return [=](const Vec3& place) {
    const Vec3 here = bed.to_local(place);
    return here.x() >= -box.x() && here.x() <= 0 && std::abs(here.y()) <= 0.5 * box.y() && here.z() >= 0 &&
           here.z() <= height;
  };
}

// Walls above the sides of the bed, in the bed's frame, for a load that is heaped.
std::vector<TriangleMesh> guard(const Vec3& box, double height) {
  const double l = box.x(), h = 0.5 * box.y(), t = kGuardWall, low = box.z(), high = height + 1.0;
  return {make_box({-l - t, -h - t, low}, {-l, h + t, high}), make_box({0, -h - t, low}, {t, h + t, high}),
          make_box({-l, -h - t, low}, {0, -h, high}), make_box({-l, h, low}, {0, h + t, high})};
}

// How far a truck with rock in its bed drives, m: the length of the bed, less where its lip would come so
// near to the end of the bench top that what falls from it is lost.
double way_off(const EndDump& e) {
  constexpr double kMargin = 2;  // m
  return std::clamp(e.bench.top_length - e.truck.setback - kMargin, 0.0, e.truck.load_box.x());
}

}  // namespace

RunOutcome run_end_dump(const Scenario& scenario, const EndDump& e, std::uint64_t seed, int threads,
                        const RunHooks& hooks) {
  const double toe = toe_of(e.bench), half = 0.5 * e.bench.width;
  const Vec3 low(-e.bench.top_length - e.truck.load_box.x() - 2, -half - 2, -3);
  const Vec3 high(toe + e.bench.floor_length + 2, half + 2,
                  e.bench.height + e.truck.drop_height + 3 * e.truck.load_box.norm());
  Stage stage(scenario, seed, threads, hooks, low, high);
  RockWorld& world = stage.world();

  const double start_tilt = e.truck.release == Release::hoist ? 0.0 : e.truck.tilt_deg;
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < static_cast<std::size_t>(e.dumps); ++k)
    poses.push_back(truck_pose(e, e.points[k % e.points.size()], start_tilt));
  const DumpLoads loads = make_dump_loads(scenario, e.payload, poses, {e.truck.load_box}, seed);
  stage.begin(make_base_layer(e.bench, seed), loads.spheres);
  world.add_mesh(make_bench(e.bench), stage.ground_surface(), Motion());
  stage.add_tools();

  const TriangleMesh bed_mesh = stage.read(e.truck.bed_mesh, e.truck.scale);
  const TriangleMesh gate_mesh = stage.read(e.truck.gate_mesh, e.truck.scale);
  const Surface surface = stage.tool_surface(e.truck.mu, e.truck.mu_r);
  for (int dump = 1; dump <= e.dumps; ++dump) {
    const Pose& pose = poses[static_cast<std::size_t>(dump - 1)];
    const double y = pose.position.y();
    const double share = static_cast<double>(dump - 1) / e.dumps, part = 1.0 / e.dumps;
    stage.set_dump(dump, e.dumps);
    const int bed = world.add_mesh(bed_mesh, surface, Motion::fixed(pose));
    const int gate = world.add_mesh(gate_mesh, surface, Motion::fixed(pose));
    std::vector<int> walls;
    const double height = loads.heights[static_cast<std::size_t>(dump - 1)];
    if (height > e.truck.load_box.z())
      for (TriangleMesh& wall : guard(e.truck.load_box, height))
        walls.push_back(world.add_mesh(std::move(wall), surface, Motion::fixed(pose)));
    stage.add_load();
    if (!stage.advance(e.truck.settle_s, "settling", share, share + 0.1 * part)) return stage.finish();
    for (const int wall : walls) world.remove_mesh(wall);

    // Beds of mining trucks are open behind: the gate holds the load until it has settled, no longer.
    world.remove_mesh(gate);
    double emptied = share + 0.1 * part;
    if (e.truck.release == Release::open_gate) {
      if (const double speed = stage.changes().release_speed; speed > 0)
        stage.push_load(pose.rotation * Vec3(speed, 0, 0));
    } else {
      const double start = world.time(), seconds = e.truck.tilt_deg / e.truck.hoist_rate_deg;
      world.set_mesh_motion(bed,
                            Motion({{start, pose}, {start + seconds, truck_pose(e, y, e.truck.tilt_deg)}}));
      emptied = share + 0.6 * part;
      if (!stage.advance(seconds + kHoistPause, "hoisting", share + 0.1 * part, emptied))
        return stage.finish();
    }
    if (!stage.advance_to_rest("dumping", emptied, share + 0.95 * part)) return stage.finish();
    const Pose tilted = truck_pose(e, y, e.truck.tilt_deg);
    const Departure truck{
        bed,           tilted, Vec3(-way_off(e), 0, 0),
        kAcceleration, kSpeed, in_bed(tilted, e.truck.load_box, std::max(height, e.truck.load_box.z()))};
    if (!stage.leave_with_tool(truck, share + 0.95 * part, share + 0.95 * part)) return stage.finish();
    world.remove_mesh(bed);
    if (!stage.advance(kBedLeaves, "truck leaves", share + 0.95 * part, share + part)) return stage.finish();
    if (!stage.advance_to_rest("truck leaves", share + part, share + part)) return stage.finish();
    stage.dump_done(dump, e.dumps);
  }
  return stage.finish();
}

}  // namespace scree
