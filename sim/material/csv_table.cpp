#include "sim/material/csv_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>

namespace scree {
namespace {

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> fields;
  for (;;) {
    const auto comma = line.find(',');
    fields.emplace_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& file, std::vector<std::string> columns)
    : file_(file), text_(read_input_text(file)), columns_(std::move(columns)) {
  std::string header;
  const std::string expected = fmt::format("{}", fmt::join(columns_, ","));
  if (!next_line(header)) {
    ++line_number_;
    fail(fmt::format("the header '{}' is missing", expected));
  }
  if (header != expected) fail(fmt::format("the header must be '{}'", expected));
}

bool CsvTable::next_line(std::string& line) {
  while (at_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line.assign(text_, at_, end - at_);
    at_ = end + 1;
    ++line_number_;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (!line.empty() && line.front() != '#') return true;
  }
  return false;
}

bool CsvTable::next() {
  std::string line;
  if (!next_line(line)) return false;
  fields_ = split(line);
  if (fields_.size() != columns_.size())
    fail(fmt::format("{} columns, {} are needed", fields_.size(), columns_.size()));
  return true;
}

const std::string& CsvTable::field(const std::string& column) const {
  const auto at = std::find(columns_.begin(), columns_.end(), column);
  if (at == columns_.end()) throw std::logic_error("no column " + column);
  return fields_.at(static_cast<std::size_t>(at - columns_.begin()));
}

const std::string& CsvTable::text(const std::string& column) const {
  const std::string& value = field(column);
  if (value.empty()) fail(fmt::format("{} is empty", column));
  return value;
}

const std::string& CsvTable::one_of(const std::string& column,
                                    const std::vector<std::string>& allowed) const {
  const std::string& value = field(column);
  if (std::find(allowed.begin(), allowed.end(), value) == allowed.end())
    fail(fmt::format("{} '{}' is none of {}", column, value, fmt::join(allowed, " ")));
  return value;
}

std::optional<double> CsvTable::optional_number(const std::string& column) const {
  const std::string& text = field(column);
  if (text.empty()) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    fail(fmt::format("{} '{}' is no number", column, text));
  return value;
}

double CsvTable::number(const std::string& column) const {
  text(column);
  return *optional_number(column);
}

void CsvTable::fail(const std::string& what) const {
  throw FileError(file_, line_number_, what);
}

}  // namespace scree
