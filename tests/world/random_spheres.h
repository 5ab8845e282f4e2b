#pragma once
#include <cmath>

#include "sim/material/random.h"
#include "sim/world/spheres.h"

namespace scree {

// Radii from 1/ratio to 1 (log-uniform) in a cube that makes them overlap here and there; the last `fixed` do
// not move.
inline Spheres random_spheres(int count, int fixed, std::uint64_t seed, double ratio = 27.0) {
  Random random(seed, 0, RandomPurpose::positions);
  Spheres s;
  for (int i = 0; i < count; ++i) {
    const double radius = std::pow(ratio, -random.uniform());
    Quad place;
    place.set({random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4)});
    place.w = radius;
    s.place.push_back(place);
    Quad velocity;
    velocity.w = radius * radius * radius;
    s.velocity.push_back(velocity);
    s.spin.emplace_back();
    s.id.push_back(i);
    s.dump.push_back(1);
    s.lost.push_back(0);
    s.asleep.push_back(0);
  }
  s.movable = count - fixed;
  return s;
}

}  // namespace scree
