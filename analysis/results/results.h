#pragma once
// What a run ends with, in the form that summary.json, the tables and the report share.
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/pile/flow.h"
#include "analysis/pile/heap_shape.h"
#include "analysis/pile/inside.h"
#include "analysis/pile/lateral.h"
#include "analysis/pile/layers.h"
#include "analysis/pile/repose_angle.h"
#include "analysis/pile/segregation.h"
#include "analysis/results/energy_terms.h"
#include "analysis/statistics/mean_std.h"

namespace scree {

/// One seed of a run.
struct SeedResult {
  std::uint64_t seed = 0;
  std::int64_t particles = 0;  ///< movable spheres
  double mass = 0;             ///< kg put in
  double wall_seconds = 0, simulated_seconds = 0;
  double particle_steps = 0;  ///< sum over steps of spheres moved
  std::int64_t steps = 0;
  double time_step_min = 0, time_step_max = 0;  ///< s
  double largest_overlap_ratio = 0;             ///< overlap over the smaller radius
  std::int64_t lost_particles = 0;
  double lost_mass = 0;                  ///< kg
  std::optional<double> carried_back;    ///< kg, that stayed in bed or bucket and left with it
  std::int64_t squeezed_into_walls = 0;  ///< mesh contacts that began inside a closed mesh
  std::int64_t crowded_contacts = 0;     ///< mesh contacts left out because a sphere had too many
  std::optional<EnergyTerms> energy;     ///< none with engine impulse
  std::vector<std::string> failures;     ///< of the watch (sim/scene/watch.h): the seed does not count
  bool at_rest = false;                  ///< every dump came to rest before max_time
  bool interrupted = false;
  Snapshot final_state;
  std::vector<Grain> original;  ///< every grain as generated (ids, diameters, masses)
  std::vector<SectionTable>
      sections;              ///< one for each number of sections asked for, or of the cells of a half cone
  std::vector<Grain> fixed;  ///< balls of the base layer
  std::optional<Lateral> lateral;        ///< dump over a bench: strips across the slope
  std::optional<Inside> inside;          ///< dump over a bench: section through the first dump point
  std::optional<Layers> layers;          ///< dump over a bench: layers in that section
  std::optional<double> largest_at_toe;  ///< share of the mass above the original D90 in the lowest sixth
  std::optional<FlowRecorder> flow;      ///< dump over a bench: speeds and depth of the flow
  std::optional<ReposeAngle> repose;     ///< repose test
  std::optional<HeapShape> heap;         ///< repose test: rings, form, runout
  std::optional<double> rebound_height;  ///< drop test, m
  std::vector<std::array<double, 2>> profile;  ///< slope profile (x, z) m: surface along the dump axis
  std::optional<double> slope_angle;           ///< degrees, fitted to the middle of the slope
  /// Thickness of the rock on the bench's face there, normal to it, over its D50; NaN when not known.
  double slope_cover = std::numeric_limits<double>::quiet_NaN();
};

/// Rock on the face in so thin a layer (of five D50) lies as its bed lies: the slope's angle is the face's.
inline bool lies_thin(const SeedResult& seed) {
  return seed.slope_cover < 5;
}

/// A printed value of the thesis.
struct ReferenceValue {
  std::string case_name;  ///< A1, cm_field_3sec, lab_repose ...
  std::string quantity;   ///< chi, d50, d50_rel, mass_t, angle; chi_scatter: deviation of chi between repeats
  std::string section;    ///< S1..S6, top|middle|bottom, or whole
  std::string kind;       ///< pfc3d | measured
  double value = 0;
  std::optional<double> std;
  std::string unit;
  std::string relation;                        ///< eq, approx, lt, gt, range ...
  std::string source;                          ///< table or line of the source
  std::optional<double> upper = std::nullopt;  ///< of a range; its lower end is `value`
  double rounding = 0;                         ///< half of the last digit printed; 0: derived
  int dumps = 0;  ///< number of dumps in the pile it was read from; 0: not stated
  std::optional<double> upper_std = std::nullopt;  ///< of `upper`, as std and rounding are of `value`
  double upper_rounding = 0;
  int repeats = 0;  ///< simulations behind `value`; 0: not given
};

/// Into how many sections the slope of a printed case was cut: told by the names top, middle, bottom (3) or
/// by the case's name (cm_field_3sec, qb_field_9sec); 6 otherwise (thesis, chapter 6).
int section_count(const ReferenceValue& reference);

/// What a printed number says of the mean: the value itself, a bound, two bounds, or (medians) nothing.
enum class Meaning { value, at_least, at_most, range, none };
Meaning meaning_of(const ReferenceValue& reference);

/// The numbers of one seed of a run, by name (outputs.h).
using Outputs = std::map<std::string, double>;

/// A simulated value held against a printed one.
struct Comparison {
  ReferenceValue reference;
  double simulated = 0;
  std::optional<double> simulated_std;  ///< between seeds; none with one seed
  /// (simulated - reference) / sqrt(reference_std^2 + simulated_std^2); none when neither is known. Where
  /// none is printed, the deviation of rounding stands for it (half of the last digit over sqrt 3). Of a
  /// bound: how far it is passed, 0 if it is kept; of a range, with the deviation of the bound that is
  /// passed.
  std::optional<double> z;
  /// The pile with as many dumps as the printed one was not kept; the finished one stands for it.
  bool finished_instead = false;
};

/// A whole run: everything that summary.json and the report say.
struct RunResult {
  std::string title, scenario, engine, version;
  std::vector<SeedResult> seeds;
  std::vector<Comparison> comparison;
  std::vector<std::string> effects;   ///< of the scenario with their values, a line each
  std::vector<std::string> failures;  ///< of the watch, a line each; none: the run counts
  std::vector<std::string> notes;     ///< warnings to the reader: overlaps above 10 %, lost mass, not at rest
  double bench_height = 0;            ///< m; 0 without a bench
  double wall_seconds = 0;            ///< of the whole command
};

/// Reads assets/reference/results.csv
/// (case,quantity,section,kind,value,std,unit,relation,source,dumps,rounding). A `min` and a `max` of the
/// same become one `range`.
std::vector<ReferenceValue> read_reference(const std::filesystem::path& file);

/// Holds the numbers of a run's seeds against reference cases (output_for in outputs.h says which number
/// against which value). Bounds are held against PFC3D's alone: measured ones are ranges of single places.
/// Throws std::invalid_argument for a case that is not there.
std::vector<Comparison> compare_with_reference(const std::vector<Outputs>& seeds,
                                               const std::vector<ReferenceValue>& reference,
                                               const std::vector<std::string>& cases);

/// What limits a comparison, a line each: cases held against another pile than the printed one.
std::vector<std::string> comparison_notes(const std::vector<Comparison>& comparison);

}  // namespace scree
