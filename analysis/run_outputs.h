#pragma once
// What a sweep keeps of a run: its numbers, by name.
#include <map>
#include <string>

namespace scree {

/// The numbers of a summary.json with one seed: of a repose test angle_deg, height_over_radius_deg,
/// half_coverage_deg, height_m, radius_m, runaways; of a dump chi_S1, mass_t_S1, d50_m_S1 ... for each
/// section, and slope_angle_deg; of a drop test rebound_height_m; of all particles, simulated_seconds,
/// largest_overlap_ratio, lost_mass_t, at_rest (0 or 1). A number that does not exist is left out. Throws
/// std::runtime_error if it is not a summary.
std::map<std::string, double> run_outputs(const std::string& summary);

/// Empty if a scenario with an experiment of this type (end_dump, push_dump, bucket_dump, repose_lift,
/// drop_test) gives an output of this name; else a message that says what it gives.
std::string why_not_given(const std::string& experiment, const std::string& output);

}  // namespace scree
