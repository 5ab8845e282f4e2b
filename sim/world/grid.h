#pragma once
// Levels of hashed cells for spheres of very different size.
//
// A sphere with reach r (radius plus skin) lives on the level whose cells are the smallest of width >=
// kCellReaches r; cells double from level to level. Every level has two tables of cells: `own` holds the
// spheres of that level, `finer` all those of finer levels. A query of a sphere on level a looks into own and
// finer of level a, and into own of every coarser level: with cells of the larger partner's size this is some
// ten cells a level, whatever the ratio of the sizes. Insertion, removal and query touch only the sphere's
// own cells, so that one fast sphere costs nobody else anything.
#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/material/vector.h"

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
  /// Puts sphere i at a place, moving it if it is there already. reach <= max_reach().
  void place(int i, const Vec3& position, double reach);
  void remove(int i);
  /// Calls visit(j) for every other sphere whose reach may overlap that of i; each once.
  template <class Visit>
  void query(int i, Visit&& visit) const;

  const Vec3& position(int i) const { return position_[i]; }  ///< as last placed
  double reach(int i) const { return reach_[i]; }

 private:
  struct Entry {
    std::uint64_t key;
    std::int32_t next, prev;  // prev < 0: head of bucket -1 - prev
  };
  struct Table {
    std::vector<std::int32_t> heads;
    std::int64_t count = 0;
  };
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    return (static_cast<std::uint64_t>(x) & 0x1fffff) | (static_cast<std::uint64_t>(y) & 0x1fffff) << 21 |
           (static_cast<std::uint64_t>(z) & 0x1fffff) << 42;
  }
  std::uint32_t bucket(std::uint64_t k) const {
    return static_cast<std::uint32_t>((k * 0x9e3779b97f4a7c15ull) >> shift_);
  }
  std::int64_t cell(double x, int level) const {
    return static_cast<std::int64_t>(std::floor(x * inverse_cell_[level]));
  }
  void link(Table& table, std::int32_t entry, std::uint64_t k);
  void unlink(Table& table, std::int32_t entry);
  template <class Visit>
  void visit_cells(const Table& table, int level, const Vec3& x, double range, int self, Visit& visit) const;

  int levels_ = 0;
  int shift_ = 64;
  std::vector<double> cell_, inverse_cell_;
  std::vector<Table> own_, finer_;
  std::vector<Entry> entries_;  // sphere * levels + level
  std::vector<std::int8_t> level_;
  std::vector<Vec3> position_;
  std::vector<double> reach_;
};

template <class Visit>
void NeighbourGrid::visit_cells(const Table& table, int level, const Vec3& x, double range, int self,
                                Visit& visit) const {
  if (table.count == 0) return;
  const std::int64_t x0 = cell(x.x() - range, level), x1 = cell(x.x() + range, level);
  const std::int64_t y0 = cell(x.y() - range, level), y1 = cell(x.y() + range, level);
  const std::int64_t z0 = cell(x.z() - range, level), z1 = cell(x.z() + range, level);
  for (std::int64_t cx = x0; cx <= x1; ++cx)
    for (std::int64_t cy = y0; cy <= y1; ++cy)
      for (std::int64_t cz = z0; cz <= z1; ++cz) {
        const std::uint64_t k = key(cx, cy, cz);
        for (std::int32_t e = table.heads[bucket(k)]; e >= 0; e = entries_[e].next) {
          if (entries_[e].key != k) continue;
          const int j = e / levels_;
          if (j != self) visit(j);
        }
      }
}

template <class Visit>
void NeighbourGrid::query(int i, Visit&& visit) const {
  const Vec3& x = position_[i];
  const double r = reach_[i];
  const int a = level_[i];
  visit_cells(finer_[a], a, x, r + 0.5 / kCellReaches * cell_[a], i, visit);
  for (int b = a; b < levels_; ++b) visit_cells(own_[b], b, x, r + cell_[b] / kCellReaches, i, visit);
}

}  // namespace scree
