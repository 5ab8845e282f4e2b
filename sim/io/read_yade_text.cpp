// Text of YADE, as export.text writes it: a line "#format x_y_z_r", whose second word names the columns, then
// a line a grain. Other lines with # are comments.
#include <fmt/format.h>

#include <algorithm>

#include "sim/io/snapshot_formats.h"

namespace scree {
namespace {

struct Columns {
  int x = -1, y = -1, z = -1, radius = -1, id = -1;
  std::size_t count = 0;
  bool further = false;  // behind these; "attrs" stands for as many as there are
};

Columns columns_of(const TextCursor& cursor, std::string_view format) {
  Columns columns;
  for (const std::string_view name : parts_of(format, "_", kMostColumns + 1)) {
    const std::string_view meaning = meaning_of_column(name);
    int* column = meaning == "x"        ? &columns.x
                  : meaning == "y"      ? &columns.y
                  : meaning == "z"      ? &columns.z
                  : meaning == "radius" ? &columns.radius
                  : meaning == "id"     ? &columns.id
                                        : nullptr;
    if (column != nullptr && *column >= 0)
      cursor.fail(fmt::format("format {:.100}: two columns are '{}'", format, meaning));
    if (column != nullptr) *column = static_cast<int>(columns.count);
    ++columns.count;
  }
  columns.further = format.ends_with("_attrs");
  if (columns.further) --columns.count;
  if (columns.count > kMostColumns) cursor.fail(fmt::format("more than {} columns", kMostColumns));
  if (std::min({columns.x, columns.y, columns.z, columns.radius}) < 0)
    cursor.fail(fmt::format(
        "format '{:.100}' does not name x, y, z and r; export it with format='x_y_z_r', or name its columns "
        "there",
        format));
  return columns;
}

}  // namespace

RawSnapshot read_yade_text(const std::filesystem::path& file, std::string_view text) {
  TextCursor cursor(file, text);
  const TextCursor header = cursor;
  const Columns columns = columns_of(header, trimmed(cursor.next_line().substr(kYadeFormat.size())));
  RawSnapshot raw;
  raw.has_id = columns.id >= 0;
  while (!cursor.done()) {
    const TextCursor row = cursor;
    const std::string_view line = trimmed(cursor.next_line());
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string_view> words = parts_of(line, " \t", kMostColumns + 1);
    if (words.size() < columns.count || (words.size() > columns.count && !columns.further))
      row.fail(fmt::format("{} values, the format has {} columns", words.size(), columns.count));
    const auto number = [&](int at) {
      const auto value = number_in(words[static_cast<std::size_t>(at)]);
      if (!value) row.fail(fmt::format("'{:.40}' is no finite number", words[static_cast<std::size_t>(at)]));
      return *value;
    };
    const GrainPlace place{file, row.line(), raw.grains.size()};
    Grain grain;
    grain.position = {number(columns.x), number(columns.y), number(columns.z)};
    grain.diameter = diameter_of({}, number(columns.radius), place);
    if (raw.has_id) grain.id = id_of(number(columns.id), place);
    raw.grains.push_back(grain);
    raw.lines.push_back(row.line());
  }
  return raw;
}

}  // namespace scree
