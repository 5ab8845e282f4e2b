#pragma once
// How much of the coarsest rock runs to the toe.
#include <vector>

#include "sim/io/snapshot.h"

namespace scree {

/// Of the mass of the blocks larger than the diameter that `quantile` (0 to 1) of the original's mass passes,
/// the share that lies in the lowest sixth of the slope by height (centre at or below crest_height / 6, the
/// floor before the toe included). Blocks above the crest count among the mass. `original`: every grain as
/// dumped. NaN when the pile has no such block. Throws std::invalid_argument when `original` is empty, the
/// quantile lies outside 0 to 1 or the crest height (m) is not above 0.
double share_reaching_toe(const std::vector<Grain>& pile, double crest_height,
                          const std::vector<Grain>& original, double quantile = 0.9);

/// The same of the blocks larger than `diameter` (m).
double share_reaching_toe_above(const std::vector<Grain>& pile, double crest_height, double diameter);

}  // namespace scree
