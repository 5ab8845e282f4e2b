#include "cli/printed_values.h"

#include <fmt/format.h>

#include <stdexcept>

#include "cli/commands.h"
#include "sim/material/input_bytes.h"

std::optional<std::vector<scree::ReferenceValue>> printed_values() {
  try {
    return scree::read_reference(asset_dir() / "reference" / "results.csv");
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "scree: {}\n", scree::one_line(error.what()));
    return std::nullopt;
  }
}
