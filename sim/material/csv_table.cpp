#include "sim/material/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace scree {

CsvTable::CsvTable(const std::filesystem::path& file, const std::vector<std::string>& columns)
    : table_(file) {
  if (table_.header() != columns) fail(fmt::format("the header must be '{}'", fmt::join(columns, ",")));
}

std::size_t CsvTable::at(const std::string& column) const {
  const auto& header = table_.header();
  const auto found = std::find(header.begin(), header.end(), column);
  if (found == header.end()) throw std::logic_error("no column " + column);
  return static_cast<std::size_t>(found - header.begin());
}

const std::string& CsvTable::text(const std::string& column) const {
  const std::string& value = table_.field(at(column));
  if (value.empty()) fail(fmt::format("{} is empty", column));
  return value;
}

const std::string& CsvTable::one_of(const std::string& column,
                                    const std::vector<std::string>& allowed) const {
  const std::string& value = table_.field(at(column));
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
    fail(fmt::format("{} '{}' is none of {}", column, value, fmt::join(allowed, " ")));
  return value;
}

std::optional<double> CsvTable::optional_number(const std::string& column) const {
  return table_.number(at(column));
}

double CsvTable::number(const std::string& column) const {
  text(column);
  return *optional_number(column);
}

}  // namespace scree
