#pragma once
// Hot state of all spheres, as a structure of arrays of aligned quadruples.
#include <cstdint>
#include <vector>

#include "sim/contact/quad.h"

namespace scree {

/// A sphere to be put into the world.
struct NewSphere {
  Vec3 position;        ///< m
  double diameter = 0;  ///< m
  int dump = 0;         ///< 0 for fixed balls
  bool fixed = false;
  Vec3 velocity = Vec3::Zero();  ///< m/s
  Vec3 spin = Vec3::Zero();      ///< rad/s
  Vec3 axis = Vec3::Zero();      ///< of a clump (clumps.h), a unit vector; zero: along x
};

/// With sort_spheres(), as RrlinearWorld does, movable spheres stand first (index below `movable`) and fixed
/// balls behind them; without it all stand as they came.
struct Spheres {
  std::vector<Quad> place;     ///< position m; w: radius m
  std::vector<Quad> velocity;  ///< m/s; w: mass kg
  std::vector<Quad> spin;      ///< rad/s; w: moment of inertia kg m2
  std::vector<std::int64_t> id;
  std::vector<std::int32_t> dump;
  std::vector<std::uint8_t> lost;    ///< has left the model; takes no part any more
  std::vector<std::uint8_t> asleep;  ///< at rest and not moved until disturbed (rrlinear)
  /// Where grains are clumps (clumps.h), else empty: the other sphere of a grain, or -1 for one alone; and
  /// the grain's angular momentum about its middle (kg m2/s), which both have.
  std::vector<std::int32_t> partner;
  std::vector<Quad> angular;
  int movable = 0;

  int size() const { return static_cast<int>(place.size()); }
  /// Bytes held.
  std::size_t bytes() const {
    return place.capacity() * (3 * sizeof(Quad) + 14) +
           angular.capacity() * (sizeof(Quad) + sizeof(std::int32_t));
  }
  /// Energy of motion, J. Of a clump, whose energy of rotation is spin times angular momentum over two, a
  /// half: what its spheres' velocities about the middle have of it is in their energy of motion already.
  double kinetic_energy(int i) const {
    const double shift = 0.5 * velocity[i].w * velocity[i].vec().squaredNorm();
    if (partner.empty() || partner[i] < 0) return shift + 0.5 * spin[i].w * spin[i].vec().squaredNorm();
    const Vec3 arm = 0.5 * (place[i].vec() - place[partner[i]].vec()), w = spin[i].vec();
    return shift + 0.25 * w.dot(angular[i].vec()) - 0.5 * velocity[i].w * w.cross(arm).squaredNorm();
  }
  /// Of the grain that sphere i belongs to, kg.
  double grain_mass(int i) const { return (partner.empty() || partner[i] < 0 ? 1 : 2) * velocity[i].w; }
  /// Of the grains of sphere i and of another, which may be fixed, kg.
  double reduced_mass(int i, int other) const {
    const double m1 = grain_mass(i), m2 = other < movable ? grain_mass(other) : 1e300;
    return m1 / (1 + m1 / m2);
  }
  /// The first sphere of a grain, or one that is a grain alone.
  bool leads(int i) const { return partner.empty() || partner[i] < 0 || id[i] < id[partner[i]]; }
  /// A flag of one sphere of a clump holds for the other, too.
  void join(std::vector<std::uint8_t>& flags) const {
    for (int i = 0; i < static_cast<int>(partner.size()) && i < static_cast<int>(flags.size()); ++i)
      if (partner[i] > i) flags[i] = flags[partner[i]] = flags[i] | flags[partner[i]];
  }
};

/// Orders movable spheres along a Morton curve (lost ones last), fixed balls likewise behind them. Returns
/// `order` with new index k holding the sphere that had index order[k].
std::vector<int> sort_spheres(Spheres& spheres, const std::vector<std::uint8_t>& fixed);

}  // namespace scree
