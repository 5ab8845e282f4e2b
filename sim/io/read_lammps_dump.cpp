// Text dumps of LAMMPS and LIGGGHTS: ITEM: TIMESTEP, NUMBER OF ATOMS, BOX BOUNDS, ATOMS, frame after frame.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/io/snapshot_formats.h"

namespace scree {
namespace {

constexpr std::string_view kFrame = "ITEM: TIMESTEP";

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

std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    words.emplace_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

// What a column of atoms holds. Scaled coordinates (xs) are shares of the box; xu and xsu are unwrapped.
struct Columns {
  int position[3] = {-1, -1, -1}, velocity[3] = {-1, -1, -1};
  bool scaled[3] = {false, false, false};
  int diameter = -1, radius = -1, mass = -1, id = -1, dump = -1;
  std::size_t count = 0;
};

Columns columns_of(const std::vector<std::string>& names) {
  Columns columns;
  columns.count = names.size();
  for (int k = 0; k < static_cast<int>(names.size()); ++k) {
    const std::string& name = names[static_cast<std::size_t>(k)];
    if (const auto axis = std::string_view("xyz").find(name.front());
        axis != std::string_view::npos && name.size() <= 3) {
      const std::string_view rest = std::string_view(name).substr(1);
      if (rest.empty() || rest == "u" || rest == "s" || rest == "su") {
        columns.position[axis] = k;
        columns.scaled[axis] = rest == "s" || rest == "su";
        continue;
      }
    }
    const std::string_view meaning = meaning_of_column(name);
    if (meaning == "diameter") columns.diameter = k;
    if (meaning == "radius") columns.radius = k;
    if (meaning == "mass") columns.mass = k;
    if (meaning == "id") columns.id = k;
    if (meaning == "dump") columns.dump = k;
    if (meaning == "vx") columns.velocity[0] = k;
    if (meaning == "vy") columns.velocity[1] = k;
    if (meaning == "vz") columns.velocity[2] = k;
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
      if (!(number >= 0 && number < 1e9 && number == std::floor(number))) cursor.fail("no number of atoms");
      count = static_cast<std::size_t>(number);
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
      columns = columns_of(words_of(item.substr(11)));
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
    if (columns.scaled[axis] && !has_box) lacks("scaled coordinates need an upright box: dump x y z");
  }
  if (columns.diameter < 0 && columns.radius < 0)
    lacks("no radius: dump the atoms with radius or diameter (dump custom ... id x y z radius)");
  raw.has_mass = columns.mass >= 0, raw.has_id = columns.id >= 0, raw.has_dump = columns.dump >= 0;

  std::vector<double> row(columns.count);
  const auto column = [&](int at) { return row[static_cast<std::size_t>(at)]; };
  for (std::size_t k = 0; k < *count; ++k) {
    const int line = cursor.line();
    const std::string_view atom = cursor.next_line();
    const std::vector<std::string> words = words_of(atom);
    if (words.size() != columns.count)
      throw FileError(file, line,
                      fmt::format("atom {} of {}: {} values, the frame has {} columns", k + 1, *count,
                                  words.size(), columns.count));
    for (std::size_t j = 0; j < words.size(); ++j) {
      const auto value = number_in(words[j]);
      row[j] = value.value_or(0);
      // Other columns, such as an element's name, may be words.
      const int at = static_cast<int>(j);
      const bool needed = at == columns.diameter || at == columns.radius || at == columns.mass ||
                          at == columns.id || at == columns.dump ||
                          std::find(std::begin(columns.position), std::end(columns.position), at) !=
                              std::end(columns.position);
      if (needed && !value)
        throw FileError(file, line, fmt::format("'{:.40}' is no finite number", words[j]));
    }
    Grain grain;
    for (int axis = 0; axis < 3; ++axis) {
      const double value = column(columns.position[axis]);
      grain.position[axis] = columns.scaled[axis] ? low[axis] + value * length[axis] : value;
      if (columns.velocity[axis] >= 0) grain.velocity[axis] = column(columns.velocity[axis]);
    }
    grain.diameter = columns.diameter >= 0 ? column(columns.diameter) : 2 * column(columns.radius);
    if (raw.has_mass) grain.mass = column(columns.mass);
    if (raw.has_id) grain.id = static_cast<std::int64_t>(std::clamp(column(columns.id), -1e15, 1e15));
    if (raw.has_dump) grain.dump = static_cast<int>(std::clamp(column(columns.dump), 0.0, 1e6));
    raw.grains.push_back(grain);
    raw.lines.push_back(line);
  }
  return raw;
}

}  // namespace scree
