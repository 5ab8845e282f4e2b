// Grains from a table, and words and numbers from a text.
#include <fmt/format.h>

#include <map>
#include <regex>

#include "sim/io/snapshot_formats.h"

namespace scree {
namespace {

struct Unit {
  std::string_view name;
  double factor;
};
constexpr std::array<Unit, 4> kLengths{{{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}}};
constexpr std::array<Unit, 3> kMasses{{{"kg", 1}, {"g", 1e-3}, {"t", 1e3}}};

// Where a quantity stands, its factor to SI, and whether the column names its unit.
struct Column {
  std::size_t at;
  double factor;
  bool has_unit;
};

std::map<std::string, Column, std::less<>> columns_of(const std::filesystem::path& file,
                                                      const DelimitedTable& table, double length_unit) {
  static const std::regex bracket(R"((.*?)\s*[\[(]\s*(.*?)\s*[\])]\s*)"), suffix(R"((.*)_([a-z]{1,2}))");
  std::map<std::string, Column, std::less<>> columns;
  for (std::size_t k = 0; k < table.header().size(); ++k) {
    const std::string name = in_small_letters(table.header()[k]);
    std::string quantity(meaning_of_column(name)), unit;
    std::smatch parts;
    if (quantity.empty() &&
        (std::regex_match(name, parts, bracket) || std::regex_match(name, parts, suffix))) {
      quantity = meaning_of_column(parts[1].str());
      unit = parts[2];
    }
    if (quantity.empty()) continue;
    double factor = 1;
    bool has_unit = false;
    const bool mass = quantity == "mass",
               length = quantity.size() == 1 || quantity == "diameter" || quantity == "radius";
    if (length) factor = length_unit;
    if (!unit.empty() && (mass || length)) {
      const Unit* found = nullptr;
      if (mass)
        for (const Unit& each : kMasses) found = each.name == unit ? &each : found;
      else
        for (const Unit& each : kLengths) found = each.name == unit ? &each : found;
      if (found == nullptr)
        throw FileError(file, table.header_line(),
                        fmt::format("the unit of column '{}' is none of {}", table.header()[k],
                                    mass ? "kg, g, t" : "m, cm, mm, um"));
      factor = found->factor;
      has_unit = true;
    }
    if (!columns.emplace(quantity, Column{k, factor, has_unit}).second)
      throw FileError(file, table.header_line(), fmt::format("two columns are '{}'", quantity));
  }
  return columns;
}

// What stands in a column `mass` that names no unit is kilograms where all lengths are metres.
bool unknown_mass_unit(const std::map<std::string, Column, std::less<>>& columns) {
  const auto mass = columns.find("mass");
  if (mass == columns.end() || mass->second.has_unit) return false;
  return std::any_of(columns.begin(), columns.end(),
                     [](const auto& column) { return column.second.factor != 1; });
}

}  // namespace

RawSnapshot read_csv_snapshot(const std::filesystem::path& file, double length_unit) {
  DelimitedTable table(file);
  const auto columns = columns_of(file, table, length_unit);
  const auto has = [&](std::string_view name) { return columns.find(name) != columns.end(); };
  const auto& names = table.header();
  if (std::all_of(names.begin(), names.end(), [](const std::string& name) { return number_in(name); }))
    throw FileError(
        file, table.header_line(),
        "no header: a line that names the columns x, y, z and diameter or radius is needed before the "
        "numbers");
  for (const char* name : {"x", "y", "z"})
    if (!has(name))
      throw FileError(file, table.header_line(),
                      fmt::format("no column {}; x, y, z and diameter or radius are needed, found: {:.200}",
                                  name, fmt::format("{}", fmt::join(table.header(), ", "))));
  if (!has("diameter") && !has("radius"))
    throw FileError(file, table.header_line(), "no radius: a column diameter or radius is needed");
  RawSnapshot raw;
  raw.in_metres = true;
  raw.unknown_mass_unit = unknown_mass_unit(columns);
  raw.has_mass = has("mass"), raw.has_id = has("id"), raw.has_dump = has("dump");
  while (table.next()) {
    const GrainPlace place{file, table.line(), raw.grains.size()};
    const auto value = [&](std::string_view name) {
      const Column& column = columns.find(name)->second;
      const auto number = table.number(column.at);
      if (!number) table.fail(fmt::format("{} is empty", table.header()[column.at]));
      return *number * column.factor;
    };
    const auto value_if_any = [&](std::string_view name) -> std::optional<double> {
      if (!has(name) || !table.number(columns.find(name)->second.at)) return std::nullopt;
      return value(name);
    };
    Grain grain;
    grain.position = {value("x"), value("y"), value("z")};
    grain.diameter = has("diameter") ? diameter_of(value("diameter"), value_if_any("radius"), place)
                                     : diameter_of({}, value("radius"), place);
    if (raw.has_mass) grain.mass = value("mass");
    if (raw.has_id) grain.id = id_of(value("id"), place);
    if (raw.has_dump) grain.dump = dump_of(value("dump"), place);
    raw.grains.push_back(grain);
    raw.lines.push_back(table.line());
  }
  return raw;
}

std::vector<std::string_view> parts_of(std::string_view text, std::string_view separators, std::size_t most) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0;
       parts.size() < most && (at = text.find_first_not_of(separators, at)) != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(separators, at), text.size());
    parts.push_back(text.substr(at, end - at));
    at = end;
  }
  return parts;
}

std::string_view TextCursor::next_line() {
  const std::size_t from = at_, end = std::min(text_.find('\n', at_), text_.size());
  if (done()) return {};
  at_ = end + 1;
  ++line_;
  std::string_view line = text_.substr(from, end - from);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::string_view TextCursor::word() {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; };
  for (; !done() && blank(text_[at_]); ++at_) line_ += text_[at_] == '\n';
  const std::size_t from = at_;
  while (!done() && !blank(text_[at_])) ++at_;
  return text_.substr(std::min(from, text_.size()), at_ - from);
}

std::string_view TextCursor::bytes(std::size_t count) {
  if (at_ > text_.size() || count > text_.size() - at_) fail("the file ends before its data do");
  at_ += count;
  return text_.substr(at_ - count, count);
}

double TextCursor::number() {
  const std::string_view text = word();
  if (text.empty()) fail("the file ends before its data do");
  const auto value = number_in(text);
  if (!value) fail(fmt::format("'{:.40}' is no finite number", text));
  return *value;
}

}  // namespace scree
