#pragma once
// Hydraulic conductivity of the parts of a simulated pile, as a table.
#include <filesystem>

#include "analysis/results/results.h"

namespace scree {

/// Writes a row a section of the finished pile's first table, a row for the lowest over the highest section,
/// and a row a cell of its inside that has a grading, for each seed:
///   seed, part (S1 ..., S6/S1, cell), x_m, z_m (middle of the cell), porosity, d10_m, d50_m, cu,
///   ksat_kcm_rel, ksat_taylor_rel      over the rock as dumped at equal void ratio: what the grading does
///   ksat_kcm_rel_voids, ksat_taylor_rel_voids   with the cell's own porosity against the mean inside
///   ksat_kcm_m_per_s, ksat_taylor_m_per_s       at the cell's own porosity, of sections at the mean inside
/// after analysis/pile/permeability.h; empty where a number has no meaning. Nothing is written for runs
/// without sections. Throws std::runtime_error if the file cannot be written.
void write_conductivity_csv(const RunResult& result, const std::filesystem::path& file);

}  // namespace scree
