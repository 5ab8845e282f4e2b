#pragma once
// Rock before it is dumped: random places without overlap.
#include <cstdint>
#include <vector>

#include "sim/material/vector.h"
#include "sim/world/clumps.h"

namespace scree {

/// Where rock may be put, in the frame of its container: a box or, with length[1] = 0, a cylinder of diameter
/// length[0] about the z axis. Boxes stand from z = 0 on x from -length[0] to 0 and y from -length[1] / 2 to
/// length[1] / 2.
struct LoadRegion {
  Vec3 length;  ///< m; length[2] is the height to fill first
};

/// Places of grains by random sequential addition.
struct Load {
  std::vector<Vec3> positions;  ///< m, frame of the region
  std::vector<Vec3> axes;       ///< unit vectors, of clumps; empty: spheres
  double height = 0;            ///< m, the height that was needed; above length[2] when the rock is heaped
};

/// Puts the diameters (m, largest first) at random places, none overlapping another or the region's sides.
/// When a sphere finds no place in 400 tries the region grows in height by 2 % and is filled anew, so that
/// every height holds the same mix. The random stream is that of (seed, dump). Clumps lie in all directions
/// evenly. Throws std::invalid_argument when a grain is wider (a clump: longer) than the region.
Load fill_region(const LoadRegion& region, const std::vector<double>& diameters, std::uint64_t seed,
                 std::uint64_t dump, const Clumps& clumps = {});

}  // namespace scree
