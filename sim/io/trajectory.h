#pragma once
// The trajectory of a run in the forms that viewers read: H5MD (particles.h5), XDMF for ParaView, extended
// XYZ for OVITO.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/io/snapshot.h"
#include "sim/io/state_stream.h"

namespace scree {

/// What the file says about itself.
struct TrajectoryInfo {
  std::string author = "scree user";  ///< /h5md/author
  std::string version = "0";          ///< version of this program, /h5md/creator
  std::string scenario;               ///< resolved scenario text, /parameters/scenario; left out when empty
  std::uint64_t seed = 0;             ///< /parameters/seed
};

/// Writes frames of a run, each complete on disk before `write` returns, so an interrupted run stays
/// readable.
///
/// H5MD 1.1 (de Buyl, Colberg, Hofling, Comput. Phys. Commun. 185 (2014) 1546): /particles/rock has one row a
/// grain for the whole file. A grain that is not in the model has diameter 0, so viewers draw nothing: before
/// its dump it stands at its future place, after a loss at its last one. Position (m), velocity (m/s) and
/// diameter (m) are float32.
///
/// Beside `x.h5` stand `x.xdmf` (refers to the HDF5 file) and `x.xyz` (grains in the model only; OVITO reads
/// no H5MD).
class TrajectoryWriter {
 public:
  /// `all`: every grain of every dump with id, place, mass, dump, diameter. `base`: fixed balls, may be
  /// empty. Throws std::invalid_argument when `all` is empty or an id occurs twice, std::runtime_error when a
  /// file cannot be created.
  TrajectoryWriter(const std::filesystem::path& h5_file, const std::vector<Grain>& all,
                   const std::vector<Grain>& base = {}, const TrajectoryInfo& info = {});
  /// Goes on with the files that were there when `state` was saved by save(); what was written since is cut
  /// off. The other arguments as when they were begun. Throws std::runtime_error when the files are not there
  /// any more, StateError when the state does not fit them.
  TrajectoryWriter(const std::filesystem::path& h5_file, const std::vector<Grain>& all, StateReader& state);
  ~TrajectoryWriter();  ///< Closes; a failure is silent, so call close() to hear of it.
  TrajectoryWriter(const TrajectoryWriter&) = delete;
  TrajectoryWriter& operator=(const TrajectoryWriter&) = delete;

  /// Appends a frame. Grains are matched by id; an unknown id is std::invalid_argument. Throws
  /// std::runtime_error when the disk is full or the file cannot be written; frames before it stay readable.
  void write(const Snapshot& snapshot, std::int64_t step);
  /// Syncs the files to the disk, and tells how far they have come.
  void save(StateWriter& state);
  /// A trajectory that has come to its end: it need not be gone on with any more.
  static void forget_saved(const std::filesystem::path& h5_file);
  /// Finishes the files. Throws std::runtime_error; a second call does nothing.
  void close();
  std::int64_t frames() const;

 private:
  struct Files;
  std::unique_ptr<Files> files_;  ///< none after close()
  std::int64_t frames_ = 0;       ///< count kept after close()
};

}  // namespace scree
