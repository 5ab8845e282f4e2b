#pragma once
// Pictures of a field analysis.
#include <filesystem>
#include <vector>

#include "analysis/field/field_analysis.h"
#include "analysis/report/pictures.h"

namespace scree {

/// Envelopes of the passing curves, histograms, segregation degrees and their fit, conductivities, and the
/// curve with fines, as far as pictures tell of them; SVG in a folder that is there. Throws
/// std::runtime_error, see run_gnuplot.
std::vector<Picture> draw_field(const FieldAnalysis& field, const std::filesystem::path& folder);

}  // namespace scree
