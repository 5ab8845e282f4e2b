#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <stdexcept>

#include "sim/io/mesh.h"
#include "sim/scene/blade_passes.h"
#include "sim/scene/estimate.h"
#include "sim/scene/ground.h"
#include "sim/scene/scenario_read.h"
#include "sim/scene/scenario_values.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

/// Densest packing a container is filled to: a little below random close packing (0.64) of equal spheres.
constexpr double kDensestFill = 0.62;

/// Width and height of a blade below which it is none, m.
constexpr double kLeastBlade = 1e-3;

/// Of the bench's height, diameter of a base ball above which the layer shapes the slope.
constexpr double kLargeBall = 0.2;

/// Time between frames of a trajectory below which it fills any disk, s.
constexpr double kLeastFrameInterval = 1e-3;

class Checks {
 public:
  Checks(const Scenario& scenario, const fs::path& asset_dir, ReadFor use, ReadNotes& notes,
         std::vector<std::string>& warnings)
      : s_(scenario), asset_dir_(asset_dir), use_(use), notes_(notes), warnings_(warnings) {}

  void all() {
    meshes();
    read_the_grading();
    if (const auto* dump = std::get_if<EndDump>(&s_.experiment)) end_dump(*dump);
    if (const auto* push = std::get_if<PushDump>(&s_.experiment)) push_dump(*push);
    if (const auto* lift = std::get_if<ReposeLift>(&s_.experiment)) repose_lift(*lift);
    if (const auto* buckets = std::get_if<BucketDump>(&s_.experiment)) bucket_dump(*buckets);
    tools();
    effects();
    if (notes_.good({&s_.stop.min_time, &s_.stop.max_time}) && s_.stop.min_time > s_.stop.max_time)
      fail(&s_.stop.min_time, fmt::format("stop.min_time_s: {} is more than stop.max_time_s ({})",
                                          s_.stop.min_time, s_.stop.max_time));
    const double& interval = s_.output.frame_interval;
    if (notes_.good({&interval}) && interval > 0 && interval < kLeastFrameInterval)
      fail(&interval,
           fmt::format("output.frame_interval_s: {} is out of range; allowed {} s and more, or 0 for the "
                       "last frame alone",
                       interval, kLeastFrameInterval));
    sections();
    compare();
  }

 private:
  void fail(const void* value, std::string message) {
    report(notes_.errors, notes_.places.at(value), std::move(message));
  }

  void meshes() {
    for (const MeshUse& use : notes_.meshes) {
      if (!notes_.good({use.scale})) continue;
      const MeshReport found = load_mesh(*use.file, *use.scale).report;
      for (const std::string& error : found.errors) report(notes_.errors, use.place, use.key + ": " + error);
      for (const std::string& warning : found.warnings)
        warnings_.push_back(
            ScenarioError{*use.place.file, use.place.line, use.place.column, use.key + ": " + warning}
                .text());
    }
  }

  void read_the_grading() {
    if (!notes_.good({&s_.grading_file})) return;
    try {
      model_ = effective_model(s_);
    } catch (const std::exception& error) {
      fail(&s_.grading_file, std::string("grading: ") + error.what());
    }
  }

  /// `load` describes the mass; `cure` says what to change beside the grading.
  void spheres(double mass, const void* key, std::string_view path, const std::string& load,
               std::string_view cure) {
    if (!model_ || !notes_.good({&s_.material.density})) return;
    const double count = model_->changes.clumps.spheres() *
                         expected_spheres(model_->grading, mass, density_of(model_->material));
    if (count > kMaxSpheres)
      fail(key,
           fmt::format(
               "{}: about {:.1f} million spheres ({} of {}), more than the {:.0f} million allowed; {}, or "
               "leave out the finest rock with grading_from_m",
               path, count / 1e6, load, model_->grading.name(), kMaxSpheres / 1e6, cure));
  }

  /// Volume (m3) of the rock of a mass (kg), without voids.
  double rock_of(double mass) const {
    return model_ ? solid_volume(model_->grading, mass, density_of(model_->material))
                  : mass / s_.material.density;
  }

  /// A load must have a sphere.
  void smallest(double mass, const void* key, std::string_view path) {
    if (!model_ || !notes_.good({key, &s_.material.density})) return;
    const double least = sphere_mass(model_->material, model_->grading.min_diameter());
    if (mass < least)
      fail(key, fmt::format("{}: {:g} kg are less than the smallest sphere of {} ({:g} m, {:g} kg)", path,
                            mass, model_->grading.name(), model_->grading.min_diameter(), least));
  }

