#pragma once
// A pile out of a file, whatever program wrote it.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/io/snapshot.h"

namespace scree {

/// How a file is to be understood where it does not say so itself.
struct SnapshotOptions {
  std::optional<double> length_unit;  ///< m per unit of length, of a file that states none; default 1
  std::optional<int> frame;           ///< from 1; default: the last
  enum class Up { z, y } up = Up::z;  ///< with y, (x, y, z) of the file becomes (x, -z, y)
  Vec3 shift = Vec3::Zero();          ///< m, added after turning
  double density = 2760;              ///< of grains without a mass, kg/m3
};

/// What was read.
struct SnapshotRead {
  Snapshot snapshot;            ///< grains by rising id
  std::vector<Grain> original;  ///< every grain dumped until then; empty where the file does not say it
  std::vector<Grain> fixed;     ///< balls of the ground; empty where the file has none
  bool has_dumps = false;       ///< grains say which dump brought them; otherwise their dump is 1
  std::vector<std::string> notes;
};

/// Reads CSV (columns x, y, z, diameter or radius, optional mass, id, dump; a unit in the header as `x_mm` or
/// `x [mm]`), a text dump of LAMMPS or LIGGGHTS, extended XYZ (OVITO, and particles.xyz of a run), text of
/// YADE, a VTK file (POLYDATA or UNSTRUCTURED_GRID with a radius or diameter of the points; legacy, ASCII or
/// binary, or XML, any encoding, plain or compressed by zlib), or a trajectory of scree (particles.h5). The
/// format is told by the content; a byte order mark before it is passed over. Throws FileError
/// (input_text.h): no radius, a radius and a diameter that contradict each other, two columns of one meaning,
/// no grains, a value that is no finite number, an id or dump that is no integer, a diameter or mass that is
/// not above 0, a grain farther away than 1e6 m, an id twice, a frame that is not there.
SnapshotRead read_snapshot(const std::filesystem::path& file, const SnapshotOptions& options);

}  // namespace scree
