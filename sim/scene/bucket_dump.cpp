// Buckets emptied one after another over the edge of a wall: the laboratory segregation test.
//
// A bucket is held with its mouth down, its lip at the upper edge of the wall, and closed by a lid; the lid
// goes, the rock slides out and falls along the wall. A half cone grows against the wall, x > 0.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/scene/dump_loads.h"
#include "sim/scene/stage.h"

namespace scree {
namespace {

constexpr double kSettle = 0.3;      // s that a load lies behind the lid
constexpr double kLid = 0.02;        // thickness of the lid, m
constexpr double kClearance = 0.01;  // of the lip from the wall, m
constexpr double kAcceleration = 1;  // m/s2, of a bucket that is lifted with rock in it
constexpr double kSpeed = 0.5;       // m/s, of it

// Bucket frame: z from its bottom to its mouth. Tilted by `tilt_deg` to the horizontal, mouth down and away
// from the wall, the lowest point of its mouth at the wall's edge.
Pose bucket_pose(const BucketDump& e) {
  const double turn = std::numbers::pi / 2 + e.tilt_deg * std::numbers::pi / 180;
  Pose pose;
  pose.rotation = Quaternion(Eigen::AngleAxisd(turn, Vec3::UnitY()));
  pose.position = Vec3(kClearance, 0, e.wall_height) - pose.rotation * Vec3(0.5 * e.diameter, 0, e.height);
  return pose;
}

}  // namespace

RunOutcome run_bucket_dump(const Scenario& scenario, const BucketDump& e, std::uint64_t seed, int threads,
                           const RunHooks& hooks) {
  const double r = e.floor_radius, back = e.diameter + e.height;
  Stage stage(scenario, seed, threads, hooks, {-back, -r, -0.5 * e.wall_height},
              {r, r, 2 * e.wall_height + 3 * e.height + e.diameter});
  RockWorld& world = stage.world();
  const Pose pose = bucket_pose(e);
  const DumpLoads loads =
      make_dump_loads(scenario, e.mass, std::vector<Pose>(static_cast<std::size_t>(e.buckets), pose),
                      {{e.diameter, 0, e.height}}, seed);
  for (const double height : loads.heights)
    if (height > e.height)
      throw std::invalid_argument(
          fmt::format("{} kg need a bucket {:.2f} m high, it is {} m", e.mass, height, e.height));
  stage.begin({}, loads.spheres);
  const Surface ground = stage.ground_surface(e.floor_mu, e.floor_mu_r);
  world.add_mesh(make_box({-back, -r, -0.2 * r}, {r, r, 0}), ground, Motion());
  world.add_mesh(make_box({-back, -r, 0}, {0, r, e.wall_height}), ground, Motion());
  stage.add_tools();

  const Surface surface = stage.tool_surface(e.container_mu, e.container_mu_r);
  const TriangleMesh bucket_mesh = stage.read(e.container_mesh, e.scale);
  for (int dump = 1; dump <= e.buckets; ++dump) {
    const double share = static_cast<double>(dump - 1) / e.buckets, part = 1.0 / e.buckets;
    stage.set_dump(dump, e.buckets);
    const int bucket = world.add_mesh(bucket_mesh, surface, Motion::fixed(pose));
    const double wide = 0.6 * e.diameter;
    const int lid = world.add_mesh(make_box({-wide, -wide, e.height}, {wide, wide, e.height + kLid}), surface,
                                   Motion::fixed(pose));
    stage.add_load();
    if (!stage.advance(kSettle, "settling", share, share + 0.1 * part)) return stage.finish();
    world.remove_mesh(lid);
    if (!stage.advance_to_rest("emptying", share + 0.1 * part, share + part)) return stage.finish();
    const Departure leaves{bucket, pose, Vec3(0, 0, e.height), kAcceleration, kSpeed, [&](const Vec3& place) {
                             const Vec3 here = pose.to_local(place);
                             return here.z() >= 0 && here.z() <= e.height &&
                                    std::hypot(here.x(), here.y()) <= 0.5 * e.diameter;
                           }};
    if (!stage.leave_with_tool(leaves, share + part, share + part)) return stage.finish();
    world.remove_mesh(bucket);
    if (!stage.advance_to_rest("bucket leaves", share + part, share + part)) return stage.finish();
    stage.dump_done(dump, e.buckets);
  }
  return stage.finish();
}

}  // namespace scree
