#pragma once
// A movable sphere for the tests of the world.
#include "sim/world/spheres.h"

namespace scree {

inline NewSphere ball(const Vec3& position, double radius, const Vec3& velocity = Vec3::Zero()) {
  NewSphere s;
  s.position = position;
  s.diameter = 2 * radius;
  s.dump = 1;
  s.velocity = velocity;
  return s;
}

}  // namespace scree
