#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "analysis/results/results.h"
#include "sim/material/csv_table.h"

namespace scree {

namespace {

constexpr int kMostCounted = 1'000'000;  // dumps, repeats

// Makes a range of a bound and the other one of the same, if that is there.
bool joined(const ReferenceValue& row, std::vector<ReferenceValue>& values) {
  if (row.relation != "min" && row.relation != "max") return false;
  for (ReferenceValue& other : values) {
    if (other.case_name != row.case_name || other.quantity != row.quantity || other.section != row.section ||
        other.kind != row.kind || other.relation != (row.relation == "min" ? "max" : "min"))
      continue;
    ReferenceValue above = row;
    if (above.value < other.value) std::swap(above, other);
    other.upper = above.value;
    other.upper_std = above.std;
    other.upper_rounding = above.rounding;
    if (above.source != other.source) other.source += "; " + above.source;
    other.relation = "range";
    return true;
  }
  return false;
}

// 0 where nothing stands.
int optional_count(CsvTable& table, const char* column) {
  const std::optional<double> count = table.optional_number(column);
  if (!count) return 0;
  if (*count != std::floor(*count) || *count < 1 || *count > kMostCounted)
    table.fail(fmt::format("{} {} is no whole number from 1 to {}", column, *count, kMostCounted));
  return static_cast<int>(*count);
}

}  // namespace

std::vector<ReferenceValue> read_reference(const std::filesystem::path& file) {
  CsvTable table(file, {"case", "quantity", "section", "kind", "value", "std", "unit", "relation", "source",
                        "dumps", "rounding", "repeats"});
  std::vector<ReferenceValue> values;
  while (table.next()) {
    ReferenceValue row;
    row.case_name = table.text("case");
    row.quantity = table.text("quantity");
    row.section = table.text("section");
    row.kind = table.one_of("kind", {"pfc3d", "measured"});
    row.value = table.number("value");
    row.std = table.optional_number("std");
    if (row.std && *row.std < 0) table.fail(fmt::format("std {} is below 0", *row.std));
    row.rounding = table.optional_number("rounding").value_or(0);
    if (row.rounding < 0) table.fail(fmt::format("rounding {} is below 0", row.rounding));
    row.unit = table.one_of("unit", {"m", "t", "deg", "-"});
    row.relation = table.one_of(
        "relation", {"eq", "approx", "lt", "le", "gt", "min", "max", "mean", "median", "derived"});
    row.source = table.text("source");
    row.dumps = optional_count(table, "dumps");
    row.repeats = optional_count(table, "repeats");
    if (!joined(row, values)) values.push_back(std::move(row));
  }
  return values;
}

}  // namespace scree
