// Extended XYZ, as OVITO and ASE write it: a count, a line with Properties=name:type:columns:..., a line a
// grain; frame after frame.
#include <fmt/format.h>

#include <algorithm>

#include "sim/io/snapshot_formats.h"

namespace scree {
namespace {

constexpr double kMostGrains = 1e18;  // a file ends before

struct Frame {
  std::size_t at = 0;  // of its second line
  int line = 0;
  std::size_t count = 0;
};

// Where the wanted frame is; by default the last.
Frame frame_of(const std::filesystem::path& file, std::string_view text, std::optional<int> wanted) {
  Frame chosen;
  std::size_t frames = 0;
  TextCursor cursor(file, text);
  while (cursor.rest().find_first_not_of(" \t\r\n") != std::string_view::npos) {
    const std::string_view first = trimmed(cursor.next_line());
    const auto number = number_in(first);
    if (!number || !integer_in(*number, 0, kMostGrains))
      throw FileError(
          file, cursor.line() - 1,
          fmt::format("'{:.40}' is no number of grains, with which a frame of XYZ begins", first));
    Frame frame{text.size() - cursor.rest().size(), cursor.line(), 0};
    ++frames;
    cursor.next_line();
    for (; static_cast<double>(frame.count) < *number; ++frame.count) {
      if (cursor.done())
        cursor.fail(fmt::format("the file ends after {} of {:.15g} grains of frame {}", frame.count, *number,
                                frames));
      cursor.next_line();
    }
    if (!wanted || static_cast<std::size_t>(*wanted) == frames) chosen = frame;
  }
  frame_index(file, wanted, frames);
  return chosen;
}

// The value of a key of the second line; in double quotes it may have blanks.
std::string_view value_of(std::string_view line, std::string_view key) {
  for (std::size_t at = 0; at < line.size();) {
    at = line.find_first_not_of(" \t", at);
    if (at == std::string_view::npos) break;
    const std::size_t equals = line.find_first_of("= \t", at);
    if (equals == std::string_view::npos) break;
    const std::string_view name = line.substr(at, equals - at);
    at = equals + 1;
    if (line[equals] != '=') continue;
    const bool quoted = at < line.size() && line[at] == '"';
    at += quoted;
    const std::size_t end =
        std::min(quoted ? line.find('"', at) : line.find_first_of(" \t", at), line.size());
    if (name.size() == key.size() && in_small_letters(name) == in_small_letters(key))
      return line.substr(at, end - at);
    at = end + quoted;
  }
  return {};
}

struct Columns {
  int position = -1, velocity = -1;  // the first of three
  int diameter = -1, radius = -1, mass = -1, id = -1, dump = -1;
  int count = 0;
};

Columns columns_of(const TextCursor& cursor, std::string_view properties) {
  // Each has a column at least: one more of them than columns are read is too many.
  const std::vector<std::string_view> parts = parts_of(properties, ":", 3 * (kMostColumns + 1));
  if (parts.empty())
    cursor.fail(
        "no Properties=species:S:1:pos:R:3:radius:R:1: plain XYZ says no radii; write extended XYZ with "
        "them");
  if (parts.size() % 3 != 0) cursor.fail("Properties must be name:type:columns, one after another");
  Columns columns;
  const auto keep = [&](int& column, std::string_view meaning) {
    if (column >= 0) cursor.fail(fmt::format("Properties: two columns are '{}'", meaning));
    column = columns.count;
  };
  for (std::size_t k = 0; k < parts.size(); k += 3) {
    const auto width = number_in(parts[k + 2]);
    if (!width || !integer_in(*width, 1, kMostColumns))
      cursor.fail(fmt::format("Properties: '{:.40}' has '{:.40}' columns", parts[k], parts[k + 2]));
    const std::string name = in_small_letters(parts[k].substr(0, kLongestName));
    const std::string_view meaning = meaning_of_column(parts[k]);
    if (*width == 3 && (name == "pos" || name == "position")) keep(columns.position, "pos");
    if (*width == 3 && (name == "velo" || name == "velocity")) keep(columns.velocity, "velo");
    if (*width == 1) {
      if (meaning == "diameter") keep(columns.diameter, meaning);
      if (meaning == "radius") keep(columns.radius, meaning);
      if (meaning == "mass") keep(columns.mass, meaning);
      if (meaning == "id") keep(columns.id, meaning);
      if (meaning == "dump") keep(columns.dump, meaning);
    }
    columns.count += static_cast<int>(*width);
    if (columns.count > kMostColumns)
      cursor.fail(fmt::format("Properties: more than {} columns", kMostColumns));
  }
  if (columns.position < 0) cursor.fail("Properties have no pos:R:3");
  if (columns.diameter < 0 && columns.radius < 0)
    cursor.fail("no radius: Properties need radius:R:1 or diameter:R:1; OVITO writes it if Radius is chosen");
  return columns;
}

}  // namespace

RawSnapshot read_xyz(const std::filesystem::path& file, std::string_view text, std::optional<int> frame) {
  const Frame chosen = frame_of(file, text, frame);
  TextCursor cursor(file, text, chosen.at, chosen.line);
  const TextCursor header = cursor;
  const std::string_view second = cursor.next_line();
  const Columns columns = columns_of(header, value_of(second, "Properties"));
  RawSnapshot raw;
  raw.time = number_in(value_of(second, "Time")).value_or(0);
  raw.has_mass = columns.mass >= 0, raw.has_id = columns.id >= 0, raw.has_dump = columns.dump >= 0;
  for (std::size_t k = 0; k < chosen.count; ++k) {
    const TextCursor row = cursor;
    const auto wanted = static_cast<std::size_t>(columns.count);
    const std::vector<std::string_view> words = parts_of(cursor.next_line(), " \t", wanted + 1);
    if (words.size() != wanted)
      row.fail(fmt::format("grain {} of {}: {} values, Properties have {}", k + 1, chosen.count,
                           words.size() > wanted ? "more" : fmt::format("{}", words.size()), wanted));
    const auto number = [&](int at) {
      const auto value = number_in(words[static_cast<std::size_t>(at)]);
      if (!value) row.fail(fmt::format("'{:.40}' is no finite number", words[static_cast<std::size_t>(at)]));
      return *value;
    };
    const auto number_if_any = [&](int at) { return at >= 0 ? std::optional(number(at)) : std::nullopt; };
    const GrainPlace place{file, row.line(), k};
    Grain grain;
    for (int axis = 0; axis < 3; ++axis) {
      grain.position[axis] = number(columns.position + axis);
      if (columns.velocity >= 0)
        grain.velocity[axis] = velocity_in(words[static_cast<std::size_t>(columns.velocity + axis)]);
    }
    grain.diameter = diameter_of(number_if_any(columns.diameter), number_if_any(columns.radius), place);
    if (raw.has_mass) grain.mass = number(columns.mass);
    if (raw.has_id) grain.id = id_of(number(columns.id), place);
    if (raw.has_dump) grain.dump = dump_of(number(columns.dump), place);
    raw.grains.push_back(grain);
    raw.lines.push_back(row.line());
  }
  return raw;
}

}  // namespace scree