  void effects() {
    const auto moves = std::find_if(s_.effects.begin(), s_.effects.end(),
                                    [](const EffectUse& use) { return !use.effect->measures; });
    if (moves != s_.effects.end() && s_.engine == EngineKind::impulse)
      fail(&moves->values.front(),
           "effects: engine impulse has none but those on measurement; take engine rrlinear");
    for (const EffectUse& use : s_.effects)
      for (const EffectUse& other : s_.effects)
        if (!use.effect->excludes.empty() && use.effect->excludes == other.effect->name &&
            use.values.front() != use.effect->absent && other.values.front() != other.effect->absent)
          fail(&use.values.front(), fmt::format("effects: {} and {} do not go together; take one of them",
                                                use.effect->name, other.effect->name));
    const EffectScene scene = effect_scene(s_);
    for (const EffectUse& use : s_.effects)
      if (const std::string why = why_inert(*use.effect, scene); !why.empty())
        warnings_.push_back(fmt::format("effects.{}: changes nothing {}", use.effect->name, why));
    if (use_ == ReadFor::run && s_.output.trajectory && modifications(s_.effects, {}).breakage.on())
      fail(&s_.effect(*find_effect("breakage"))->values.front(),
           "effects.breakage: a trajectory has a row for each grain put in and none for fragments; set "
           "output.trajectory to false");
  }

  // Piles that are asked for but never there.
  void piles(int dumps) {
    if (!notes_.good({&s_.output.after_dumps})) return;
    for (const int dump : s_.output.after_dumps)
      if (dump >= dumps) {
        fail(&s_.output.after_dumps,
             fmt::format(
                 "output.after_dumps: {} of {} dumps; the pile after the last one is analysed anyway, and "
                 "later ones are never there",
                 dump, dumps));
        return;
      }
  }

  void end_dump(const EndDump& e) {
    if (notes_.good({&e.dumps})) piles(e.dumps);
    bed(e.truck, e.bench);
    bench_loads(e, e.truck.load_box, "experiment.truck.load_box_m", "the truck's load box");
  }

  /// A bed must be tilted, and stand over the bench top.
  void bed(const TruckSpec& truck, const BenchSpec& bench) {
    if (!notes_.good({&truck.tilt_deg})) return;
    if (truck.tilt_deg <= 0)
      return fail(&truck.tilt_deg, fmt::format("experiment.truck.tilt_deg: 0 with release {}: the bed must "
                                               "tilt, more than 0",
                                               truck.release == Release::hoist ? "hoist" : "open_gate"));
    // Rock on a plane slides from tan(tilt) = mu on, and rolls from tan(tilt) = mu_r on.
    const double least = std::min(truck.mu.value_or(s_.material.mu), truck.mu_r.value_or(s_.material.mu_r));
    const double starts = std::atan(least) * 180 / std::numbers::pi;
    if (notes_.good({&s_.material.mu, &s_.material.mu_r, &truck.mu, &truck.mu_r}) && truck.tilt_deg <= starts)
      warnings_.push_back(fmt::format(
          "experiment.truck.tilt_deg: on a bed tilted by {:g} degrees rock neither slides nor rolls; it does "
          "above {:.3g} degrees, whose tangent is the smaller of mu and mu_r ({:g}). What does not spill "
          "over the lip leaves with the truck",
          truck.tilt_deg, starts, least));
    if (!notes_.good({&truck.setback, &truck.load_box, &bench.top_length})) return;
    const double tilt = truck.release == Release::hoist ? 0 : truck.tilt_deg * std::numbers::pi / 180;
    const double length = truck.load_box.x() * std::cos(tilt);
    if (truck.setback + length > bench.top_length)
      fail(&truck.setback,
           fmt::format("experiment.truck.setback_m: a bed {:.3g} m long in plan at {:g} m from "
                       "the crest does not fit on a bench top {:g} m long",
                       length, truck.setback, bench.top_length));
  }

