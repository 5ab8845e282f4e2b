#include "sim/io/snapshot_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "sim/io/snapshot_formats.h"

namespace scree {
namespace {

constexpr std::size_t kLongestFirstLine = 256;                // of XYZ: a number
constexpr double kFarthest = 1e6;                             // m
constexpr double kLeastDiameter = 1e-7, kMostDiameter = 1e3;  // m

double mass_of(const Grain& grain, double density) {
  return density * std::numbers::pi / 6 * grain.diameter * grain.diameter * grain.diameter;
}

Vec3 turned(const Vec3& v, SnapshotOptions::Up up) {
  return up == SnapshotOptions::Up::y ? Vec3(v.x(), -v.z(), v.y()) : v;
}

RawSnapshot read_raw(const std::filesystem::path& file, const SnapshotOptions& options) {
  std::string head(4, '\0');
  {
    std::ifstream in(file, std::ios::binary);
    in.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(in.gcount()));
  }
  const auto one_frame = [&](const char* kind) {
    if (options.frame.value_or(1) != 1)
      throw FileError(file, 0, fmt::format("frame {}: {} has one", *options.frame, kind));
  };
  if (head.compare(0, 4, "\x89HDF") == 0) {
    if (options.length_unit)
      throw FileError(file, 0, "a trajectory of scree is in metres: leave out the unit of length");
    return read_trajectory_frame(file, options.frame);
  }
  std::string whole = read_input_bytes(file);
  std::string_view bytes = whole;
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  if (bytes.starts_with("# vtk DataFile")) {
    one_frame("a VTK file");
    return read_vtk(file, bytes);
  }
  if (bytes.starts_with("<?xml") || bytes.starts_with("<VTKFile")) {
    one_frame("a VTK file");
    return read_vtk_xml(file, bytes);
  }
  require_text(file, bytes);
  if (bytes.starts_with("ITEM:")) return read_lammps_dump(file, bytes, options.frame);
  const std::string_view start = bytes.substr(0, kLongestFirstLine);
  const std::size_t end = start.find_first_of("\r\n");
  if (end != std::string_view::npos && number_in(start.substr(0, end)))
    return read_xyz(file, bytes, options.frame);
  one_frame("a table");
  if (bytes.starts_with(kYadeFormat)) return read_yade_text(file, bytes);
  whole = {};  // a table reads its file itself
  return read_csv_snapshot(file, options.length_unit.value_or(1));
}

// "grain 3 (line 5)"; counted from 1.
std::string which(const RawSnapshot& raw, std::size_t k) {
  return raw.lines.empty() ? fmt::format("grain {}", k + 1)
                           : fmt::format("grain {} (line {})", k + 1, raw.lines[k]);
}

}  // namespace

std::size_t frame_index(const std::filesystem::path& file, std::optional<int> frame, std::size_t count) {
  if (count == 0) throw FileError(file, 0, "has no frame");
  if (!frame) return count - 1;
  if (*frame < 1 || static_cast<std::size_t>(*frame) > count)
    throw FileError(file, 0, fmt::format("frame {}: the file has frames 1 to {}", *frame, count));
  return static_cast<std::size_t>(*frame - 1);
}

