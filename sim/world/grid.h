#pragma once
// Levels of hashed cells for spheres of very different size.
//
// A sphere with reach r (radius plus skin) lives on the level whose cells are the smallest of width >=
// kCellReaches r; cells double from level to level. Every level has two tables of cells: `own` holds the
// spheres of that level, `finer` all those of finer levels. A query of a sphere on level a looks into own and
// finer of level a, and into own of every coarser level: with cells of the larger partner's size this is some
// ten cells a level, whatever the ratio of the sizes. Insertion, removal and query touch only the sphere's
// own cells, so that one fast sphere costs nobody else anything.
//
// A cell holds copies of what a query needs of its spheres, four to a block, in single precision: they are
// sieved four at a time, with a margin for the rounding, and what passes is left to the caller to look at.
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/contact/quad.h"
#include "sim/world/team.h"

namespace scree {

class NeighbourGrid {
 public:
  /// Width of a cell over the largest reach on its level: wider cells are fewer to visit, with more spheres
  /// in each.
  static constexpr double kCellReaches = 2.0;

  /// Empties the grid; spheres will be numbered 0 to count - 1 and have reaches from min_reach to max_reach
  /// (m).
  void reset(int count, double min_reach, double max_reach);
  double max_reach() const { return cell_.back() / kCellReaches; }
  /// Puts spheres at places with their reach as companion (at most max_reach()), moving those that are there
  /// already. What comes of it does not depend on the threads.
  void place(std::span<const int> spheres, std::span<const Quad> sites, Team* team);
  void place(int i, const Vec3& position, double reach) {
    const Quad site{position.x(), position.y(), position.z(), reach};
    place({&i, 1}, {&site, 1}, nullptr);
  }
  void remove(int i);
  /// Calls visit(j) for every other sphere whose reach overlaps that of i, and perhaps some whose reach
  /// ends within a millionth of its distance from the origin; each once.
  template <class Visit>
  void query(int i, Visit&& visit) const;

  /// Where a sphere was last placed (m), and its reach.
  const Quad& site(int i) const { return site_[i]; }
  /// For saving and going on: world_state.cpp.
  template <class Stream>
  void state(Stream& stream, Team* team);
  /// Bytes held.
  std::size_t bytes() const;

 private:
  typedef float Floats __attribute__((vector_size(16)));
  static constexpr int kInBlock = 4;
  struct Block {
    Floats x, y, z, reach;
    std::int32_t sphere[kInBlock];
    std::uint64_t key;
    std::int32_t next;   // block of the same bucket, or free block
    std::int32_t count;  // 0: free
  };
  struct Table {
    std::vector<std::int32_t> heads;
    std::vector<Block> blocks;
    std::int32_t free = -1, used = 0;  // blocks
    int bits = 0;                      // of a bucket's number, for each axis
    bool empty() const { return used == 0; }
    // The grid wrapped around: cells side by side have buckets side by side.
    std::uint32_t bucket(std::uint64_t k) const {
      const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
      return static_cast<std::uint32_t>((k & mask) | (k >> 21 & mask) << bits |
                                        (k >> 42 & mask) << (2 * bits));
    }
    void clear();
    void grow();
  };
  // Bit k: the sign of lane k.
  static unsigned signs_of(Floats v) {
#if defined(__SSE__)
    return static_cast<unsigned>(__builtin_ia32_movmskps(v));
#else
    unsigned bits = 0;
    for (int k = 0; k < kInBlock; ++k) bits |= (v[k] < 0 ? 1u : 0u) << k;
    return bits;
#endif
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return (static_cast<std::uint64_t>(x) & 0x1fffff) | (static_cast<std::uint64_t>(y) & 0x1fffff) << 21 |
           (static_cast<std::uint64_t>(z) & 0x1fffff) << 42;
  }
  std::int64_t cell(double x, int level) const {
    return static_cast<std::int64_t>(std::floor(x * inverse_cell_[level]));
  }
  void place_on_level(int i, int level, int before);
  void put(Table& table, int i, int level, std::uint64_t k);
  void take(Table& table, int i, int level);
  void write(Table& table, std::int32_t slot, int i);
  template <class Visit>
  void visit_cells(const Table& table, int level, const Quad& at, double range, int self, Visit& visit) const;

  int levels_ = 0;
  std::vector<double> cell_, inverse_cell_;
  std::vector<Table> own_, finer_;
  std::vector<std::int32_t> slot_;  // sphere * levels + level: place in its table, block * kInBlock + k
  std::vector<std::int8_t> level_;
  std::vector<Quad> site_;
  std::vector<std::int8_t> before_;  // levels before a call of place()
};

template <class Visit>
void NeighbourGrid::visit_cells(const Table& table, int level, const Quad& at, double range, int self,
                                Visit& visit) const {
  if (table.empty()) return;
  const std::int64_t x0 = cell(at.x - range, level), x1 = cell(at.x + range, level);
  const std::int64_t y0 = cell(at.y - range, level), y1 = cell(at.y + range, level);
  const std::int64_t z0 = cell(at.z - range, level), z1 = cell(at.z + range, level);
  const Floats zero{}, x = zero + static_cast<float>(at.x), y = zero + static_cast<float>(at.y),
                       z = zero + static_cast<float>(at.z);
  const double margin = 1e-6 * (std::abs(at.x) + std::abs(at.y) + std::abs(at.z) + range);
  const Floats reach = zero + static_cast<float>(at.w + margin);
  // All first blocks on their way from memory before any is looked at.
  struct Cell {
    std::uint64_t key;
    std::int32_t block;
  };
  constexpr int kAtOnce = 64;
  Cell cells[kAtOnce];
  int count = 0;
  const auto look = [&] {
    for (int c = 0; c < count; ++c)
      for (std::int32_t b = cells[c].block; b >= 0;) {
        const Block& block = table.blocks[b];
        b = block.next;
        if (block.key != cells[c].key) continue;
        const Floats dx = block.x - x, dy = block.y - y, dz = block.z - z, both = block.reach + reach;
        unsigned near = signs_of(dx * dx + dy * dy + dz * dz - both * both) & ((1u << block.count) - 1u);
        for (; near != 0; near &= near - 1) {
          const int j = block.sphere[std::countr_zero(near)];
          if (j != self) visit(j);
        }
      }
    count = 0;
  };
  for (std::int64_t cz = z0; cz <= z1; ++cz)
    for (std::int64_t cy = y0; cy <= y1; ++cy)
      for (std::int64_t cx = x0; cx <= x1; ++cx) {
        const std::uint64_t k = key(cx, cy, cz);
        const std::int32_t head = table.heads[table.bucket(k)];
        if (head < 0) continue;
        __builtin_prefetch(&table.blocks[head]);
        __builtin_prefetch(&table.blocks[head].sphere[0]);
        cells[count++] = {k, head};
        if (count == kAtOnce) look();
      }
  look();
}

template <class Visit>
void NeighbourGrid::query(int i, Visit&& visit) const {
  const Quad at = site_[i];
  const int a = level_[i];
  visit_cells(finer_[a], a, at, at.w + 0.5 / kCellReaches * cell_[a], i, visit);
  for (int b = a; b < levels_; ++b) visit_cells(own_[b], b, at, at.w + cell_[b] / kCellReaches, i, visit);
}

}  // namespace scree
