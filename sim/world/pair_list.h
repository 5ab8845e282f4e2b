#pragma once
// Pairs of spheres that touch or soon may, with the memory of their contacts.
//
// Each sphere has a skin. A pair is listed when the two reaches (radius plus skin), taken at the places where
// the spheres were when last listed, overlap; the list is complete as long as no sphere has moved further
// than its own skin. When one has, it and all others that used up half of theirs are listed anew from the
// grid; pairs of the rest are kept as they stand. So a fast sphere repairs its own pairs and nobody else's.
// The skin grows with speed.
//
// The list is in rows: the pairs of owner i (the smaller index) lie side by side, sorted by partner. Contact
// memory lies beside the pair and moves with it: no look-up in a step.
#include <cstdint>
#include <functional>
#include <vector>

#include "sim/contact/rrlinear.h"
#include "sim/world/grid.h"
#include "sim/world/spheres.h"

namespace scree {

class PairList {
 public:
  /// Runs a body over parts of [0, count), in any order and on any thread.
  using ForRanges = std::function<void(int count, const std::function<void(int first, int last)>& body)>;
  /// Lets several threads look for pairs; what is found does not depend on it.
  void use_threads(ForRanges for_ranges) { for_ranges_ = std::move(for_ranges); }

  /// Lists everything from scratch after spheres were added or re-sorted. `order[k]` is the old index of new
  /// sphere k, or -1 for a new one; contact memory of old pairs is carried over.
  void rebuild(const Spheres& spheres, const std::vector<int>& order, double horizon);

  /// True if sphere i may have left its skin.
  bool left_skin(int i, const Quad& place) const {
    const Vec3& at = grid_.position(i);
    const double dx = place.x - at.x(), dy = place.y - at.y(), dz = place.z - at.z();
    return dx * dx + dy * dy + dz * dz > skin2_[i];
  }

  /// Repairs the lists of all spheres that used up half of their skin. `horizon` (s): skins hold what a
  /// sphere moves in this time. Returns the spheres listed anew, rising; valid until the next call.
  const std::vector<int>& repair(const Spheres& spheres, double horizon);

  /// Takes a sphere out for good.
  void drop(int i) { dropped_.push_back(i); }

  int rows() const { return static_cast<int>(begin_.size()) - 1; }
  int begin(int i) const { return begin_[i]; }
  int end(int i) const { return begin_[i + 1]; }
  int partner(int p) const { return partner_[p]; }
  std::size_t size() const { return partner_.size(); }
  double skin(int i) const { return grid_.reach(i) - radius_[i]; }
  const Vec3& listed_at(int i) const { return grid_.position(i); }

  // Contact memory, one a pair; `touching` tells whether it holds anything.
  std::vector<ContactHistory> history;
  std::vector<std::uint8_t> touching;
  // Force that a sleeping sphere of the pair has got used to (N, on the owner), once `rest_known` is set.
  std::vector<Vec3> rest_force;
  std::vector<std::uint8_t> rest_known;

  /// For each sphere, the pairs in which it is the partner, rising, and the owner of each pair.
  std::vector<int> incoming_begin, incoming_pair;
  int owner(int p) const { return owner_[p]; }

 private:
  void list_anew(int i, const Spheres& spheres, double horizon);
  void find_pairs_of(const std::vector<int>& listed, const Spheres& spheres);
  void find_pairs_of(int i, std::vector<std::uint64_t>& found) const;
  void merge(const Spheres& spheres);
  void index_incoming(int count);

  NeighbourGrid grid_;
  std::vector<double> radius_, skin2_;
  std::vector<int> begin_{0}, partner_, owner_;
  std::vector<std::uint8_t> dirty_;
  std::vector<int> listed_, dropped_;
  std::vector<std::uint64_t> found_;  // owner << 32 | partner
  std::vector<std::vector<std::uint64_t>> found_parts_;
  ForRanges for_ranges_;

  // Buffers of merge, kept to avoid allocation.
  std::vector<int> new_begin_, new_partner_;
  std::vector<ContactHistory> new_history_;
  std::vector<std::uint8_t> new_touching_, new_rest_known_;
  std::vector<Vec3> new_rest_force_;
  std::vector<int> next_;
};

}  // namespace scree
