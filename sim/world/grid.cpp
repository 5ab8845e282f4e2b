#include "sim/world/grid.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace scree {

void NeighbourGrid::reset(int count, double min_reach, double max_reach) {
  assert(min_reach > 0 && max_reach >= min_reach);
  cell_.assign(1, kCellReaches * min_reach);
  while (cell_.back() < kCellReaches * max_reach) cell_.push_back(2.0 * cell_.back());
  levels_ = static_cast<int>(cell_.size());
  inverse_cell_.clear();
  for (const double c : cell_) inverse_cell_.push_back(1.0 / c);
  const int bits = std::max(6, static_cast<int>(std::bit_width(static_cast<unsigned>(count))) + 1);
  shift_ = 64 - bits;
  own_.assign(levels_, {});
  finer_.assign(levels_, {});
  for (auto* tables : {&own_, &finer_})
    for (Table& t : *tables) t.heads.assign(std::size_t{1} << bits, -1);
  entries_.assign(static_cast<std::size_t>(count) * levels_, {});
  level_.assign(count, -1);
  position_.assign(count, Vec3::Zero());
  reach_.assign(count, 0.0);
}

void NeighbourGrid::link(Table& table, std::int32_t entry, std::uint64_t k) {
  const std::uint32_t b = bucket(k);
  Entry& e = entries_[entry];
  e.key = k;
  e.next = table.heads[b];
  e.prev = -1 - static_cast<std::int32_t>(b);
  if (e.next >= 0) entries_[e.next].prev = entry;
  table.heads[b] = entry;
  ++table.count;
}

void NeighbourGrid::unlink(Table& table, std::int32_t entry) {
  const Entry& e = entries_[entry];
  if (e.prev < 0)
    table.heads[-1 - e.prev] = e.next;
  else
    entries_[e.prev].next = e.next;
  if (e.next >= 0) entries_[e.next].prev = e.prev;
  --table.count;
}

void NeighbourGrid::place(int i, const Vec3& position, double reach) {
  assert(reach <= max_reach() * (1 + 1e-12));
  int level = 0;
  while (level + 1 < levels_ && cell_[level] < kCellReaches * reach) ++level;
  const int before = level_[i];
  for (int l = 0; l < levels_; ++l) {
    const std::int32_t entry = i * levels_ + l;
    const bool was_own = before == l, was_finer = before >= 0 && before < l;
    const bool is_own = level == l, is_finer = level < l;
    if (!was_own && !was_finer && !is_own && !is_finer) continue;
    const std::uint64_t k = key(cell(position.x(), l), cell(position.y(), l), cell(position.z(), l));
    if (was_own == is_own && was_finer == is_finer && entries_[entry].key == k) continue;
    if (was_own) unlink(own_[l], entry);
    if (was_finer) unlink(finer_[l], entry);
    if (is_own) link(own_[l], entry, k);
    if (is_finer) link(finer_[l], entry, k);
  }
  level_[i] = static_cast<std::int8_t>(level);
  position_[i] = position;
  reach_[i] = reach;
}

void NeighbourGrid::remove(int i) {
  if (level_[i] < 0) return;
  for (int l = level_[i]; l < levels_; ++l) unlink(l == level_[i] ? own_[l] : finer_[l], i * levels_ + l);
  level_[i] = -1;
}

}  // namespace scree
