// A frame of a trajectory that scree wrote (trajectory.h).
#include <fmt/format.h>

#include <algorithm>

#include "sim/io/h5_file.h"
#include "sim/io/snapshot_formats.h"

namespace scree {
namespace {

constexpr double kMostUnpacked = 1100;  // values a stored byte

class Trajectory {
 public:
  explicit Trajectory(const std::filesystem::path& file)
      : path_(file), file_(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {
    if (file_ < 0) throw FileError(file, 0, "is damaged HDF5, or a run is writing it");
  }

  bool has(const char* name) const {
    // H5Lexists wants every group on the way to be there.
    std::string part;
    for (const char* c = name;; ++c) {
      if ((*c == '/' || *c == '\0') && !part.empty() && H5Lexists(file_, part.c_str(), H5P_DEFAULT) <= 0)
        return false;
      if (*c == '\0') return true;
      part += *c;
    }
  }

  std::vector<hsize_t> shape(const char* name) const {
    const H5Handle set = open(name);
    const H5Handle space(H5Dget_space(set), H5Sclose);
    std::vector<hsize_t> sizes(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
    H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
    return sizes;
  }

  /// All of a data set.
  template <typename T>
  std::vector<T> all(const char* name, hid_t type) const {
    std::vector<T> values(values_in(name, shape(name)));
    if (H5Dread(open(name), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) fail(name);
    return values;
  }

  /// One frame of a data set that grows by frames.
  std::vector<double> frame(const char* name, hsize_t index) const {
    const H5Handle set = open(name);
    std::vector<hsize_t> count = shape(name), start(count.size(), 0);
    values_in(name, count);
    count.front() = 1;
    start.front() = index;
    hsize_t n = 1;
    for (const hsize_t size : count) n *= size;
    const H5Handle here(H5Dget_space(set), H5Sclose);
    H5Sselect_hyperslab(here, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    const H5Handle memory(H5Screate_simple(1, &n, nullptr), H5Sclose);
    std::vector<double> values(n);
    if (H5Dread(set, H5T_NATIVE_DOUBLE, memory, here, H5P_DEFAULT, values.data()) < 0) fail(name);
    return values;
  }

  [[noreturn]] void fail(const std::string& name) const {
    throw FileError(path_, 0, fmt::format("{} cannot be read; is this a trajectory of scree?", name));
  }

 private:
  /// How many values a shape has. A file of few bytes can announce any number: no more are believed than what
  /// it stores can unpack to (deflate: 1032 to 1).
  std::size_t values_in(const char* name, const std::vector<hsize_t>& sizes) const {
    const double stored = static_cast<double>(H5Dget_storage_size(open(name)));
    double n = 1;
    for (const hsize_t size : sizes) n *= static_cast<double>(size);
    if (n > kMostUnpacked * stored) fail(fmt::format("{}: announces {:g} values and", name, n));
    return static_cast<std::size_t>(n);
  }

  H5Handle open(const char* name) const {
    if (!has(name)) fail(name);
    H5Handle set(H5Dopen2(file_, name, H5P_DEFAULT), H5Dclose);
    if (set < 0) fail(name);
    return set;
  }
  const std::filesystem::path& path_;
  H5Handle file_;
};

std::vector<Grain> base_of(const Trajectory& trajectory) {
  std::vector<Grain> fixed;
  if (!trajectory.has("/particles/base/position")) return fixed;
  const auto places = trajectory.all<double>("/particles/base/position", H5T_NATIVE_DOUBLE);
  const auto sizes = trajectory.all<double>("/particles/base/diameter", H5T_NATIVE_DOUBLE);
  if (places.size() != 3 * sizes.size()) trajectory.fail("/particles/base");
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    Grain ball;
    ball.position = Vec3(places[3 * k], places[3 * k + 1], places[3 * k + 2]);
    ball.diameter = sizes[k];
    fixed.push_back(ball);
  }
  return fixed;
}

}  // namespace

RawSnapshot read_trajectory_frame(const std::filesystem::path& file, std::optional<int> frame) {
  ask_for_memory();
  const QuietHdf5 quiet;
  const Trajectory trajectory(file);
  constexpr const char* kPlaces = "/particles/rock/position/value";
  constexpr const char* kSizes = "/particles/rock/diameter/value";
  const auto shape = trajectory.shape(kPlaces);
  const auto ids = trajectory.all<std::int64_t>("/particles/rock/id", H5T_NATIVE_INT64);
  const auto masses = trajectory.all<double>("/particles/rock/mass", H5T_NATIVE_DOUBLE);
  const auto dumps = trajectory.all<std::int32_t>("/particles/rock/dump", H5T_NATIVE_INT32);
  const auto times = trajectory.all<double>("/particles/rock/position/time", H5T_NATIVE_DOUBLE);
  const std::size_t rows = ids.size();
  if (shape.size() != 3 || shape[1] != rows || shape[2] != 3 || masses.size() != rows || dumps.size() != rows)
    trajectory.fail(kPlaces);
  // An interrupted run may have written one set of a frame and not yet the next.
  const auto sizes_shape = trajectory.shape(kSizes);
  if (sizes_shape.size() != 2 || sizes_shape[1] != rows) trajectory.fail(kSizes);
  const std::size_t index = frame_index(
      file, frame,
      std::min({static_cast<std::size_t>(shape[0]), static_cast<std::size_t>(sizes_shape[0]), times.size()}));

  RawSnapshot raw;
  raw.in_metres = raw.has_mass = raw.has_id = raw.has_dump = true;
  raw.time = times[index];
  const auto places = trajectory.frame(kPlaces, index);
  // A grain that is not in the model has diameter 0.
  std::vector<double> now, dumped(rows, 0.0);
  for (std::size_t k = 0; k <= index; ++k) {
    now = trajectory.frame(kSizes, k);
    for (std::size_t row = 0; row < rows; ++row) dumped[row] = std::max(dumped[row], now[row]);
  }
  for (std::size_t row = 0; row < rows; ++row) {
    Grain grain;
    grain.id = ids[row], grain.mass = masses[row], grain.dump = dumps[row];
    grain.position = Vec3(places[3 * row], places[3 * row + 1], places[3 * row + 2]);
    if (grain.diameter = dumped[row]; grain.diameter > 0) raw.original.push_back(grain);
    if (grain.diameter = now[row]; grain.diameter > 0) raw.grains.push_back(grain);
  }
  raw.fixed = base_of(trajectory);
  return raw;
}

}  // namespace scree
