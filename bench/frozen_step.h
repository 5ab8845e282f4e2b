#pragma once
// One step of a world, held still so that its two loops can be timed alone.
#include <numeric>
#include <vector>

#include "sim/world/rrlinear_world.h"

namespace scree::bench {

inline std::vector<int> as_they_are(int count) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

/// A world's spheres and pairs, copied and cut into blocks. Its steps take no time: nothing moves, the memory
/// of contacts stays as it is, and the same step can be done again and again.
class FrozenStep {
 public:
  explicit FrozenStep(const RrlinearWorld& world)
      : spheres_(world.spheres()), pairs_(world.pairs()), law_(world.settings().material) {
    const int n = spheres_.movable;
    sums_.resize(n);
    sleep_.renumber(as_they_are(n), spheres_, pairs_, std::vector<std::uint8_t>(n, 0), 0.0, 9.81);
    split_into_blocks(sleep_.awake(), blocks_);
    for (int b = 0; b < blocks(); ++b) forces(b);
  }
  int blocks() const { return static_cast<int>(blocks_.size()); }
  void forces(int block) {
    contact_forces({spheres_, pairs_, sleep_, law_, nullptr, 0.0, sums_.data(), false}, blocks_[block]);
  }
  void move(int block) {
    leapfrog({spheres_, pairs_, sums_.data(), Vec3(0, 0, -9.81), 0.4, true, 0.0}, blocks_[block]);
  }
  double spheres(int first, int last) const {
    double count = 0;
    for (int b = first; b < last; ++b) count += static_cast<double>(blocks_[b].awake.size());
    return count;
  }
  double pairs(int first, int last, bool closed) const {
    double count = 0;
    for (int b = first; b < last; ++b)
      for (const int i : blocks_[b].awake)
        for (const Neighbour& n : pairs_.owned(i)) count += !closed || n.touching() ? 1 : 0;
    return count;
  }

 private:
  Spheres spheres_;
  PairList pairs_;
  Sleep sleep_{false, 0.1};
  ContactLaw law_;
  std::vector<ForceSum> sums_;
  std::vector<BlockWork> blocks_;
};

}  // namespace scree::bench
