#include "sim/scene/scenario_keys.h"

namespace scree {
namespace {

constexpr Range kFriction{0, 5};
constexpr std::string_view kRock = "rock", kEquivalent = "equivalent";
constexpr Range kScale{1e-6, 1e6};
constexpr Range kBall{0.01, 20};
constexpr Range kAnywhere{-1e4, 1e4};
constexpr std::string_view kMetre = "m", kSecond = "s", kDegree = "degrees", kNone = "";

constexpr std::string_view kExperiments[] = {"end_dump", "repose_lift", "drop_test", "push_dump",
                                             "bucket_dump"};  // in the order of Scenario::experiment

template <class Enum>
Choice choice(Enum& value, std::vector<std::string_view> names) {
  return {std::move(names), [&value] { return static_cast<int>(value); },
          [&value](int index) { value = static_cast<Enum>(index); }};
}

Choice base_layer(BaseLayer& value) {
  return choice(value, {"none", "homogeneous", "mixed"});
}

constexpr std::string_view kScaleDoc = "Metres per unit of the mesh file; 0.001 for a mesh in millimetres.";
constexpr std::string_view kMuDoc = "Sliding friction coefficient against rock; `rock`: the rock's own.";
constexpr std::string_view kMuRDoc = "Rolling resistance coefficient against rock; `rock`: the rock's own.";

Fields keys(Material& m) {
  return {
      {"density_kg_m3", Number{&m.density, "kg/m3", {100, 30000}}, "Density of the solid rock."},
      {"mu", Number{&m.mu, kNone, kFriction}, "Sliding friction coefficient of rock on rock.", true},
      {"mu_r", Number{&m.mu_r, kNone, kFriction}, "Rolling resistance coefficient of rock on rock.", true},
      {"effective_modulus_pa", Number{&m.effective_modulus, "Pa", {1e3, 1e12}},
       "Effective modulus of the contacts; it sets the normal stiffness and with it the time step."},
      {"stiffness_ratio", Number{&m.stiffness_ratio, kNone, {0.1, 100}}, "Normal over shear stiffness."},
      {"local_damping", Number{&m.local_damping, kNone, {0, 1, false, true}},
       "Share of the unbalanced force that local damping takes away."},
      {"damping_reach", choice(m.damping_reach, {"always", "contacts"}),
       "Where local damping acts: always (in flight too), or only on grains in contact."},
      {"normal_damping_ratio", Number{&m.normal_damping_ratio, kNone, {0, 2}},
       "Normal dashpot, share of critical damping."},
      {"shear_damping_ratio", Number{&m.shear_damping_ratio, kNone, {0, 2}},
       "Shear dashpot, share of critical damping."},
  };
}

Fields keys(BenchSpec& b) {
  return {
      {"height_m", Number{&b.height, kMetre, {0.1, 200}}, "Height of the bench."},
      {"slope_deg", Number{&b.slope_deg, kDegree, {20, 80}},
       "Slope of the bench face before the first dump."},
      {"top_length_m", Number{&b.top_length, kMetre, {1, 1000}}, "Length of the bench top behind the crest."},
      {"floor_length_m", Number{&b.floor_length, kMetre, {1, 1000}},
       "Length of the floor in front of the toe."},
      {"width_m", Number{&b.width, kMetre, {0.1, 1000}}, "Width of bench and floor along the crest."},
      {"base_layer", base_layer(b.base_layer),
       "Fixed balls on top, slope and floor: none, homogeneous (of one size), or mixed (of that and half of "
       "it)."},
      {"base_ball_diameter_m", Number{&b.ball_diameter, kMetre, kBall},
       "Diameter of the balls of the base layer, of the larger ones of a mixed layer. They should be small "
       "beside the bench: they carry the load, half of their diameter above its surface."},
      {"layer_on_top", Boolean{&b.layer_on_top},
       "Whether the base layer covers the bench top too, as in the thesis. Between its balls lies room for "
       "much fine rock; a top that trucks and dozers have levelled is plane: false."},
  };
}

Fields keys(TruckSpec& t) {
  return {
      {"bed_mesh", MeshFile{&t.bed_mesh, "meshes/truck_bed.stl", &t.scale},
       "Mesh of the truck bed; origin at the middle of the discharge lip, bed along -x, z up (in glTF and "
       "GLB y)."},
      {"gate_mesh", MeshFile{&t.gate_mesh, "meshes/truck_gate.stl", &t.scale},
       "Mesh of the gate that holds the load while it settles, same frame; it is taken away then."},
      {"mesh_scale", Number{&t.scale, "m", kScale}, kScaleDoc},
      {"load_box_m", Vector{&t.load_box, kMetre, {0.1, 50}}, "Inner length, width and height of the bed."},
      {"tilt_deg", Number{&t.tilt_deg, kDegree, {0, 80}}, "Final tilt of the bed."},
      {"drop_height_m", Number{&t.drop_height, kMetre, {0, 50}}, "Height of the lip above the crest."},
      {"setback_m", Number{&t.setback, kMetre, {-20, 50}}, "Distance of the lip behind the crest."},
      {"release", choice(t.release, {"open_gate", "hoist"}),
       "open_gate: the gate of a bed that is tilted already opens; hoist: it opens first, then the bed "
       "tilts."},
      {"hoist_rate_deg_per_s", Number{&t.hoist_rate_deg, "degrees/s", {0.1, 90}},
       "Speed of the tilt (hoist only)."},
      {"settle_s", Number{&t.settle_s, kSecond, {0, 60}}, "Time the load settles behind the closed gate."},
      {"mu", NumberOr{&t.mu, kFriction, kRock}, kMuDoc},
      {"mu_r", NumberOr{&t.mu_r, kFriction, kRock}, kMuRDoc},
  };
}

Fields keys(EndDump& e) {
  return {
      {"bench", Group{[&e] { return keys(e.bench); }}, "The bench the load is dumped over."},
      {"truck", Group{[&e] { return keys(e.truck); }}, "The truck."},
      {"dumps", Integer{&e.dumps, {1, 1000}}, "Number of truck loads."},
      {"payload_t", Number{&e.payload, "t", {0.001, 5000}, 1000}, "Mass of one load."},
      {"points_m", Numbers{&e.points, kMetre, {-500, 500}, {1, 500}},
       "Places along the crest where the truck dumps, visited in turn; 0 is the middle."},
  };
}

Fields keys(BladeSpec& b) {
  return {
      {"mesh", MeshFile{&b.mesh, "meshes/push_wall.stl", &b.scale},
       "Mesh of the blade; origin at the middle of the cutting edge, front towards +x, z up (in glTF and GLB "
       "y)."},
      {"mesh_scale", Number{&b.scale, "m", kScale}, kScaleDoc},
      {"velocity_m_per_s", Number{&b.velocity, "m/s", {0.001, 10}}, "Speed of the push."},
      {"overshoot_m", Number{&b.overshoot, kMetre, {-10, 10}}, "How far beyond the crest the blade goes."},
      {"heights_m", Numbers{&b.heights, kMetre, {0, 50}, {1, 20}},
       "Heights of the cutting edge over the bench top, or over its balls, one after another from high to "
       "low (without side walls)."},
      {"passes", Integer{&b.passes, {1, 100}},
       "Most passes at one height, each along the lane in which most rock stands above the edge (without "
       "side walls)."},
      {"left_share", Number{&b.left_share, kNone, {0, 1, false, true}},
       "Share of the loads' mass; with less of it on the bench above the edge no further pass is made."},
      {"mu", NumberOr{&b.mu, kFriction, kRock}, kMuDoc},
      {"mu_r", NumberOr{&b.mu_r, kFriction, kRock}, kMuRDoc},
  };
}

Fields keys(PushDump& p) {
  return {
      {"bench", Group{[&p] { return keys(p.bench); }}, "The bench the load is pushed over."},
      {"blade", Group{[&p] { return keys(p.blade); }}, "The blade."},
      {"load_box_m", Vector{&p.load_box, kMetre, {0.1, 50}},
       "Length, width and height of the space on the bench top that the load is laid into."},
      {"distance_m", Number{&p.distance, kMetre, {0, 500}}, "Distance of the load's front from the crest."},
      {"side_walls", Boolean{&p.side_walls},
       "Whether the load lies between side walls and the blade pushes it once, as in the thesis; without "
       "them it falls on the bench top as a heap, and rock spills past the ends of the blade."},
      {"push_after", choice(p.push_after, {"each_load", "all_loads"}),
       "When the blade comes: after each load, or when all heaps are there (without side walls)."},
      {"settle_s", Number{&p.settle_s, kSecond, {0, 60}},
       "Time the load settles before its front is opened (side walls only)."},
      {"dumps", Integer{&p.dumps, {1, 1000}}, "Number of loads."},
      {"payload_t", Number{&p.payload, "t", {0.001, 5000}, 1000}, "Mass of one load."},
      {"points_m", Numbers{&p.points, kMetre, {-500, 500}, {1, 500}},
       "Places along the crest where loads are laid, visited in turn; 0 is the middle."},
      {"rows_m", Numbers{&p.rows, kMetre, {0, 500}, {1, 500}},
       "How far behind distance_m loads lie: after all of points_m the next row, in turn."},
  };
}

Fields container_keys(ReposeLift& r) {
  return {
      {"mesh", MeshFile{&r.container_mesh, "meshes/bucket_repose.stl", &r.scale}, "Mesh of the container."},
      {"mesh_scale", Number{&r.scale, "m", kScale}, kScaleDoc},
      {"diameter_m", Number{&r.diameter, kMetre, {0.01, 50}}, "Inner diameter."},
      {"height_m", Number{&r.height, kMetre, {0.01, 50}}, "Inner height."},
      {"mu", NumberOr{&r.container_mu, kFriction, kRock}, kMuDoc},
      {"mu_r", NumberOr{&r.container_mu_r, kFriction, kRock}, kMuRDoc},
  };
}

Fields floor_keys(ReposeLift& r) {
  return {
      {"radius_m", Number{&r.floor_radius, kMetre, {0.01, 500}}, "Half width of the floor."},
      {"mu", NumberOr{&r.floor_mu, kFriction, kRock}, kMuDoc},
      {"mu_r", NumberOr{&r.floor_mu_r, kFriction, kRock}, kMuRDoc},
      {"base_layer", base_layer(r.base_layer), "Fixed balls on the floor: none, homogeneous, or mixed."},
      {"base_ball_diameter_m", Number{&r.ball_diameter, kMetre, kBall},
       "Diameter of the balls of the base layer, of the larger ones of a mixed layer."},
  };
}

Fields keys(ReposeLift& r) {
  return {
      {"container", Group{[&r] { return container_keys(r); }}, "The container that is filled and lifted."},
      {"mass_kg", Number{&r.mass, "kg", {0.001, 5e6}}, "Mass of the rock."},
      {"lift_velocity_m_per_s", Number{&r.lift_velocity, "m/s", {1e-4, 10}}, "Speed of the lift."},
      {"floor", Group{[&r] { return floor_keys(r); }}, "The floor the rock comes to rest on."},
  };
}

Fields bucket_keys(BucketDump& b) {
  return {
      {"mesh", MeshFile{&b.container_mesh, "meshes/bucket_segregation.stl", &b.scale},
       "Mesh of the bucket; origin at the centre of its inner bottom, mouth towards z (in glTF and GLB y)."},
      {"mesh_scale", Number{&b.scale, "m", kScale}, kScaleDoc},
      {"diameter_m", Number{&b.diameter, kMetre, {0.01, 50}}, "Inner diameter."},
      {"height_m", Number{&b.height, kMetre, {0.01, 50}}, "Inner height."},
      {"tilt_deg", Number{&b.tilt_deg, kDegree, {0, 90}}, "Tilt of its axis to the horizontal, mouth down."},
      {"mu", NumberOr{&b.container_mu, kFriction, kRock}, kMuDoc},
      {"mu_r", NumberOr{&b.container_mu_r, kFriction, kRock}, kMuRDoc},
  };
}

Fields ground_keys(BucketDump& b) {
  return {
      {"radius_m", Number{&b.floor_radius, kMetre, {0.01, 500}}, "How far the floor reaches from the wall."},
      {"wall_height_m", Number{&b.wall_height, kMetre, {0.01, 100}},
       "Height of the wall the rock falls along."},
      {"mu", NumberOr{&b.floor_mu, kFriction, kRock}, kMuDoc},
      {"mu_r", NumberOr{&b.floor_mu_r, kFriction, kRock}, kMuRDoc},
  };
}

Fields keys(BucketDump& b) {
  return {
      {"container", Group{[&b] { return bucket_keys(b); }}, "The bucket."},
      {"buckets", Integer{&b.buckets, {1, 500}}, "How many are emptied, one after another."},
      {"mass_kg", Number{&b.mass, "kg", {0.001, 5e6}}, "Mass of the rock in one bucket."},
      {"floor", Group{[&b] { return ground_keys(b); }}, "The floor and the wall."},
  };
}

Fields keys(DropTest& d) {
  return {
      {"diameter_m", Number{&d.diameter, kMetre, {0.001, 10}}, "Diameter of the rock."},
      {"height_m", Number{&d.height, kMetre, {0.001, 100}}, "Height of its lowest point over the floor."},
  };
}

Fields keys(Keyframe& k) {
  return {
      {"time_s", Number{&k.time, kSecond, {0, 1e5}},
       "Time since the start of the clock; rising along the list.", true},
      {"position_m", Vector{&k.position, kMetre, kAnywhere}, "Place of the mesh's origin: x, y, z."},
      {"rotation_deg", Vector{&k.rotation_deg, kDegree, {-36000, 36000}},
       "Rotations about the fixed axes x, y, z, in this order."},
  };
}

Fields keys(ToolSpec& t) {
  return {
      {"name", Text{&t.name, {1, 100}}, "Name of the tool, of its own.", true},
      {"mesh", MeshFile{&t.mesh, "", &t.scale}, "Mesh of the tool: STL, OBJ, PLY (z up), glTF or GLB (y up).",
       true},
      {"mesh_scale", Number{&t.scale, "m", kScale}, kScaleDoc},
      {"mu", NumberOr{&t.mu, kFriction, kRock}, kMuDoc},
      {"mu_r", NumberOr{&t.mu_r, kFriction, kRock}, kMuRDoc},
      {"keyframes",
       GroupList{[&t](std::size_t n) { t.keyframes.assign(n, {}); },
                 [&t] { return t.keyframes.size(); },
                 [&t](std::size_t i) { return keys(t.keyframes[i]); },
                 {1, 4000}},
       "Poses of the tool in time; it moves straight from one to the next.", true},
  };
}

Fields keys(StopRule& s) {
  return {
      {"speed_m_per_s", Number{&s.speed, "m/s", {1e-6, 10}}, "A grain faster than this is moving."},
      {"moving_mass_share", Number{&s.moving_mass_share, kNone, {0, 1, true, true}},
       "The load is at rest when less than this share of its mass is moving."},
      {"min_time_s", Number{&s.min_time, kSecond, {0, 1e5}},
       "Least time after the release. Where nothing has moved since, it is 1 s."},
      {"max_time_s", Number{&s.max_time, kSecond, {0, 1e5, true, false}},
       "Most time after the release; reaching it is reported."},
  };
}

Fields keys(Numerics& n) {
  return {
      {"time_step_safety", Number{&n.time_step_safety, kNone, {0, 1, true, false}},
       "Share of the stable time step that is taken (engine rrlinear)."},
      {"sleep", Boolean{&n.sleep},
       "Whether grains at rest sleep until disturbed: they then cost nothing (engine rrlinear)."},
      {"wake_tolerance", Number{&n.wake_tolerance, kNone, {0, 10}},
       "Change of one contact force that wakes a sleeping grain, over its weight + mean contact force."},
      {"impulse_step_ratio", Number{&n.impulse_step_ratio, kNone, {1e-4, 1}},
       "Time step of the engine impulse over sqrt(smallest diameter / g)."},
      {"impulse_iterations", Integer{&n.impulse_iterations, {1, 1000}},
       "Solver iterations of the engine impulse."},
      {"impulse_friction", NumberOr{&n.impulse_friction, kFriction, kEquivalent},
       "Bullet's friction coefficient (engine impulse); equivalent: the one that gives rrlinear's angles."},
      {"impulse_rolling", NumberOr{&n.impulse_rolling, kFriction, kEquivalent},
       "Bullet's rolling friction over the effective radius (engine impulse); equivalent: as above."},
  };
}

Fields keys(OutputSpec& o) {
  return {
      {"frame_interval_s", Number{&o.frame_interval, kSecond, {0, 1e5}},
       "Simulated time between frames of the trajectory; 0: only the last."},
      {"sections", Integer{&o.sections, {1, 100}},
       "Number of sections the pile is cut into for its gradings."},
      {"further_sections", Integers{&o.further_sections, {1, 100}, {0, 20}},
       "Other numbers of sections to analyse beside."},
      {"after_dumps", Integers{&o.after_dumps, {1, 1000}, {0, 100}},
       "Dumps after which the pile is analysed too, beside the end."},
      {"trajectory", Boolean{&o.trajectory}, "Whether the trajectory is written."},
  };
}

// Behind the effects stands what their sizes refer to, written only where it is given.
Optionals effects(Scenario& s) {
  Optionals all;
  for (const Effect& effect : all_effects()) {
    all.names.push_back(effect.name);
    all.docs.push_back(effect.doc);
  }
  all.names.push_back("reference");
  all.docs.push_back(
      "The size that stands in effects for the grading's D50, so that they mean the same in rock of other "
      "gradings.");
  all.there = [&s] {
    std::vector<bool> there;
    for (const Effect& effect : all_effects()) there.push_back(s.effect(effect) != nullptr);
    there.push_back(s.effect_diameter.has_value());
    return there;
  };
  all.select = [&s](const std::vector<bool>& there) {
    s.effects.clear();
    s.effect_diameter.reset();
    if (there.back()) s.effect_diameter = 0.1;
    for (std::size_t k = 0; k + 1 < there.size(); ++k) {
      if (!there[k]) continue;
      EffectUse& use = s.effects.emplace_back(EffectUse{&all_effects()[k], {}});
      for (const EffectParameter& parameter : use.effect->parameters)
        use.values.push_back(parameter.standard);
    }
  };
  all.fields = [&s](std::size_t k) {
    Fields fields;
    if (k == all_effects().size()) {
      fields.push_back(
          {"diameter_m", Number{&*s.effect_diameter, kMetre, {1e-4, 100}}, "Diameter of a grain.", true});
      return fields;
    }
    EffectUse& use = *s.effect(all_effects()[k]);
    for (std::size_t p = 0; p < use.values.size(); ++p) {
      const EffectParameter& parameter = use.effect->parameters[p];
      fields.push_back({parameter.key,
                        Number{&use.values[p], parameter.unit, {parameter.low, parameter.high}},
                        parameter.doc});
    }
    return fields;
  };
  return all;
}

OneOf experiment(Scenario& s) {
  return {
      {std::begin(kExperiments), std::end(kExperiments)},
      "end_dump: truck loads over the crest of a bench; repose_lift: a container filled with rock is lifted; "
      "drop_test: one rock falls on a floor, and its rebound is measured; push_dump: a blade pushes loads "
      "over the crest of a bench; bucket_dump: buckets are emptied along a wall.",
      [&s] { return static_cast<int>(s.experiment.index()); },
      [&s](int index) {
        if (index == 0) s.experiment.emplace<EndDump>();
        if (index == 1) s.experiment.emplace<ReposeLift>();
        if (index == 2) s.experiment.emplace<DropTest>();
        if (index == 3) s.experiment.emplace<PushDump>();
        if (index == 4) s.experiment.emplace<BucketDump>();
      },
      [&s] { return std::visit([](auto& chosen) { return keys(chosen); }, s.experiment); }};
}

}  // namespace

const BenchSpec* bench_of(const Scenario& scenario) {
  if (const auto* dump = std::get_if<EndDump>(&scenario.experiment)) return &dump->bench;
  if (const auto* push = std::get_if<PushDump>(&scenario.experiment)) return &push->bench;
  return nullptr;
}

std::string_view experiment_type(const Scenario& scenario) {
  return kExperiments[scenario.experiment.index()];
}

Fields scenario_keys(Scenario& s) {
  return {
      {"extends", Extends{},
       "Another scenario file, relative to this one, whose keys hold where this one does not give them."},
      {"title", Text{&s.title, {0, 200}}, "Title for reports."},
      {"engine", choice(s.engine, {"rrlinear", "impulse"}),
       "rrlinear: soft contacts with rolling resistance; impulse: rigid contacts, coarser."},
      {"seeds", Seeds{&s.seeds, {1, 1000}}, "Seeds of the random streams, one run each; distinct."},
      {"material", Group{[&s] { return keys(s.material); }}, "The rock and the contact law."},
      {"grading", GradingFile{&s.grading_file}, "Name of a grading in assets/gradings, or path of a CSV.",
       true},
      {"grading_from_m", Number{&s.grading_from, "m", {0, 1000}},
       "Rock of the grading finer than this is left out, and the rest counts as the whole; 0: none. A sieve "
       "curve may then begin above 0 %."},
      {"experiment", experiment(s), "What is done with the rock.", true},
      {"tools",
       GroupList{[&s](std::size_t n) { s.tools.assign(n, {}); },
                 [&s] { return s.tools.size(); },
                 [&s](std::size_t i) { return keys(s.tools[i]); },
                 {0, 50}},
       "Meshes in the scene, fixed or moved by keyframes; the run lasts until the last of them has come to "
       "rest."},
      {"effects", effects(s),
       "Physics that the base model lacks, each effect with its parameters (engine rrlinear); see "
       "docs/effects.md."},
      {"stop", Group{[&s] { return keys(s.stop); }}, "When a load has come to rest."},
      {"numerics", Group{[&s] { return keys(s.numerics); }}, "Time steps and iterations."},
      {"output", Group{[&s] { return keys(s.output); }}, "What is written and analysed."},
      {"compare", Texts{&s.compare, {0, 100}},
       "Cases in assets/reference/results.csv the result is held against."},
  };
}

}  // namespace scree
