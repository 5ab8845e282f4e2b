#pragma once
// The numbers of a run by name: what sweeps keep, calibrations aim at, and printed values are held against.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/results/results.h"

namespace scree {

/// The numbers of one seed: of all runs particles, simulated_seconds, largest_overlap_ratio, lost_mass_t,
/// at_rest (0 or 1); of a repose test angle_deg, height_over_radius_deg, half_coverage_deg, height_m,
/// radius_m, runaways, of its rings in plan (heap_shape.h) chi_ring1, d50_rel_ring1, mass_share_ring1 (the
/// middle) to ring3, and profile_25, profile_50, profile_75 (height of the surface at a share of the radius),
/// spread_95 (runout); of a drop test rebound_height_m; of a dump slope_angle_deg, sections, dumps,
/// share_above_1m_orig, chi_zero_x_over_l (where chi changes sign along the slope) and chi_S1, mass_t_S1,
/// d50_m_S1 ... for each section, and of a dump over a bench lateral_chi_std_S1, lateral_chi_range_S1,
/// lateral_d50_rel_std_S1 (over strips across the slope, lateral.h), point1_toe_width_m, flow_speed_S1 and
/// flow_fast_S1 (mean and highest 95th percentile of speed, m/s), flow_depth_m, arrival_energy_j_per_kg,
/// arrival_share_of_drop (flow.h), inside_porosity, inside_mean_abs_chi, inside_ksat_contrast (inside.h),
/// layer_coarsening_down, layer_variance_between, layer_variance_by_chance (layers.h), largest_at_toe. Tables
/// beside the scenario's own number of sections have names like chi_S1of3, piles before the last dump names
/// like chi_S1_dump3 or chi_S1of3_dump3. A number that does not exist is left out.
/// inside_... and layer_... are of a section through the first dump point: the rock within 4 m of it on
/// either side (half a truck bed or blade), in cells of a tenth of the bench's height. flow_depth_m is that
/// of a band of 2 m on either side of the same point (FlowSettings::half_width).
/// carried_back_t, of trucks and buckets, is rock that stayed in them (they can be weighed).
Outputs outputs_of(const SeedResult& seed);
std::vector<Outputs> outputs_of(const std::vector<SeedResult>& seeds);

/// An output says something of the run, its scenario or its grading that cannot be measured on a pile:
/// particles, simulated_seconds, largest_overlap_ratio, lost_mass_t, at_rest, sections, dumps,
/// share_above_1m_orig.
bool is_of_the_run(const std::string& output);

/// A number of a pile under the names of printed values.
struct PileValue {
  std::string quantity, section;  ///< as in ReferenceValue
  int sections = 6;               ///< into which the slope is cut
  int dumps = 0;                  ///< in the pile; 0: the finished one
};
PileValue pile_value(const ReferenceValue& reference);

/// The output that is this number, of those given; none if there is none. A value of the pile after some dump
/// is that pile's, or the finished one's where that was not kept.
std::optional<std::string> output_name_for(const PileValue& value, const Outputs& outputs);
std::optional<double> output_for(const PileValue& value, const Outputs& outputs);
/// The finished pile stands for one that was not kept.
bool finished_pile_instead(const PileValue& value, const Outputs& outputs);

/// What decides which outputs a scenario gives.
struct OutputScope {
  std::string experiment;  ///< end_dump, push_dump, bucket_dump, repose_lift, drop_test
  int sections = 6;
  std::vector<int> further_sections, after_dumps;
  bool measured = false;  ///< only those that can be measured on a pile (is_of_the_run)
};

/// Empty if such a scenario gives an output of this name; else a message that says what it gives.
std::string why_not_given(const OutputScope& scope, const std::string& output);

}  // namespace scree
