#pragma once
// What the thesis prints, that commands hold results against.
#include <optional>
#include <vector>

#include "analysis/cases/reproduction.h"
#include "analysis/results/results.h"

// Tables of assets/reference; none, with a message, if one cannot be read. Asked for before anything is
// simulated.

/// results.csv
std::optional<std::vector<scree::ReferenceValue>> printed_values();
/// trends.csv
std::optional<std::vector<scree::Trend>> printed_trends();
