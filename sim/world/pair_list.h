#pragma once
// Pairs of spheres that touch or soon may, with the memory of their contacts.
//
// Each sphere has a ball in which it stays for a while: its own, wider by a skin. A pair is listed when the
// two balls overlap; the list is complete as long as every sphere is in its ball. When one has left it, it
// and all others that are about to are listed anew from the grid; the rows of the rest are not looked at. So
// a fast sphere repairs its own pairs and nobody else's, and a repair costs what has moved. The ball of a
// sphere that moves lies ahead of it, on the way that it will make in the time for which the list should
// last: the sphere crosses the whole of it, which takes half the skin that a ball around the present place
// would.
//
// Row i holds all neighbours of movable sphere i, rising; those above i are the pairs that it owns. Both rows
// of a pair name the same contact memory. Fixed balls have no rows.
#include <cstdint>
#include <span>
#include <vector>

#include "sim/contact/rrlinear.h"
#include "sim/world/grid.h"
#include "sim/world/rows.h"
#include "sim/world/spheres.h"
#include "sim/world/team.h"

namespace scree {

/// What a contact remembers, as acting on its owner. Single precision: its rounding, 6e-8 of the force, is
/// far below what local damping leaves unbalanced (Rest tests), and half of the memory traffic of a step is
/// saved.
struct alignas(32) ContactMemory {
  float shear[4] = {0, 0, 0, 0};    ///< N; the last: moment about the normal, N m (effects alone)
  float rolling[4] = {0, 0, 0, 0};  ///< N m; the last: power of dashpots, W

  ContactHistory history() const {
    return {{shear[0], shear[1], shear[2]}, {rolling[0], rolling[1], rolling[2]}, shear[3], rolling[3]};
  }
};

/// Force that a sleeping sphere has got used to (N, on the owner of the contact).
struct RestForce {
  float x = 0, y = 0, z = 0;
  std::int32_t known = 1;  ///< an open contact has none, and that is known
};

/// An entry of a row.
struct Neighbour {
  std::int32_t sphere = 0;
  std::uint32_t tag = 0;  ///< memory << 1; the lowest bit: the contact is closed
  std::uint32_t memory() const { return tag >> 1; }
  bool touching() const { return (tag & 1u) != 0; }
};

class PairList {
 public:
  /// Lets several threads look for pairs; what is found does not depend on it.
  void set_team(Team* team) { team_ = team; }

  /// Lists everything from scratch after spheres were added or re-sorted. `order[k]` is the old index of new
  /// sphere k, or -1 for a new one; memory of closed contacts is carried over.
  void rebuild(const Spheres& spheres, const std::vector<int>& order, double horizon);

  /// Share of the way to the rim of its ball from which a sphere is looked at when others are listed,
  /// squared.
  static constexpr double kNearRim2 = 0.8;

  /// Where sphere i is in its ball: square of the way from the middle over that to the rim; above 1 it has
  /// left the ball.
  double way_out2(int i, const Quad& place) const {
    const Quad& at = grid_.site(i);
    const double dx = place.x - at.x, dy = place.y - at.y, dz = place.z - at.z, skin = at.w - place.w;
    return (dx * dx + dy * dy + dz * dz) / (skin * skin);
  }

  /// Gives those of `near_rim` (way_out2() > kNearRim2) that have left their ball or soon will new ones, and
  /// brings their rows up to date. `horizon` (s): balls hold what a sphere moves in this time. Returns these
  /// spheres in the order of `near_rim`; valid until the next call.
  const std::vector<int>& repair(const Spheres& spheres, std::span<const int> near_rim, double horizon);

  /// Takes a sphere out for good, at the next repair.
  void drop(int i) { dropped_.push_back(i); }

  int rows() const { return rows_.rows(); }
  /// All neighbours of movable sphere i, rising.
  std::span<const Neighbour> neighbours(int i) const { return rows_.row(i); }
  /// Those that it owns: above i.
  std::span<const Neighbour> owned(int i) const { return rows_.row(i).subspan(below_[i]); }
  std::span<Neighbour> owned(int i) { return rows_.row(i).subspan(below_[i]); }
  /// Those that others own: below i.
  std::span<Neighbour> below(int i) { return rows_.row(i).first(below_[i]); }
  /// Marks the contact of an entry of row i as closed or open, in both rows.
  void turn(int i, Neighbour& entry) {
    entry.tag ^= 1u;
    if (entry.sphere >= rows()) return;
    for (Neighbour& other : rows_.row(entry.sphere))
      if (other.sphere == i) other.tag ^= 1u;
  }
  ContactMemory& memory(const Neighbour& n) { return memory_[n.memory()]; }
  const ContactMemory& memory(const Neighbour& n) const { return memory_[n.memory()]; }
  ContactMemory* memories() { return memory_.data(); }
  RestForce& rest(std::uint32_t memory) { return rest_[memory]; }
  /// By how much the ball of sphere i is wider than itself (m), and its centre.
  double skin(int i, const Quad& place) const { return grid_.site(i).w - place.w; }
  Vec3 ball_at(int i) const { return grid_.site(i).vec(); }
  /// Spheres listed since the last rebuild, each as often as it was.
  std::int64_t listings() const { return listings_; }
  /// For saving and going on: world_state.cpp.
  template <class Stream>
  void state(Stream& stream);
  /// Bytes held by rows, memories and grid.
  std::size_t bytes() const;

 private:
  Quad ball(int i, const Spheres& spheres, double horizon) const;
  bool leaves_soon(int i, const Spheres& spheres, double horizon) const;
  template <class Apply>
  void find_neighbours(const Apply& apply);
  void find_neighbours(int i, std::vector<int>& found) const;
  void apply(int i, std::span<const int> found, int movable);
  void clear_row(int i, int movable);
  std::uint32_t new_memory();
  void add_entry(int i, Neighbour entry);
  void take_entry(int i, int neighbour);

  NeighbourGrid grid_;
  Rows<Neighbour> rows_;
  std::vector<std::int32_t> below_;  // entries of a row below its own number
  std::vector<ContactMemory> memory_;
  std::vector<RestForce> rest_;  // by memory
  std::vector<std::uint32_t> free_memory_;
  std::vector<int> listed_, dropped_;
  std::int64_t listings_ = 0;
  Team* team_ = nullptr;
  const std::int32_t* partner_ = nullptr;  // of the spheres in hand: those of one clump are no pair

  // What a search found, part by part: neighbours of the spheres of a part, one list after another.
  struct Part {
    std::vector<int> found, ends;
    bool searched = false;  // by std::atomic_ref
  };
  std::vector<Part> parts_;
  std::vector<Quad> balls_;
  std::vector<Neighbour> row_, new_;
};

}  // namespace scree
