#include "cli/printed_values.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "cli/commands.h"
#include "sim/material/input_bytes.h"

namespace {

template <class Row>
std::optional<std::vector<Row>> read_or_say(std::vector<Row> (*read)(const std::filesystem::path&),
                                            const char* table) {
  try {
    return read(asset_dir() / "reference" / table);
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "scree: {}\n", scree::one_line(error.what()));
    return std::nullopt;
  }
}

}  // namespace

std::optional<std::vector<scree::ReferenceValue>> printed_values() {
  return read_or_say(scree::read_reference, "results.csv");
}

std::optional<std::vector<scree::Trend>> printed_trends() {
  return read_or_say(scree::read_trends, "trends.csv");
}
