#pragma once
// Pictures of the inside of a pile.
#include "analysis/pile/inside.h"
#include "analysis/report/pictures.h"

namespace scree {

/// Grains of the section as discs coloured by their dump: the layers. `fixed` balls are grey, may be empty.
/// Throws std::invalid_argument when no grain lies in the section, std::runtime_error as run_gnuplot.
Picture draw_layers(const std::vector<Grain>& pile, const std::vector<Grain>& fixed,
                    const VerticalSection& section, const std::filesystem::path& file);

/// Maps of segregation degree, porosity and conductivity (Kozeny-Carman, over the original's) of the cells,
/// below each other with the bench; cells without a number are grey. Throws std::invalid_argument unless
/// shows_rock(), std::runtime_error as run_gnuplot.
Picture draw_inside(const Inside& inside, const std::filesystem::path& file);

/// A cell at least holds rock enough to be drawn.
bool shows_rock(const Inside& inside);

}  // namespace scree
