// Loads that are pushed over the crest of a bench.
//
// With side walls, as in the thesis, a load lies on the bench top between them, the blade behind it and a
// gate before it. It settles, the gate opens, the blade advances over the crest, up to which the walls reach.
// On a base layer load and blade stand on the balls. Where rock of earlier loads stands, the load lies on it;
// blade and walls are put into it, which the run's notes say.
//
// Without side walls a load falls on the bench top and becomes a heap. The blade cuts at one height after
// another. Each pass begins behind all rock of its lane and goes to the crest; what spills past the blade's
// ends stays beside the lane, and a later pass may take it. The blade returns raised above all rock: that
// moves nothing, so it takes no time here.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "sim/scene/blade_passes.h"
#include "sim/scene/dump_loads.h"
#include "sim/scene/ground.h"
#include "sim/scene/stage.h"

namespace scree {
namespace {

constexpr double kWall = 0.3;  // thickness of side walls and gate, m

// The walls around a load but for the blade, in the frame of its box; the side walls go on to the crest,
// `distance` (m) away; the gate comes last.
std::array<TriangleMesh, 3> walls(const Vec3& box, double height, double distance) {
  const double l = box.x(), h = 0.5 * box.y(), top = std::max(box.z(), height) + 1.0;
  return {make_box({-l, -h - kWall, 0}, {distance, -h, top}),
          make_box({-l, h, 0}, {distance, h + kWall, top}),
          make_box({0, -h - kWall, 0}, {kWall, h + kWall, top})};
}

// Part of the whole run, for progress.
struct Part {
  double begin, length;
  double at(double share) const { return begin + share * length; }
};

class Pushing {
 public:
  Pushing(Stage& stage, const PushDump& e)
      : stage_(stage),
        world_(stage.world()),
        e_(e),
        ground_(standing_height(e.bench)),
        mesh_(stage.read(e.blade.mesh, e.blade.scale)),
        surface_(stage.tool_surface(e.blade.mu, e.blade.mu_r)) {}

  // Of these three, each false when the user ended the run.

  bool between_walls(const Pose& box, double load_height, const Part& part) {
    Pose behind = box, over = box;
    behind.position.x() -= e_.load_box.x();
    over.position.x() = e_.blade.overshoot;
    std::vector<Eigen::AlignedBox3d> places;
    const auto put = [&](TriangleMesh mesh, const Pose& pose) {
      Eigen::AlignedBox3d& place = places.emplace_back();
      for (const Vec3& vertex : mesh.vertices) place.extend(pose.to_world(vertex));
      return world_.add_mesh(std::move(mesh), surface_, Motion::fixed(pose));
    };
    const double lift = height_under(box), height = load_height + lift;
    const int blade = put(mesh_, behind);
    std::vector<int> sides;
    for (TriangleMesh& wall : walls(e_.load_box, height, -box.position.x()))
      sides.push_back(put(std::move(wall), box));
    // What stands higher than the box is held from behind until it has settled.
    const double h = 0.5 * e_.load_box.y() + kWall;
    int guard = -1;
    if (height > e_.load_box.z())
      guard =
          put(make_box({-e_.load_box.x() - kWall, -h, e_.load_box.z()}, {-e_.load_box.x(), h, height + 1.0}),
              box);
    most_cut_ =
        std::max(most_cut_, stage_.observe([&] { return rock_in(world_.snapshot().grains, places); }));
    stage_.add_load(lift);
    if (!stage_.advance(e_.settle_s, "settling", part.at(0), part.at(0.05))) return false;
    if (guard >= 0) world_.remove_mesh(guard);
    world_.remove_mesh(sides.back());
    const double seconds = (over.position.x() - behind.position.x()) / e_.blade.velocity;
    world_.set_mesh_motion(blade, Motion({{world_.time(), behind}, {world_.time() + seconds, over}}));
    if (!stage_.advance(seconds, "pushing", part.at(0.05), part.at(0.8))) return false;
    if (!stage_.advance_to_rest("coming to rest", part.at(0.8), part.at(0.9))) return false;
    world_.remove_mesh(blade);
    world_.remove_mesh(sides[0]);
    world_.remove_mesh(sides[1]);
    return stage_.advance_to_rest("blade leaves", part.at(0.9), part.at(1));
  }

  bool lay_heap(const Pose& box, const Part& part) {
    stage_.add_load(height_under(box));
    return stage_.advance_to_rest("dumping", part.at(0), part.at(1));
  }

  // Takes heaps towards the crest; `mass` (kg) is that of all loads so far.
  bool pass_over(double mass, const Part& part) {
    const BladeReach reach = reach_of(mesh_);
    const double end = std::min(0.0, e_.blade.overshoot), allowed = e_.blade.left_share * mass;
    const auto heights = static_cast<double>(e_.blade.heights.size());
    for (std::size_t level = 0; level < e_.blade.heights.size(); ++level) {
      const double edge = ground_ + e_.blade.heights[level];
      double left = 0;
      for (int pass = 0;; ++pass) {
        left = stage_.observe([&] { return rock_before_blade(world_.snapshot().grains, edge, end); });
        if (left <= allowed || pass == e_.blade.passes) break;
        BladePass next;
        const auto look = [&] {
          next = next_pass(world_.snapshot().grains, reach, edge, end, 0.5 * e_.bench.width);
          return next.mass;
        };
        next.mass = stage_.observe(look);
        next.y = stage_.observe([&] { return next.y; });
        next.start = stage_.observe([&] { return next.start; });
        if (next.mass == 0) break;
        const double share = (static_cast<double>(level) + static_cast<double>(pass) / e_.blade.passes);
        const Part of_pass{part.at(share / heights), part.length / heights / e_.blade.passes};
        if (!pass_once(next, edge, of_pass)) return false;
      }
      largest_left_ = std::max(largest_left_, left / mass);
    }
    return true;
  }

