#pragma once
// Snapshots of any program as the outputs of a run.
#include <string>
#include <vector>

#include "analysis/results/results.h"
#include "sim/io/snapshot_reader.h"
#include "sim/scene/scenario.h"

namespace scree {

/// The outputs (analysis/results/outputs.h) that a pile has by itself, by the analysis of a run: none of
/// those that speak of the run, and of layers and dump points only where grains say which dump brought them.
/// chi and ratios are against the grains dumped where the file has them (a trajectory of scree), else against
/// the scenario's grading, or the pile's own rock without one (`scenario.grading_file` empty). `notes`: what
/// a reader should know. Throws std::invalid_argument for a pile that cannot be analysed.
Outputs outputs_of_snapshot(const Scenario& scenario, SnapshotRead read, std::vector<std::string>& notes);

/// Grains of equal mass that have a grading: its passing curve to 1 / `count`.
std::vector<Grain> grains_of(const Grading& grading, double mass, int count = 4000);

}  // namespace scree
