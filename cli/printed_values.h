#pragma once
// The values of the thesis that commands hold results against.
#include <optional>
#include <vector>

#include "analysis/results/results.h"

/// assets/reference/results.csv; none, with a message, if it cannot be read. Asked for before anything is
/// simulated.
std::optional<std::vector<scree::ReferenceValue>> printed_values();
