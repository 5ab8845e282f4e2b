#pragma once
// Three components and one companion that is always read with them.
#include "sim/material/vector.h"

namespace scree {

/// Aligned, so that one load brings all four.
struct alignas(32) Quad {
  double x = 0, y = 0, z = 0, w = 0;
  Vec3 vec() const { return {x, y, z}; }
  void set(const Vec3& v) { x = v.x(), y = v.y(), z = v.z(); }
  void add(const Vec3& v) { x += v.x(), y += v.y(), z += v.z(); }
};

}  // namespace scree