  /// What holds for the bench of all experiments that have one.
  void bench(const BenchSpec& b) {
    if (b.base_layer == BaseLayer::none ||
        !notes_.good({&b.ball_diameter, &b.height, &b.slope_deg, &b.width, &b.floor_length, &b.top_length}))
      return;
    const double slope = b.height / std::sin(b.slope_deg * std::numbers::pi / 180);
    balls((slope + b.floor_length + (b.layer_on_top ? b.top_length : 0)) * b.width, b.base_layer,
          b.ball_diameter, "experiment.bench.base_ball_diameter_m");
    if (b.ball_diameter > kLargeBall * b.height)
      warnings_.push_back(fmt::format(
          "experiment.bench.base_ball_diameter_m: balls of {:g} m on a bench {:g} m high, more than a fifth "
          "of "
          "it ({:.3g} m): they shape the slope{}",
          b.ball_diameter, b.height, kLargeBall * b.height,
          b.layer_on_top ? ", and rock upon those of the top lies above the crest's height, in no section"
                         : ""));
  }

  /// A base layer on a surface of this area (m2) has no more balls than a run can have spheres.
  void balls(double area, BaseLayer layer, const double& diameter, std::string_view path) {
    if (const double count = estimated_balls(area, layer, diameter); count > kMaxSpheres)
      fail(&diameter, fmt::format("{}: about {:.1f} million balls of {:g} m, more than the {:.0f} million "
                                  "allowed; enlarge them",
                                  path, count / 1e6, diameter, kMaxSpheres / 1e6));
  }

  void push_dump(const PushDump& e) {
    if (notes_.good({&e.dumps})) piles(e.dumps);
    bench_loads(e, e.load_box, "experiment.load_box_m", "the load");
    if (notes_.good({&e.load_box, &e.distance, &e.rows, &e.bench.top_length}) && !e.rows.empty()) {
      const auto last = std::max_element(e.rows.begin(), e.rows.end());
      const double distance = e.distance + *last;
      // A heap spreads backwards by some of its height.
      const double room = e.side_walls ? 1 : 1 + e.load_box.z();
      if (distance + e.load_box.x() + room > e.bench.top_length)
        fail(*last > 0 ? place_of(e.rows, last - e.rows.begin()) : &e.distance,
             fmt::format(
                 "experiment.{}: a load {} m long at {} m from the crest, and the blade behind it, "
                 "do not lie on a bench top {} m long{}",
                 *last > 0 ? fmt::format("rows_m[{}]", last - e.rows.begin()) : "distance_m", e.load_box.x(),
                 distance, e.bench.top_length,
                 e.side_walls ? "" : fmt::format("; a heap and the blade need {} m behind the load", room)));
    }
    if (notes_.good({&e.load_box, &e.distance, &e.blade.overshoot}) &&
        e.blade.overshoot <= -(e.distance + e.load_box.x()))
      fail(&e.blade.overshoot,
           "experiment.blade.overshoot_m: the blade would end where it starts, or behind");
    if (notes_.good({&e.blade.heights}))
      for (std::size_t i = 1; i < e.blade.heights.size(); ++i)
        if (e.blade.heights[i] >= e.blade.heights[i - 1])
          fail(&e.blade.heights[i],
               fmt::format("experiment.blade.heights_m[{}]: {} m is not below the height before ({} m); the "
                           "blade cuts from the top down",
                           i, e.blade.heights[i], e.blade.heights[i - 1]));
    blade(e.blade);
    if (notes_.good({&e.side_walls})) e.side_walls ? walled_push(e) : free_push(e);
  }

  /// A blade must have a front to push with.
  void blade(const BladeSpec& blade) {
    if (!notes_.good({&blade.mesh, &blade.scale}) || !fs::exists(blade.mesh)) return;
    const LoadedMesh loaded = load_mesh(blade.mesh, blade.scale);
    if (!loaded.report.errors.empty()) return;
    Eigen::AlignedBox3d box;
    for (const Vec3& vertex : loaded.mesh.vertices) box.extend(vertex);
    const Vec3 size = box.sizes();
    if (std::min(size.y(), size.z()) < kLeastBlade)
      return fail(
          &blade.mesh,
          fmt::format("experiment.blade.mesh: {:.3g} m wide (y) and {:.3g} m high (z) has no front to "
                      "push with; the blade faces +x, z up",
                      size.y(), size.z()));
    double volume = 0;
    for (const auto& t : loaded.mesh.triangles) {
      const auto& v = loaded.mesh.vertices;
      const Vec3 a = v[static_cast<std::size_t>(t[0])] - box.min(),
                 b = v[static_cast<std::size_t>(t[1])] - box.min();
      volume += a.dot(b.cross(v[static_cast<std::size_t>(t[2])] - box.min())) / 6;
    }
    // A sheet that is not closed pushes with both sides; a closed mesh only with its outside.
    if (loaded.mesh.closed && std::abs(volume) < 1e-9 * std::pow(size.norm(), 3))
      fail(&blade.mesh,
           "experiment.blade.mesh: closed but without volume (the same faces twice?); leave one side "
           "out, or give it a thickness");
  }

