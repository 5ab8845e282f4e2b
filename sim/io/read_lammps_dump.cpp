// Text dumps of LAMMPS and LIGGGHTS: ITEM: TIMESTEP, NUMBER OF ATOMS, BOX BOUNDS, ATOMS, frame after frame.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "sim/io/snapshot_formats.h"

namespace scree {
namespace {

constexpr std::string_view kFrame = "ITEM: TIMESTEP";
constexpr double kMostAtoms = 1e9;

struct Frame {
  std::size_t at;
  int line;
};

// Where frames begin.
std::vector<Frame> frames_of(std::string_view text) {
  std::vector<Frame> frames;
  int line = 1;
  for (std::size_t at = 0; at < text.size(); ++line) {
    if (text.substr(at, kFrame.size()) == kFrame) frames.push_back({at, line});
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos) break;
    at = end + 1;
  }
  return frames;
}

// How coordinates are written, the best first; xu and xsu are unwrapped, xs and xsu are shares of the box.
constexpr std::string_view kWays[] = {"", "u", "s", "su"};

// What a column of atoms holds.
struct Columns {
  int position[3] = {-1, -1, -1}, velocity[3] = {-1, -1, -1};
  std::size_t way[3] = {0, 0, 0};  // in which position is written
  bool scaled(int axis) const { return way[axis] >= 2; }
  int diameter = -1, radius = -1, mass = -1, id = -1, dump = -1;
  std::size_t count = 0;
};

Columns columns_of(const std::filesystem::path& file, int line, std::string_view item) {
  const std::vector<std::string_view> names = parts_of(item, " \t", kMostColumns + 1);
  if (names.size() > kMostColumns)
    throw FileError(file, line, fmt::format("ITEM: ATOMS has more than {} columns", kMostColumns));
  Columns columns;
  columns.count = names.size();
  for (int k = 0; k < static_cast<int>(names.size()); ++k) {
    const std::string_view name = names[static_cast<std::size_t>(k)];
    const auto keep = [&](int& column, std::string_view meaning) {
      if (column >= 0)
        throw FileError(file, line,
                        fmt::format("two columns are '{}': {:.40} and {:.40}", meaning,
                                    names[static_cast<std::size_t>(column)], name));
      column = k;
    };
    if (const auto axis = std::string_view("xyz").find(name.front());
        axis != std::string_view::npos && name.size() <= 3) {
      const auto found = std::find(std::begin(kWays), std::end(kWays), name.substr(1));
      if (const auto way = static_cast<std::size_t>(found - std::begin(kWays)); way < std::size(kWays)) {
        int& position = columns.position[axis];
        if (position >= 0 && columns.way[axis] < way) continue;
        if (position >= 0 && columns.way[axis] > way) position = -1;
        keep(position, name.substr(0, 1));
        columns.way[axis] = way;
        continue;
      }
    }
    const std::string_view meaning = meaning_of_column(name);
    if (meaning == "diameter") keep(columns.diameter, meaning);
    if (meaning == "radius") keep(columns.radius, meaning);
    if (meaning == "mass") keep(columns.mass, meaning);
    if (meaning == "id") keep(columns.id, meaning);
    if (meaning == "dump") keep(columns.dump, meaning);
    if (meaning == "vx") keep(columns.velocity[0], meaning);
    if (meaning == "vy") keep(columns.velocity[1], meaning);
    if (meaning == "vz") keep(columns.velocity[2], meaning);
  }
  return columns;
}

}  // namespace