std::string_view meaning_of_column(std::string_view name) {
  struct Alias {
    std::string_view name, meaning;
  };
  static constexpr std::array<Alias, 40> kAliases{{
      {"x", "x"},
      {"y", "y"},
      {"z", "z"},
      {"points:0", "x"},
      {"points:1", "y"},
      {"points:2", "z"},
      {"points_0", "x"},
      {"points_1", "y"},
      {"points_2", "z"},
      {"position.x", "x"},
      {"position.y", "y"},
      {"position.z", "z"},
      {"position x", "x"},
      {"position y", "y"},
      {"position z", "z"},
      {"pos_x", "x"},
      {"pos_y", "y"},
      {"pos_z", "z"},
      {"diameter", "diameter"},
      {"d", "diameter"},
      {"particle diameter", "diameter"},
      {"radius", "radius"},
      {"r", "radius"},
      {"rad", "radius"},
      {"radii", "radius"},
      {"particle radius", "radius"},
      {"mass", "mass"},
      {"particle mass", "mass"},
      {"id", "id"},
      {"particle id", "id"},
      {"particle identifier", "id"},
      {"dump", "dump"},
      {"load", "dump"},
      {"vx", "vx"},
      {"vy", "vy"},
      {"vz", "vz"},
      {"velocity:0", "vx"},
      {"velocity:1", "vy"},
      {"velocity:2", "vz"},
      {"particle_id", "id"},
  }};
  if (name.size() > kLongestName) return {};
  const std::string small = in_small_letters(trimmed(name));
  for (const Alias& alias : kAliases)
    if (alias.name == small) return alias.meaning;
  return {};
}

SnapshotRead read_snapshot(const std::filesystem::path& file, const SnapshotOptions& options) {
  RawSnapshot raw = read_raw(file, options);
  if (raw.grains.empty()) throw FileError(file, 0, "has no grains");
  const double unit = raw.in_metres ? 1 : options.length_unit.value_or(1);
  SnapshotRead read;
  // A mass in a file whose lengths are in another unit than metres is in some unit of its own.
  const bool use_mass = raw.has_mass && !raw.unknown_mass_unit && unit == 1;
  if (!use_mass)
    read.notes.push_back(fmt::format("masses are those of spheres of {:g} kg/m3{}", options.density,
                                     raw.has_mass ? "; the unit of the file's own is not known" : ""));
  for (std::size_t k = 0; k < raw.grains.size(); ++k) {
    Grain& grain = raw.grains[k];
    const auto fail = [&](const std::string& message) {
      throw FileError(file, 0, fmt::format("{}: {}", which(raw, k), message));
    };
    if (!grain.position.allFinite() || !std::isfinite(grain.diameter)) fail("a value is not finite");
    if (!(grain.diameter > 0)) fail(fmt::format("diameter {:g} must be above 0", grain.diameter));
    if (use_mass && !(grain.mass > 0 && std::isfinite(grain.mass)))
      fail(fmt::format("mass {:g} must be above 0", grain.mass));
    grain.diameter *= unit;
    if (grain.diameter < kLeastDiameter || grain.diameter > kMostDiameter)
      fail(fmt::format("diameter {:g} m; allowed {:g} to {:g} m; is the unit of length right?",
                       grain.diameter, kLeastDiameter, kMostDiameter));
    grain.position = turned(unit * grain.position, options.up) + options.shift;
    grain.velocity = turned(unit * grain.velocity, options.up);
    if (grain.position.cwiseAbs().maxCoeff() > kFarthest)
      fail(fmt::format("lies at {:g}, {:g}, {:g} m, farther than {:g} m; is the unit of length right?",
                       grain.position.x(), grain.position.y(), grain.position.z(), kFarthest));
    if (!use_mass) grain.mass = mass_of(grain, options.density);
    if (!raw.has_id) grain.id = static_cast<std::int64_t>(k + 1);
    if (!raw.has_dump) grain.dump = 1;
    if (grain.dump < 1) fail(fmt::format("dump {}: they are counted from 1", grain.dump));
  }
  for (auto* others : {&raw.original, &raw.fixed})
    for (Grain& grain : *others) grain.position = turned(grain.position, options.up) + options.shift;
  std::sort(raw.grains.begin(), raw.grains.end(), [](const Grain& a, const Grain& b) { return a.id < b.id; });
  for (std::size_t k = 1; k < raw.grains.size(); ++k)
    if (raw.grains[k].id == raw.grains[k - 1].id)
      throw FileError(file, 0, fmt::format("id {} stands twice", raw.grains[k].id));
  read.snapshot = {raw.time, std::move(raw.grains)};
  read.original = std::move(raw.original);
  read.fixed = std::move(raw.fixed);
  read.has_dumps = raw.has_dump;
  return read;
}

}  // namespace scree
