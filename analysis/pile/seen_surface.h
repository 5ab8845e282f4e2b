#pragma once
// What somebody who stands before a slope sees of it.
#include <vector>

#include "sim/io/snapshot.h"

namespace scree {

/// By grain of the pile: the share (0 to 1) of its outline that no other grain covers, seen along the normal
/// of a slope that falls by `angle_deg` degrees towards +x. Lines of sight lie a third of the smallest
/// diameter apart, or as far as 8 million of them take; a grain that none of them meets counts as covered.
/// Throws std::invalid_argument unless 0 <= angle_deg < 90.
std::vector<double> seen_shares(const std::vector<Grain>& pile, double angle_deg);

}  // namespace scree