  /// Between side walls the blade goes once over the ground, with the load that lies there.
  void walled_push(const PushDump& e) {
    const char* way_out = "between side walls; set side_walls: false";
    if (notes_.good({&e.blade.left_share}) && e.blade.left_share != BladeSpec().left_share)
      fail(&e.blade.left_share,
           fmt::format("experiment.blade.left_share: decides on further passes, but the blade passes once {}",
                       way_out));
    if (notes_.good({&e.blade.passes}) && e.blade.passes > 1)
      fail(&e.blade.passes,
           fmt::format("experiment.blade.passes: {}, but the blade passes once {}", e.blade.passes, way_out));
    if (notes_.good({&e.blade.heights}) && e.blade.heights != std::vector<double>{0.0})
      fail(&e.blade.heights, fmt::format("experiment.blade.heights_m: the blade goes over the ground, at "
                                         "height 0, {}",
                                         way_out));
    if (e.push_after == PushAfter::all_loads)
      fail(&e.side_walls,
           fmt::format("experiment.push_after: all_loads, but the blade comes after each load {}", way_out));
  }

  void free_push(const PushDump& e) {
    if (notes_.good({&e.settle_s}) && e.settle_s != PushDump().settle_s)
      fail(&e.settle_s,
           "experiment.settle_s: the load settles before its front is opened, between side walls alone; a "
           "heap "
           "comes to rest by stop, set side_walls: true or leave it out");
    if (e.push_after == PushAfter::all_loads && notes_.good({&s_.output.after_dumps}) &&
        !s_.output.after_dumps.empty())
      fail(&s_.output.after_dumps,
           "output.after_dumps: with push_after all_loads there is no pile before the last dump; leave it "
           "empty");
    if (!notes_.good({&e.blade.scale, &e.bench.width}) || !std::filesystem::exists(e.blade.mesh)) return;
    const LoadedMesh blade = load_mesh(e.blade.mesh, e.blade.scale);
    if (!blade.report.errors.empty()) return;
    const BladeReach reach = reach_of(blade.mesh);
    const double wide = 2 * std::max(-reach.low_y, reach.high_y);
    if (wide > e.bench.width)
      fail(&e.bench.width, fmt::format("experiment.bench.width_m: {} m is narrower than the blade ({:.3g} m)",
                                       e.bench.width, wide));
  }

  /// Key of a list's entry, of the list where it has a default.
  template <class List, class Index>
  const void* place_of(const List& list, Index index) const {
    const void* entry = &list[static_cast<std::size_t>(index)];
    return notes_.places.contains(entry) ? entry : static_cast<const void*>(&list);
  }

  /// What holds for all experiments that bring loads over a crest; `what` holds a load.
  template <class Experiment>
  void bench_loads(const Experiment& e, const Vec3& box, const std::string& path, std::string_view what) {
    bench(e.bench);
    smallest(e.payload, &e.payload, "experiment.payload_t");
    if (notes_.good({&e.payload, &e.dumps}))
      spheres(e.payload * e.dumps, &e.payload, "experiment.payload_t",
              fmt::format("{} dumps of {} t", e.dumps, e.payload / 1000), "lower payload_t or dumps");
    if (!notes_.good({&box})) return;
    if (notes_.good({&e.payload, &s_.material.density})) {
      const double rock = rock_of(e.payload);
      if (rock > kDensestFill * box.prod())
        fail(&box,
             fmt::format(
                 "{}: too small for the payload: {:.3g} t are {:.3g} m3 of solid rock, the box of {:.3g} m3 "
                 "holds at most {:.3g} m3 ({} of it); enlarge it or lower payload_t",
                 path, e.payload / 1000, rock, box.prod(), kDensestFill * box.prod(), kDensestFill));
    }
    largest(box.minCoeff(), &box, path);
    if (!notes_.good({&e.bench.width, &e.points})) return;
    const double reach = (e.bench.width - box.y()) / 2;
    if (reach < 0)
      return fail(&e.bench.width, fmt::format("experiment.bench.width_m: {} m is narrower than {} ({} m)",
                                              e.bench.width, what, box.y()));
    for (std::size_t i = 0; i < e.points.size(); ++i) {
      if (std::abs(e.points[i]) > reach)
        fail(place_of(e.points, i),
             fmt::format("experiment.points_m[{}]: a load box {} m wide at {} m does not fit the bench {} m "
                         "wide; allowed {} to {} m",
                         i, box.y(), e.points[i], e.bench.width, -reach, reach));
    }
  }

