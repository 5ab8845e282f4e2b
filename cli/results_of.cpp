#include "cli/results_of.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/pile/half_cone.h"
#include "analysis/pile/mass_quantile.h"
#include "analysis/pile/slope_profile.h"
#include "analysis/pile/toe_share.h"
#include "analysis/report/report_text.h"
#include "analysis/results/outputs.h"
#include "analysis/results/summary.h"
#include "scree_version.h"
#include "sim/scene/ground.h"
#include "sim/scene/watch.h"
#include "sim/world/mesh_contact.h"

namespace scree {
namespace {
constexpr double kMuchBeyondHeap = 0.1;  // of the mass: a reader is told
constexpr double kOverlapWarning =
    0.10;                         // of the smaller radius; physics of soft spheres beyond it is doubtful
constexpr double kHalfWidth = 4;  // of the section through a pile, m: half a truck bed or blade
constexpr double kCellsInHeight = 0.1;  // of the bench, size of the section's cells
constexpr double kUsualPorosity = 0.4;  // of a pile too thin to have an inside

std::vector<double> dump_points(const Scenario& scenario) {
  if (const auto* dump = std::get_if<EndDump>(&scenario.experiment)) return dump->points;
  if (const auto* push = std::get_if<PushDump>(&scenario.experiment)) return push->points;
  return {0.0};
}

double first_point(const Scenario& scenario) {
  return dump_points(scenario).front();
}

Measurement measurement_of(const Scenario& scenario) {
  if (std::none_of(scenario.effects.begin(), scenario.effects.end(),
                   [](const EffectUse& use) { return use.effect->measures; }))
    return {};
  return effective_model(scenario).changes.measurement;
}

// A section through the first dump point.
void analyse_inside_of(const Scenario& scenario, const BenchSpec& bench, const std::vector<Grain>& dumped,
                       SeedResult& r) {
  VerticalSection section;
  section.y0 = first_point(scenario);
  section.half_width = kHalfWidth;
  section.cell = kCellsInHeight * bench.height;
  section.bench = BenchOutline{bench.height, bench.slope_deg};
  r.inside = analyse_inside(r.final_state.grains, r.fixed, dumped, section);
  const double porosity = r.inside->mean_porosity;  // soft spheres may overlap by more than the voids
  r.layers = analyse_layers(r.final_state.grains, dumped, section,
                            std::isfinite(porosity) ? std::clamp(porosity, 0.0, 0.9) : kUsualPorosity);
  r.largest_at_toe = share_reaching_toe(r.final_state.grains, bench.height, dumped);
}

EnergyTerms energy_terms(const EnergyBalance& balance) {
  const EnergyAccount& a = balance.account;
  const Energy& held = balance.held;
  const EnergyLosses& lost = a.losses;
  constexpr auto put_in = EnergyTerm::Side::put_in, still = EnergyTerm::Side::held,
                 taken_out = EnergyTerm::Side::taken_out;
  return {{{"fall", "fall of the rock", put_in, balance.fall()},
           {"came_moving", "rock that came with speed", put_in, a.came_moving},
           {"set_moving", "rock that was given a speed", put_in, a.set_moving},
           {"tools", "work of tools; negative: rock that pushed them, or lost their hold", put_in, a.tools},
           {"shaking", "the platform that shakes", put_in, a.shaking},
           {"pressed", "contacts that began pressed, at corners of meshes and of rock put upon rock", put_in,
            a.pressed},
           {"fragments", "fragments that grew, less what fracture took", put_in, a.fragments},
           {"kinetic", "motion", still, held.kinetic},
           {"elastic", "springs of contacts", still, held.elastic},
           {"pull", "cohesion", still, held.pull},
           {"sliding", "sliding friction", taken_out, lost.sliding},
           {"rolling", "rolling friction", taken_out, lost.rolling},
           {"twisting", "twisting friction", taken_out, lost.twisting},
           {"dashpots", "dashpots", taken_out, lost.dashpots},
           {"local_damping", "local damping", taken_out, lost.local_damping},
           {"put_to_sleep", "spheres put to sleep", taken_out, a.put_to_sleep},
           {"lost", "spheres that left the model", taken_out, a.lost_other}},
          balance.put_in(),
          balance.error(),
          balance.relative_error(),
          closes(balance)};
}

}  // namespace

std::optional<FlowRecorder> make_flow_recorder(const Scenario& scenario) {
  const BenchSpec* bench = bench_of(scenario);
  if (bench == nullptr) return std::nullopt;
  FlowSettings settings;
  settings.bench = {bench->height, bench->slope_deg};
  settings.sections = scenario.output.sections;
  settings.y0 = first_point(scenario);
  return FlowRecorder(settings);
}

SeedResult analyse(const Scenario& scenario, std::uint64_t seed, RunOutcome outcome,
                   std::optional<FlowRecorder> flow) {
  SeedResult r;
  r.seed = seed;
  r.particles = static_cast<std::int64_t>(outcome.original.size());
  r.fixed = std::move(outcome.fixed);
  r.flow = std::move(flow);
  for (const Grain& g : outcome.original) r.mass += g.mass;
  r.wall_seconds = outcome.wall_seconds;
  r.simulated_seconds = outcome.simulated_seconds;
  r.particle_steps = outcome.statistics.particle_steps;
  r.steps = outcome.statistics.steps;
  // Steps that end early where a run is looked at are not counted as the shortest; in some all are such.
  r.time_step_min = std::min(outcome.statistics.time_step_min, outcome.statistics.time_step_max);
  r.time_step_max = outcome.statistics.time_step_max;
  r.largest_overlap_ratio = outcome.statistics.largest_overlap_ratio;
  r.lost_particles = outcome.statistics.lost_particles;
  r.lost_mass = outcome.statistics.lost_mass;
  if (std::holds_alternative<EndDump>(scenario.experiment) ||
      std::holds_alternative<BucketDump>(scenario.experiment))
    r.carried_back = outcome.carried_back;
  if (outcome.energy) r.energy = energy_terms(*outcome.energy);
  r.failures = watch_failures(outcome);
  r.squeezed_into_walls = outcome.statistics.squeezed_into_walls;
  r.crowded_contacts = outcome.statistics.crowded_contacts;
  r.at_rest = outcome.at_rest && !outcome.interrupted;
  r.interrupted = outcome.interrupted;
  r.final_state = std::move(outcome.final_state);
  r.original = std::move(outcome.original);
  // What is not yet dumped when the user ends a run is in the container, not in the pile.
  int last = 0;
  for (const Grain& g : r.final_state.grains) last = std::max(last, g.dump);
  const auto dumped_until = [&](int dumps) {
    std::vector<Grain> dumped;
    for (const Grain& g : r.original)
      if (g.dump <= dumps) dumped.push_back(g);
    return dumped;
  };
  const Measurement measured = measurement_of(scenario);
  if (const BenchSpec* bench = bench_of(scenario)) {
    const auto add_tables = [&](const std::vector<Grain>& pile, int dumps) {
      const std::vector<Grain> dumped = dumped_until(dumps);
      if (dumped.empty()) return;
      std::vector<int> numbers{scenario.output.sections};
      numbers.insert(numbers.end(), scenario.output.further_sections.begin(),
                     scenario.output.further_sections.end());
      for (const int n : numbers) {
        r.sections.push_back(analyse_sections(pile, dumped, bench->height, n, measured));
        r.sections.back().dumps = dumps;
      }
    };
    add_tables(r.final_state.grains, last);
    for (const RunOutcome::AfterDump& after : outcome.after_dumps) add_tables(after.pile.grains, after.dump);
    if (const std::vector<Grain> dumped = dumped_until(last); !dumped.empty()) {
      r.lateral = analyse_lateral(r.final_state.grains, dumped, bench->height, scenario.output.sections,
                                  static_cast<int>(dump_points(scenario).size()), 4, measured);
      analyse_inside_of(scenario, *bench, dumped, r);
    }
    r.profile = slope_profile(r.final_state.grains, bench->height);
    if (const auto line = slope_line(r.profile, bench->height)) {
      r.slope_angle = line->angle;
      const double cover = cover_on_face(r.profile, {bench->height, bench->slope_deg}) -
                           ball_radius(bench->base_layer, bench->ball_diameter);
      std::vector<WeighedValue> diameters;
      for (const Grain& g : r.original) diameters.push_back({g.diameter, g.mass});
      r.slope_cover = cover / mass_quantile(std::move(diameters), 0.5);
    }
  } else if (std::holds_alternative<BucketDump>(scenario.experiment)) {
    try {
      const HalfCone cone = analyse_half_cone(r.final_state.grains, dumped_until(last), measured);
      r.sections.push_back(cone.surface);
      r.slope_angle = cone.shape.angle;
    } catch (const std::invalid_argument&) {
      // A small heap, or one of a run that was ended early; put_together says so.
    }
  } else if (outcome.rebound_height) {
    r.rebound_height = outcome.rebound_height;
  } else if (!std::holds_alternative<DropTest>(scenario.experiment) && !r.final_state.grains.empty()) {
    r.repose = measure_repose(r.final_state.grains);
    r.heap = measure_heap_shape(r.final_state.grains, r.original, *r.repose, measured);
  }
  return r;
}

std::string why_no_slope_angle(const Scenario& scenario, const SeedResult& seed) {
  const BenchSpec* bench = bench_of(scenario);
  if (bench == nullptr || seed.slope_angle) return "";
  return fmt::format("no slope angle; too little of the pile's surface lies between {:g} and {:g} m",
                     kSlopeLow * bench->height, kSlopeHigh * bench->height);
}

RunResult put_together(const Scenario& scenario, std::vector<SeedResult> seeds,
                       std::vector<std::string> notes, const std::vector<ReferenceValue>& reference,
                       double wall_seconds) {
  RunResult result;
  result.title = scenario.title;
  result.scenario = scenario.name;
  result.engine = scenario.engine == EngineKind::rrlinear ? "rrlinear" : "impulse";
  result.version = fmt::format("{} ({})", SCREE_VERSION, SCREE_REVISION);
  result.seeds = std::move(seeds);
  result.notes = std::move(notes);
  result.wall_seconds = wall_seconds;
  if (const BenchSpec* bench = bench_of(scenario)) result.bench_height = bench->height;
  result.effects = effects_in_words(scenario);
  if (!unfinished(result))
    result.comparison = compare_with_reference(outputs_of(result.seeds), reference, scenario.compare);

  for (std::string& note : comparison_notes(result.comparison)) result.notes.push_back(std::move(note));

  double overlap = 0, lost = 0, mass = 0, left_out = 0, carried = 0;
  std::int64_t squeezed = 0, crowded = 0;
  std::int64_t lost_count = 0;
  for (const SeedResult& s : result.seeds) {
    for (const std::string& failure : s.failures)
      result.failures.push_back(fmt::format("seed {}: {}", s.seed, failure));
    overlap = std::max(overlap, s.largest_overlap_ratio);
    carried += s.carried_back.value_or(0);
    lost += s.lost_mass, lost_count += s.lost_particles, mass += s.mass;
    squeezed += s.squeezed_into_walls, crowded += s.crowded_contacts;
    if (!s.sections.empty()) left_out += s.sections.front().mass_outside;
    if (const std::string why = why_no_slope_angle(scenario, s); !why.empty())
      result.notes.push_back(fmt::format("seed {}: {}", s.seed, why));
    if (bench_of(scenario) && s.slope_angle && lies_thin(s))
      result.notes.push_back(fmt::format(
          "seed {}: over the middle of the bench's face the rock lies {} thick on average, five grains (D50) "
          "are needed: its slope is the face's more than its own",
          s.seed,
          s.slope_cover < 1 ? std::string("less than a grain")
                            : decimals_text(s.slope_cover, 1) + " grains"));
    if (s.interrupted)
      result.notes.push_back(fmt::format("seed {} was ended by the user: its pile is not finished", s.seed));
    else if (std::holds_alternative<BucketDump>(scenario.experiment) && s.sections.empty())
      result.notes.push_back(
          fmt::format("seed {}: no cone can be fitted to the heap, and so it has no sections; more or larger "
                      "buckets may help",
                      s.seed));
    if (s.heap && s.repose && s.heap->rings.mass_outside > kMuchBeyondHeap * s.mass)
      result.notes.push_back(
          fmt::format("seed {}: {:.0f} % of the rock lies beyond the heap's radius R = {} m, out to which "
                      "grains touch: its "
                      "rings leave it out, the slope of the flank does not",
                      s.seed, 100 * s.heap->rings.mass_outside / s.mass, decimals_text(s.repose->radius, 2)));
    if (const std::string why = why_no_repose_angle(s); !why.empty())
      result.notes.push_back(fmt::format("seed {}: no repose angle: {}", s.seed, why));
  }
  const bool impulse = scenario.engine == EngineKind::impulse;
  if (overlap > kOverlapWarning && impulse)
    result.notes.push_back(fmt::format(
        "the largest overlap was {:.0f} % of the smaller radius; lower numerics.impulse_step_ratio or raise "
        "numerics.impulse_iterations",
        100 * overlap));
  if (overlap > kOverlapWarning && !impulse)
    result.notes.push_back(fmt::format(
        "the largest overlap was {:.0f} % of the smaller radius, above {:.0f} %: spheres this soft deform "
        "too much "
        "under impact; raise material.effective_modulus_pa to see whether the result depends on it",
        100 * overlap, 100 * kOverlapWarning));
  if (lost_count > 0)
    result.notes.push_back(
        fmt::format("{} spheres ({:.2f} t, {:.2f} % of the mass) left the model and are not in the pile",
                    lost_count, lost / 1000, 100 * lost / mass));
  if (carried > 0)
    result.notes.push_back(
        fmt::format("{:.1f} t ({:.1f} % of the mass) stayed in the bed or bucket and left with it; they are "
                    "not in the pile, but in the rock as dumped that it is compared with",
                    carried / 1000 / static_cast<double>(result.seeds.size()), 100 * carried / mass));
  if (squeezed > 0)
    result.notes.push_back(
        fmt::format("{} times a sphere was found more than half inside a wall (squeezed through it, or a "
                    "tool was put where it lay); "
                    "it was not shot out, but may have passed",
                    squeezed));
  if (crowded > 0)
    result.notes.push_back(fmt::format(
        "{} contacts with meshes were left out because a sphere touched more than {} surfaces at once",
        crowded, kMeshContactSlots));
  if (left_out > 0 && bench_of(scenario))
    result.notes.push_back(fmt::format(
        "{:.1f} t ({:.1f} % of the rock) lie above the crest's height and belong to no section",
        left_out / 1000 / static_cast<double>(result.seeds.size()), 100 * share_in_no_section(result)));
  const Measurement measured = measurement_of(scenario);
  if (!measured.truthful())
    result.notes.emplace_back(
        "gradings of sections, strips, cells and rings are as effects of measurement make them; angles, "
        "layers and the inside of the pile are true");
  if (measured.own_reference > 0)
    result.notes.push_back(fmt::format(
        "chi and ratios to the rock as dumped of sections, strips, cells and rings refer to the pile "
        "itself by {:.0f} % (effects.own_reference)",
        100 * measured.own_reference));
  if (scenario.bullet)
    result.notes.push_back(
        scenario.bullet->error_deg
            ? fmt::format("engine impulse: Bullet's friction {:.3g} and rolling friction {:.3g} stand for mu "
                          "and mu_r; "
                          "where they were found they give rrlinear's repose angle within {:.1f} degrees",
                          scenario.bullet->friction, scenario.bullet->rolling, *scenario.bullet->error_deg)
            : "engine impulse: Bullet's friction and rolling friction were set by hand; nothing is known of "
              "how "
              "near the result is to rrlinear's");
  return result;
}

}  // namespace scree