RawSnapshot read_lammps_dump(const std::filesystem::path& file, std::string_view text,
                             std::optional<int> frame) {
  const std::vector<Frame> frames = frames_of(text);
  const Frame& start = frames.at(frame_index(file, frame, frames.size()));
  TextCursor cursor(file, text, start.at, start.line);
  RawSnapshot raw;
  std::optional<std::size_t> count;
  double low[3] = {0, 0, 0}, length[3] = {1, 1, 1};
  bool has_box = false;
  Columns columns;
  int line_of_columns = 0;
  while (true) {
    const int line_of_item = cursor.line();
    const std::string_view item = cursor.next_line();
    const auto is = [&](std::string_view what) { return item.substr(0, what.size()) == what; };
    if (is(kFrame)) {
      raw.time = cursor.number();
      cursor.next_line();
    } else if (is("ITEM: NUMBER OF ATOMS")) {
      const double number = cursor.number();
      const auto atoms = integer_in(number, 0, kMostAtoms);
      if (!atoms) cursor.fail("no number of atoms");
      count = static_cast<std::size_t>(*atoms);
      cursor.next_line();
    } else if (is("ITEM: BOX BOUNDS")) {
      const bool tilted = item.find("xy xz yz") != std::string_view::npos;
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = cursor.number();
        length[axis] = cursor.number() - low[axis];
        cursor.next_line();
      }
      has_box = !tilted;
    } else if (is("ITEM: ATOMS")) {
      columns = columns_of(file, line_of_item, item.substr(11));
      line_of_columns = line_of_item;
      break;
    } else if (is("ITEM:")) {  // UNITS, TIME: one line
      cursor.next_line();
    } else {
      cursor.fail(cursor.done() ? "the frame has no ITEM: ATOMS" : "an ITEM: line is expected");
    }
  }
  if (!count) cursor.fail("ITEM: NUMBER OF ATOMS is missing");
  const auto lacks = [&](const char* what) { throw FileError(file, line_of_columns, what); };
  for (int axis = 0; axis < 3; ++axis) {
    if (columns.position[axis] < 0) lacks("ITEM: ATOMS has no x, y, z");
    if (columns.scaled(axis) && !has_box) lacks("scaled coordinates need an upright box: dump x y z");
  }
  if (columns.diameter < 0 && columns.radius < 0)
    lacks("no radius: dump the atoms with radius or diameter (dump custom ... id x y z radius)");
  raw.has_mass = columns.mass >= 0, raw.has_id = columns.id >= 0, raw.has_dump = columns.dump >= 0;

  for (std::size_t k = 0; k < *count; ++k) {
    const int line = cursor.line();
    const std::vector<std::string_view> words = parts_of(cursor.next_line(), " \t", columns.count + 1);
    if (words.size() != columns.count)
      throw FileError(file, line,
                      fmt::format("atom {} of {}: {} values, the frame has {} columns", k + 1, *count,
                                  words.size() > columns.count ? "more" : fmt::format("{}", words.size()),
                                  columns.count));
    // Other columns, such as an element's name, may be words.
    const auto column = [&](int at) {
      const std::string_view word = words[static_cast<std::size_t>(at)];
      const auto value = number_in(word);
      if (!value) throw FileError(file, line, fmt::format("'{:.40}' is no finite number", word));
      return *value;
    };
    const auto column_if_any = [&](int at) { return at >= 0 ? std::optional(column(at)) : std::nullopt; };
    const GrainPlace place{file, line, k};
    Grain grain;
    for (int axis = 0; axis < 3; ++axis) {
      const double value = column(columns.position[axis]);
      grain.position[axis] = columns.scaled(axis) ? low[axis] + value * length[axis] : value;
      if (columns.velocity[axis] >= 0)
        grain.velocity[axis] = velocity_in(words[static_cast<std::size_t>(columns.velocity[axis])]);
    }
    grain.diameter = diameter_of(column_if_any(columns.diameter), column_if_any(columns.radius), place);
    if (raw.has_mass) grain.mass = column(columns.mass);
    if (raw.has_id) grain.id = id_of(column(columns.id), place);
    if (raw.has_dump) grain.dump = dump_of(column(columns.dump), place);
    raw.grains.push_back(grain);
    raw.lines.push_back(line);
  }
  return raw;
}

}  // namespace scree