  void repose_lift(const ReposeLift& r) {
    if (notes_.good({&r.ball_diameter, &r.floor_radius}))
      balls(4 * r.floor_radius * r.floor_radius, r.base_layer, r.ball_diameter,
            "experiment.floor.base_ball_diameter_m");
    if (!notes_.good({&r.mass})) return;
    smallest(r.mass, &r.mass, "experiment.mass_kg");
    spheres(r.mass, &r.mass, "experiment.mass_kg", fmt::format("{} kg", r.mass), "lower mass_kg");
    if (!notes_.good({&r.diameter, &r.height})) return;
    largest(r.diameter, &r.diameter, "experiment.container.diameter_m");
    container(r.mass, r.diameter, r.height);
  }

  void bucket_dump(const BucketDump& b) {
    if (!notes_.good({&b.mass, &b.buckets})) return;
    smallest(b.mass, &b.mass, "experiment.mass_kg");
    spheres(b.mass * b.buckets, &b.mass, "experiment.mass_kg",
            fmt::format("{} buckets of {} kg", b.buckets, b.mass), "lower mass_kg or buckets");
    if (!notes_.good({&b.diameter, &b.height})) return;
    largest(b.diameter, &b.diameter, "experiment.container.diameter_m");
    container(b.mass, b.diameter, b.height);
  }

  /// A cylinder (m) holds `mass` (kg).
  void container(const double& mass, double diameter, double height) {
    const double volume = std::numbers::pi / 4 * diameter * diameter * height;
    const double rock = rock_of(mass);
    if (notes_.good({&s_.material.density}) && rock > kDensestFill * volume)
      fail(&mass,
           fmt::format(
               "experiment.mass_kg: {} kg are {:.3g} m3 of solid rock, the container of {:.3g} m3 holds "
               "at most {:.3g} m3 ({} of it); lower mass_kg or enlarge the container",
               mass, rock, volume, kDensestFill * volume, kDensestFill));
  }

  void largest(double room, const void* key, std::string_view path) {
    if (!model_) return;
    const Clumps& clumps = model_->changes.clumps;
    const double length = clumps.length() * model_->grading.max_diameter();
    if (length >= room)
      fail(key, fmt::format("{}: {} m is not wider than the largest grain of {} ({} m{})", path, room,
                            model_->grading.name(), length, clumps.on() ? " long" : ""));
  }

  void tools() {
    for (std::size_t i = 0; i < s_.tools.size(); ++i) {
      const ToolSpec& tool = s_.tools[i];
      for (std::size_t j = 0; j < i; ++j)
        if (notes_.good({&tool.name}) && s_.tools[j].name == tool.name)
          fail(&tool.name,
               fmt::format("tools[{}].name: {} is the name of tools[{}] already", i, shown(tool.name), j));
      for (std::size_t k = 1; k < tool.keyframes.size(); ++k) {
        const Keyframe &before = tool.keyframes[k - 1], &frame = tool.keyframes[k];
        if (notes_.good({&before.time, &frame.time}) && frame.time <= before.time)
          fail(&frame.time,
               fmt::format("tools[{}].keyframes[{}].time_s: {} s is not after the keyframe before ({} s)", i,
                           k, frame.time, before.time));
        if (notes_.good({&before.rotation_deg, &frame.rotation_deg}) &&
            (frame.rotation_deg - before.rotation_deg).cwiseAbs().maxCoeff() >= 180)
          fail(&frame.rotation_deg,
               fmt::format(
                   "tools[{}].keyframes[{}].rotation_deg: turns by 180 degrees or more from the keyframe "
                   "before, which way is not clear; add keyframes between",
                   i, k));
      }
    }
  }

  void sections() {
    const OutputSpec& o = s_.output;
    if (!notes_.good({&o.sections, &o.further_sections})) return;
    for (std::size_t i = 0; i < o.further_sections.size(); ++i) {
      const auto end = o.further_sections.begin() + static_cast<std::ptrdiff_t>(i);
      if (o.further_sections[i] == o.sections || std::find(o.further_sections.begin(), end, *end) != end)
        fail(&o.further_sections[i],
             fmt::format("output.further_sections[{}]: {} sections are analysed already", i, *end));
    }
  }