  // Largest share of what was pushed that was left above the edge when the passes ended.
  double largest_left() const { return largest_left_; }
  // Most rock of earlier loads that blade and walls were put into for one load, kg.
  double most_cut() const { return most_cut_; }

 private:
  // Of the rock that stands where a load is to lie, m over the ground.
  double height_under(const Pose& box) {
    return stage_.observe([&] {
      return rock_under(world_.snapshot().grains, box.position.x(), box.position.y(), e_.load_box, ground_);
    });
  }

  bool pass_once(const BladePass& pass, double edge, const Part& part) {
    Pose behind, over;
    behind.position = {pass.start, pass.y, edge};
    over.position = {e_.blade.overshoot, pass.y, edge};
    const double seconds = (over.position.x() - behind.position.x()) / e_.blade.velocity;
    const int blade =
        world_.add_mesh(mesh_, surface_, Motion({{world_.time(), behind}, {world_.time() + seconds, over}}));
    if (!stage_.advance(seconds, "pushing", part.at(0), part.at(0.8))) return false;
    if (!stage_.advance_to_rest("coming to rest", part.at(0.8), part.at(0.9))) return false;
    world_.remove_mesh(blade);
    return stage_.advance_to_rest("blade leaves", part.at(0.9), part.at(1));
  }

  Stage& stage_;
  RockWorld& world_;
  const PushDump& e_;
  double ground_;  // what load and blade stand on, m
  TriangleMesh mesh_;
  Surface surface_;
  double largest_left_ = 0, most_cut_ = 0;
};

}  // namespace

RunOutcome run_push_dump(const Scenario& scenario, const PushDump& e, std::uint64_t seed, int threads,
                         const RunHooks& hooks) {
  const double toe = toe_of(e.bench), half = 0.5 * e.bench.width;
  const double ground = standing_height(e.bench);
  const Vec3 low(-e.bench.top_length - 2, -half - 2, -3);
  // Loads at one place are laid upon what is left of each other.
  const int places = static_cast<int>(e.points.size() * e.rows.size());
  const int stacked = (e.dumps + places - 1) / places;
  const Vec3 high(toe + e.bench.floor_length + 2, half + 2,
                  ground + 3 * e.load_box.norm() + (stacked - 1) * 2 * e.load_box.z());
  Stage stage(scenario, seed, threads, hooks, low, high);

  std::vector<Pose> boxes;  // the middle of the front's lower edge of each load
  for (std::size_t k = 0; k < static_cast<std::size_t>(e.dumps); ++k) {
    Pose box;
    const double row = e.rows[k / e.points.size() % e.rows.size()];
    box.position = {-e.distance - row, e.points[k % e.points.size()], ground};
    boxes.push_back(box);
  }
  const DumpLoads loads = make_dump_loads(scenario, e.payload, boxes, {e.load_box}, seed);
  stage.begin(make_base_layer(e.bench, seed), loads.spheres);
  stage.world().add_mesh(make_bench(e.bench), stage.ground_surface(), Motion());
  stage.add_tools();

  Pushing pushing(stage, e);
  const bool at_once = e.push_after == PushAfter::all_loads;
  const double laying = e.side_walls ? 1.0 : at_once ? 0.3 : 0.1;  // share of progress, without side walls
  for (int dump = 1; dump <= e.dumps; ++dump) {
    const auto k = static_cast<std::size_t>(dump - 1);
    const double part = 1.0 / e.dumps;
    stage.set_dump(dump, e.dumps);
    if (e.side_walls) {
      if (!pushing.between_walls(boxes[k], loads.heights[k], {part * (dump - 1), part}))
        return stage.finish();
    } else {
      const double begin = at_once ? laying * part * (dump - 1) : part * (dump - 1);
      if (!pushing.lay_heap(boxes[k], {begin, laying * part})) return stage.finish();
      if (at_once && dump < e.dumps) continue;
      const Part passes =
          at_once ? Part{laying, 1 - laying} : Part{begin + laying * part, (1 - laying) * part};
      if (!pushing.pass_over(e.payload * dump, passes)) return stage.finish();
    }
    stage.dump_done(dump, e.dumps);
  }
  if (pushing.most_cut() > 0)
    stage.note(fmt::format(
        "seed {}: blade and side walls were put into rock of earlier loads, up to {:.3g} t of it for one "
        "load, and press it aside",
        seed, pushing.most_cut() / 1000));
  if (pushing.largest_left() > e.blade.left_share)
    stage.note(
        fmt::format("seed {}: when the passes ended, up to {:.0f} % of what was pushed lay on the bench "
                    "above the blade's edge; more blade.passes take more",
                    seed, 100 * pushing.largest_left()));
  return stage.finish();
}

}  // namespace scree
