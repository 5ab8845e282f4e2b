#pragma once
// Picture of the velocities of a load that flows down the slope.
#include "analysis/pile/vertical_section.h"
#include "analysis/report/pictures.h"
#include "sim/io/snapshot.h"

namespace scree {

/// Grains of a moment of a dump, for example FlowRecorder::liveliest(), coloured by their speed; those slower
/// than `moving_speed` (m/s) are grey, and so are `fixed` balls (may be empty). Arrows are the mean velocity,
/// by mass, of the moving grains that are drawn, in each cell of the section that has at least 3 of them and
/// is not slower than a tenth of the fastest. Throws std::invalid_argument when no grain lies in the section,
/// std::runtime_error as run_gnuplot.
Picture draw_velocity(const Snapshot& snapshot, const std::vector<Grain>& fixed,
                      const VerticalSection& section, const std::filesystem::path& file,
                      double moving_speed = 0.1);

}  // namespace scree