  void compare() {
    if (s_.compare.empty()) return;
    const fs::path file = asset_dir_ / "reference" / "results.csv";
    std::vector<std::string> known;
    std::ifstream stream(file);
    if (!stream) {
      fail(&s_.compare, "compare: the reference results cannot be read: " + file.string());
      return;
    }
    bool header = true;
    for (std::string line; std::getline(stream, line);) {
      if (line.empty() || line[0] == '#' || line[0] == '\r') continue;
      std::string name = line.substr(0, line.find_first_of(",\r"));
      if (!header && std::find(known.begin(), known.end(), name) == known.end())
        known.push_back(std::move(name));
      header = false;
    }
    for (std::size_t i = 0; i < s_.compare.size(); ++i)
      if (std::find(known.begin(), known.end(), s_.compare[i]) == known.end())
        fail(&s_.compare[i],
             fmt::format("compare[{}]: no reference case {}{}; known: {}", i, shown(s_.compare[i]),
                         suggestion(s_.compare[i], known), join(known)));
  }

  const Scenario& s_;
  const fs::path& asset_dir_;
  const ReadFor use_;
  ReadNotes& notes_;
  std::vector<std::string>& warnings_;
  std::optional<EffectiveModel> model_;  // none if its grading cannot be read
};

}  // namespace

void check_scenario(const Scenario& scenario, const fs::path& asset_dir, ReadFor use, ReadNotes& notes,
                    std::vector<std::string>& warnings) {
  Checks(scenario, asset_dir, use, notes, warnings).all();
}

void find_bullet_settings(Scenario& s, const fs::path& asset_dir, ReadNotes& notes) {
  const auto &friction = s.numerics.impulse_friction, &rolling = s.numerics.impulse_rolling;
  if (s.engine != EngineKind::impulse) return;
  if (!notes.good({&s.material.mu, &s.material.mu_r, &s.material.local_damping, &friction, &rolling,
                   &s.numerics.impulse_step_ratio, &s.numerics.impulse_iterations}))
    return;
  if (friction && rolling) {
    s.bullet = Equivalence::Settings{*friction, *rolling, std::nullopt};
    return;
  }
  const auto fail = [&](const std::string& what) {
    report(
        notes.errors, notes.places.at(&s.material.mu),
        fmt::format("engine impulse: {}; set numerics.impulse_friction and numerics.impulse_rolling, or take "
                    "engine rrlinear",
                    what));
  };
  const Numerics usual;
  if (s.numerics.impulse_step_ratio != usual.impulse_step_ratio ||
      s.numerics.impulse_iterations != usual.impulse_iterations) {
    fail(fmt::format(
        "equivalent settings of Bullet are known for impulse_step_ratio {:g} and impulse_iterations {} alone",
        usual.impulse_step_ratio, usual.impulse_iterations));
    return;
  }
  const Material made_with;  // that is, the table of equivalents
  if (s.material.effective_modulus != made_with.effective_modulus ||
      s.material.stiffness_ratio != made_with.stiffness_ratio ||
      s.material.damping_reach != made_with.damping_reach || s.material.normal_damping_ratio != 0 ||
      s.material.shear_damping_ratio != 0) {
    fail(
        fmt::format("equivalent settings of Bullet are known for effective_modulus_pa {:g}, stiffness_ratio "
                    "{:g}, damping_reach always and no dashpots alone",
                    made_with.effective_modulus, made_with.stiffness_ratio));
    return;
  }
  try {
    const Equivalence table = Equivalence::read(asset_dir / "impulse" / "equivalent.csv");
    s.bullet = table.at(s.material.mu, s.material.mu_r, s.material.local_damping);
    if (!s.bullet)
      fail(
          fmt::format("no settings of Bullet are known that are equivalent to mu {:g}, mu_r {:g}, "
                      "local_damping {:g}; known: {}",
                      s.material.mu, s.material.mu_r, s.material.local_damping, table.range()));
  } catch (const std::runtime_error& error) {
    fail(error.what());
  }
  if (!s.bullet) return;
  if (friction || rolling) s.bullet->error_deg.reset();
  s.bullet->friction = friction.value_or(s.bullet->friction);
  s.bullet->rolling = rolling.value_or(s.bullet->rolling);
}

}  // namespace scree
