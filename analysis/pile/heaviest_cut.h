#pragma once
// Where to cut a pile so that most of it is seen.
#include <vector>

#include "sim/io/snapshot.h"

namespace scree {

/// Whether a grain's middle lies behind a cut at y = `cut`, within `depth` of it (m).
bool in_cut(const Grain& grain, double cut, double depth);

/// y (m) of the cut that shows most mass of `grains` (at least one) within `depth` (0 or more, m) behind it;
/// of those that show within 2 % as much, the one nearest y = 0.
double heaviest_cut(std::vector<Grain> grains, double depth);

}  // namespace scree
