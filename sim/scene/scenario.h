#pragma once
// A scenario as written by the user: checked, in SI units. Units of the file stand in its key names.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "sim/effects/effect.h"
#include "sim/material/equivalence.h"
#include "sim/material/grading.h"
#include "sim/material/material.h"
#include "sim/material/vector.h"

namespace scree {

enum class EngineKind { rrlinear, impulse };

/// One pose of a tool at one time; between keyframes position is linear and rotation is spherical-linear.
struct Keyframe {
  double time = 0;               ///< s since the start of the clock
  Vec3 position = Vec3::Zero();  ///< m
  Vec3 rotation_deg =
      Vec3::Zero();  ///< rotations about x, y, z in degrees, applied in this order about fixed axes
};

/// A user's mesh in the scene, moved by keyframes.
struct ToolSpec {
  std::string name;
  std::filesystem::path mesh;       ///< resolved path
  double scale = 1.0;               ///< metres per unit of the mesh file
  std::optional<double> mu, mu_r;   ///< default: the rock's own
  std::vector<Keyframe> keyframes;  ///< at least one
};

enum class BaseLayer { none, homogeneous, mixed };

/// Bench: top at z = height for x < 0, crest at x = 0, slope down to the toe, floor at z = 0.
struct BenchSpec {
  double height = 10;        ///< m
  double slope_deg = 45;     ///< initial slope
  double top_length = 40;    ///< m
  double floor_length = 80;  ///< m
  double width = 100;        ///< m, y from -width/2 to width/2
  /// Fixed balls: of one size (homogeneous), or of that and half of it (mixed, appendix F).
  BaseLayer base_layer = BaseLayer::homogeneous;
  double ball_diameter = 1;  ///< m, of the (larger) balls; thesis setups: base_ball_diameter
  bool layer_on_top = true;  ///< they cover the bench top too, as in the thesis; without them it is plane
};

enum class Release { open_gate, hoist };

/// Truck bed and the gate behind which its load settles. Local frame: origin at the middle of the discharge
/// lip on the bed's floor, bed along -x, z up.
struct TruckSpec {
  std::filesystem::path bed_mesh, gate_mesh;
  double scale = 1.0;
  Vec3 load_box{8, 8, 4};    ///< inner length, width, height of the bed, m
  double tilt_deg = 45;      ///< final tilt
  double drop_height = 1.5;  ///< lip above the crest, m
  double setback = 0;        ///< lip behind the crest, m
  Release release = Release::open_gate;
  double hoist_rate_deg = 6;  ///< degrees per second, hoist only
  double settle_s = 1.0;      ///< time the load settles behind the closed gate
  std::optional<double> mu, mu_r;
};

/// Truck loads over the crest of a bench.
struct EndDump {
  BenchSpec bench;
  TruckSpec truck;
  int dumps = 4;
  double payload = 300e3;           ///< kg
  std::vector<double> points{0.0};  ///< y of the dump points (m), visited in turn
};

/// Blade that pushes a load over the crest. Local frame: origin at the middle of the cutting edge, front
/// towards +x.
struct BladeSpec {
  std::filesystem::path mesh;
  double scale = 1.0;
  double velocity = 0.2;  ///< m/s
  double overshoot = 0;   ///< how far beyond the crest it goes, m
  /// Of the cutting edge over the bench top (over its balls), m, one after another from high to low.
  std::vector<double> heights{0.0};
  int passes = 1;            ///< most passes at one height
  double left_share = 0.05;  ///< of what was dumped; with less rock above its edge no further pass is made
  std::optional<double> mu, mu_r;
};

enum class PushAfter { each_load, all_loads };

/// Loads on the bench top that are pushed over the crest: laid between side walls, or heaps that a blade
/// pushes from further behind or levels.
struct PushDump {
  BenchSpec bench;
  BladeSpec blade;
  Vec3 load_box{8, 8, 4};  ///< length, width, height of the space the load is laid into, m
  double distance = 0;     ///< of the load's front from the crest, m
  bool side_walls = true;  ///< the load lies between walls; without them it is a heap that spills sideways
  PushAfter push_after = PushAfter::each_load;
  double settle_s = 1.0;  ///< time the load settles before its front is opened, with side walls
  int dumps = 4;
  double payload = 300e3;           ///< kg
  std::vector<double> points{0.0};  ///< y of the places (m), visited in turn
  std::vector<double> rows{0.0};    ///< how far behind `distance` (m); after all points the next row
};

/// Container filled with rock, then lifted: the repose angle test.
struct ReposeLift {
  std::filesystem::path container_mesh;
  double scale = 1.0;
  double diameter = 0.35;                              ///< inner, m
  double height = 0.60;                                ///< m
  double mass = 75;                                    ///< kg
  double lift_velocity = 0.5;                          ///< m/s
  double floor_radius = 1.5;                           ///< half width of the floor, m
  std::optional<double> container_mu, container_mu_r;  ///< wall of the container; default the rock's own
  std::optional<double> floor_mu, floor_mu_r;
  BaseLayer base_layer = BaseLayer::none;  ///< on the floor, as on a bench
  double ball_diameter = 1;                ///< of its balls, m
};

/// Buckets emptied one after another over the edge of a wall: the laboratory segregation test.
struct BucketDump {
  std::filesystem::path container_mesh;
  double scale = 1.0;
  double diameter = 0.27;  ///< inner, m
  double height = 0.30;    ///< inner, m
  double mass = 20;        ///< of one bucket's rock, kg
  int buckets = 10;
  double tilt_deg = 60;                                ///< of the bucket's axis to the horizontal, mouth down
  double wall_height = 1.0;                            ///< m
  double floor_radius = 10;                            ///< how far the floor reaches from the wall, m
  std::optional<double> container_mu, container_mu_r;  ///< default the rock's own
  std::optional<double> floor_mu, floor_mu_r;          ///< of floor and wall
};

/// One rock falls on a floor.
struct DropTest {
  double diameter = 0.1;  ///< m
  double height = 1.0;    ///< of its lowest point over the floor, m
};

/// A load comes to rest when less than `moving_mass_share` of the mass moves faster than `speed`.
struct StopRule {
  double speed = 0.1;  ///< m/s
  double moving_mass_share = 0.01;
  double min_time = 1.0;  ///< s after the release, of a load, bed or blade; where nothing has moved since,
                          ///< the default at least
  double max_time = 60;  ///< s after the release; reaching it is reported
};

struct Numerics {
  double time_step_safety = 0.8;  ///< share of the stable step (rrlinear)
  bool sleep = true;              ///< spheres at rest cost nothing until disturbed (rrlinear)
  double wake_tolerance = 0.1;    ///< change of a contact force that wakes, of weight + mean contact force
  double impulse_step_ratio = 0.0125;      ///< time step over sqrt(smallest diameter / g) (impulse)
  int impulse_iterations = 10;             ///< of Bullet's solver in a step (impulse)
  std::optional<double> impulse_friction;  ///< Bullet's; none: the equivalent of rrlinear's
  std::optional<double> impulse_rolling;   ///< Bullet's over the effective radius; none: as above
};

/// What is written and analysed.
struct OutputSpec {
  double frame_interval = 1.0;  ///< s of simulated time between frames of the trajectory; 0: only the last
  int sections = 6;
  std::vector<int> further_sections;  ///< other numbers of sections to analyse beside, for example 3
  std::vector<int> after_dumps;       ///< also analyse the pile after these dumps
  bool trajectory = true;
};

struct Scenario {
  std::string title;
  std::string name;  ///< the file's stem
  EngineKind engine = EngineKind::rrlinear;
  std::vector<std::uint64_t> seeds{10001};
  Material material;
  std::filesystem::path grading_file;
  double grading_from = 0;  ///< m; finer rock of the grading is left out
  std::variant<EndDump, ReposeLift, DropTest, PushDump, BucketDump> experiment;
  std::vector<ToolSpec> tools;
  std::vector<EffectUse> effects;         ///< in the order of all_effects()
  std::optional<double> effect_diameter;  ///< m; stands for the grading's D50 in them
  StopRule stop;
  Numerics numerics;
  OutputSpec output;
  std::vector<std::string> compare;  ///< names of reference cases in assets/reference/results.csv
  /// engine impulse: what Bullet gets for material.mu and material.mu_r.
  std::optional<Equivalence::Settings> bullet;
  /// The use of an effect; null where it is not used.
  EffectUse* effect(const Effect& wanted);
  const EffectUse* effect(const Effect& wanted) const;
  std::string resolved_yaml;  ///< the whole scenario with every default filled in
};

/// Name of the experiment's type in a file: end_dump, repose_lift, drop_test, push_dump, bucket_dump.
std::string_view experiment_type(const Scenario& scenario);

/// The rock as the file has it, from the finest that is not left out; throws as read_grading does.
Grading grading_of(const Scenario& scenario);

/// What the scenario's effects change; grading and rock with them.
struct EffectiveModel {
  Modifications changes;
  Grading grading;
  Material material;
  EffectContext context;  ///< what the effects refer to
};
/// Throws as read_grading does.
EffectiveModel effective_model(const Scenario& scenario);

/// What of the scenario decides whether an effect acts.
EffectScene effect_scene(const Scenario& scenario);
/// The effects with their values, a line each; throws as read_grading does.
std::vector<std::string> effects_in_words(const Scenario& scenario);

/// The bench of an experiment that has one; null otherwise.
const BenchSpec* bench_of(const Scenario& scenario);

/// One thing wrong in a scenario file.
struct ScenarioError {
  std::string file;
  int line = 0, column = 0;  ///< from 1; 0 for `--set`, and column for a row of a table
  std::string message;       ///< what is wrong, what is allowed
  std::string text() const;  ///< file:line:column: message, in one line
};

/// A scenario, or everything that is wrong with it.
struct ScenarioResult {
  Scenario scenario;
  std::vector<ScenarioError> errors;
  std::vector<std::string> warnings;
};

/// What a scenario is read for: to be run as it stands, with all the files it asks for, or for its numbers
/// alone, as ensembles and analyses do: then nothing that only its trajectory forbids is an error.
enum class ReadFor { run, numbers };

/// Reads, resolves `extends`, applies overrides ("material.mu=0.5"), checks everything (meshes and grading
/// are opened too). `asset_dir` is the project's assets folder: gradings are found by name there, meshes by
/// relative path; paths in a file are first taken relative to that file.
ScenarioResult load_scenario(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                             const std::filesystem::path& asset_dir, ReadFor use = ReadFor::run);

/// JSON Schema (draft 2020-12) of a scenario file, for editors.
std::string scenario_schema();

}  // namespace scree
