#pragma once
// A pile at one moment, as analysis sees it.
#include <cstdint>
#include <vector>

#include "sim/material/vector.h"

namespace scree {

/// One sphere of a snapshot.
struct Grain {
  std::int64_t id = 0;           ///< stable through the run
  Vec3 position = Vec3::Zero();  ///< m
  Vec3 velocity = Vec3::Zero();  ///< m/s
  double diameter = 0;           ///< m
  double mass = 0;               ///< kg
  int dump = 0;                  ///< which dump brought it, from 1
};

/// Movable spheres at one time; ordered by id.
struct Snapshot {
  double time = 0;  ///< s
  std::vector<Grain> grains;
};

}  // namespace scree
