#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string_view>

#include "analysis/results.h"

namespace scree {

namespace {

constexpr std::string_view header = "case,quantity,section,kind,value,std,unit,relation,source,dumps";
constexpr std::size_t columns = 10;

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> fields;
  for (;;) {
    const auto comma = line.find(',');
    fields.emplace_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::vector<ReferenceValue> read_reference(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(fmt::format("{}: cannot be opened", file.string()));
  static const std::set<std::string> kinds{"pfc3d", "measured"};
  static const std::set<std::string> units{"m", "t", "deg", "-"};
  static const std::set<std::string> relations{"eq",  "approx", "lt",   "le",     "gt",
                                               "min", "max",    "mean", "median", "derived"};
  std::vector<ReferenceValue> values;
  std::string line;
  int line_number = 0;
  bool header_seen = false;
  const auto fail = [&](const std::string& what) {
    throw std::runtime_error(fmt::format("{}:{}: {}", file.string(), line_number, what));
  };
  const auto one_of = [&](const std::string& what, const std::string& field,
                          const std::set<std::string>& allowed) {
    if (allowed.contains(field)) return;
    std::string list;
    for (const std::string& each : allowed) list += " " + each;
    fail(fmt::format("{} '{}' is none of{}", what, field, list));
  };
  while (std::getline(stream, line)) {
    ++line_number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    if (!header_seen) {
      if (line != header) fail(fmt::format("the header must be '{}'", header));
      header_seen = true;
      continue;
    }
    const auto fields = split(line);
    if (fields.size() != columns) fail(fmt::format("{} columns, {} are needed", fields.size(), columns));
    ReferenceValue row;
    row.case_name = fields[0];
    row.quantity = fields[1];
    row.section = fields[2];
    row.kind = fields[3];
    row.unit = fields[6];
    row.relation = fields[7];
    row.source = fields[8];
    for (const std::size_t i : {0, 1, 2, 8})
      if (fields[i].empty()) fail(fmt::format("column {} is empty", i + 1));
    one_of("kind", row.kind, kinds);
    one_of("unit", row.unit, units);
    one_of("relation", row.relation, relations);
    const auto value = number(fields[4]);
    if (!value) fail(fmt::format("value '{}' is no number", fields[4]));
    row.value = *value;
    if (!fields[5].empty()) {
      row.std = number(fields[5]);
      if (!row.std || *row.std < 0) fail(fmt::format("std '{}' is no number of 0 or more", fields[5]));
    }
    if (!fields[9].empty()) {
      const auto dumps = number(fields[9]);
      if (!dumps || *dumps < 1 || *dumps != std::floor(*dumps))
        fail(fmt::format("dumps '{}' is no number of 1 or more", fields[9]));
      row.dumps = static_cast<int>(*dumps);
    }
    values.push_back(std::move(row));
  }
  ++line_number;
  if (!header_seen) fail(fmt::format("the header '{}' is missing", header));
  return values;
}

}  // namespace scree
