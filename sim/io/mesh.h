#pragma once
// Triangle meshes of tools and ground, read through assimp.
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/material/vector.h"

namespace scree {

struct TriangleMesh {
  std::string name;
  std::vector<Vec3> vertices;                 ///< m, local frame; no two at the same place (welded)
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside
  /// True when every edge belongs to exactly two triangles of opposite direction: the mesh bounds a solid and
  /// only the outside of its faces pushes. A mesh that is not closed is a sheet: both sides push.
  bool closed = false;
};

/// What is wrong with a mesh. Errors forbid its use; warnings are told to the user.
struct MeshReport {
  std::vector<std::string> errors;
  std::vector<std::string> warnings;
};

/// A mesh as read, and what was found wrong with it.
struct LoadedMesh {
  TriangleMesh mesh;
  MeshReport report;
};

/// Reads STL, OBJ, PLY or glTF/GLB (by extension; nothing else is tried), multiplies by `scale` (metres per
/// file unit), applies the node transforms of the file, turns glTF, whose y is up, to z up ((x, y, z) becomes
/// (x, -z, y)), welds vertices, drops zero-area faces (warning), orients faces outwards when the mesh is
/// closed, and checks it. Errors: unreadable, no triangles, not finite, larger than `max_size` (m; "8000 m:
/// millimetres read as metres?" with the `scale` to write) or smaller than 1 mm. Warnings: holes (open edges,
/// how many and where), edges shared by three or more faces, inconsistent orientation, dropped faces. Never
/// throws for a bad file: the report says it.
LoadedMesh load_mesh(const std::filesystem::path& file, double scale = 1.0, double max_size = 1000.0);

/// Axis-aligned box, closed, outward faces.
TriangleMesh make_box(const Vec3& low, const Vec3& high);

/// Writes binary STL (metres).
void write_stl(const TriangleMesh& mesh, const std::filesystem::path& file);

/// Recomputes `closed` from the edges; returns it.
bool update_closed(TriangleMesh& mesh);

}  // namespace scree
