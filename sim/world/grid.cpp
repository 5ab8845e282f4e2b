#include "sim/world/grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace scree {
namespace {
constexpr int kFirstBits = 2;  // a table begins with 4 x 4 x 4 buckets
}

void NeighbourGrid::Table::clear() {
  bits = kFirstBits;
  heads.assign(std::size_t{1} << (3 * bits), -1);
  blocks.clear();
  free = -1;
  used = 0;
}

// Eight times the buckets.
void NeighbourGrid::Table::grow() {
  ++bits;
  heads.assign(std::size_t{1} << (3 * bits), -1);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    Block& block = blocks[b];
    if (block.count == 0) continue;
    std::int32_t& head = heads[bucket(block.key)];
    block.next = head;
    head = static_cast<std::int32_t>(b);
  }
}

void NeighbourGrid::reset(int count, double min_reach, double max_reach) {
  assert(min_reach > 0 && max_reach >= min_reach);
  cell_.assign(1, kCellReaches * min_reach);
  while (cell_.back() < kCellReaches * max_reach) cell_.push_back(2.0 * cell_.back());
  levels_ = static_cast<int>(cell_.size());
  inverse_cell_.clear();
  for (const double c : cell_) inverse_cell_.push_back(1.0 / c);
  own_.resize(levels_);
  finer_.resize(levels_);
  for (auto* tables : {&own_, &finer_})
    for (Table& t : *tables) t.clear();
  slot_.assign(static_cast<std::size_t>(count) * levels_, -1);
  level_.assign(count, -1);
  site_.assign(count, {});
}

void NeighbourGrid::write(Table& table, std::int32_t slot, int i) {
  Block& block = table.blocks[slot / kInBlock];
  const int q = slot % kInBlock;
  block.x[q] = static_cast<float>(site_[i].x);
  block.y[q] = static_cast<float>(site_[i].y);
  block.z[q] = static_cast<float>(site_[i].z);
  block.reach[q] = static_cast<float>(site_[i].w);
  block.sphere[q] = i;
}

void NeighbourGrid::put(Table& table, int i, int level, std::uint64_t k) {
  std::int32_t b = table.heads[table.bucket(k)];
  while (b >= 0 && (table.blocks[b].key != k || table.blocks[b].count == kInBlock)) b = table.blocks[b].next;
  if (b < 0) {
    if (static_cast<std::size_t>(table.used) > table.heads.size()) table.grow();
    if (table.free < 0) {
      b = static_cast<std::int32_t>(table.blocks.size());
      table.blocks.emplace_back();
    } else {
      b = table.free;
      table.free = table.blocks[b].next;
    }
    std::int32_t& head = table.heads[table.bucket(k)];
    table.blocks[b] = Block{};
    table.blocks[b].key = k;
    table.blocks[b].next = head;
    head = b;
    ++table.used;
  }
  const std::int32_t slot = b * kInBlock + table.blocks[b].count++;
  slot_[static_cast<std::size_t>(i) * levels_ + level] = slot;
  write(table, slot, i);
}

void NeighbourGrid::take(Table& table, int i, int level) {
  const std::int32_t slot = slot_[static_cast<std::size_t>(i) * levels_ + level], b = slot / kInBlock;
  Block& block = table.blocks[b];
  const int q = slot % kInBlock, last = --block.count;
  if (q != last) {
    block.x[q] = block.x[last], block.y[q] = block.y[last], block.z[q] = block.z[last];
    block.reach[q] = block.reach[last];
    block.sphere[q] = block.sphere[last];
    slot_[static_cast<std::size_t>(block.sphere[q]) * levels_ + level] = slot;
  }
  if (last > 0) return;
  std::int32_t* link = &table.heads[table.bucket(block.key)];
  while (*link != b) link = &table.blocks[*link].next;
  *link = block.next;
  block.next = table.free;
  table.free = b;
  --table.used;
}

// The levels know nothing of each other: a thread works on one of them.
void NeighbourGrid::place(std::span<const int> spheres, std::span<const Quad> sites, Team* team) {
  before_.resize(spheres.size());
  for (std::size_t k = 0; k < spheres.size(); ++k) {
    const int i = spheres[k];
    assert(sites[k].w <= max_reach() * (1 + 1e-12));
    int level = 0;
    while (level + 1 < levels_ && cell_[level] < kCellReaches * sites[k].w) ++level;
    before_[k] = level_[i];
    level_[i] = static_cast<std::int8_t>(level);
    site_[i] = sites[k];
  }
  const auto work = [&](int level) {
    for (std::size_t k = 0; k < spheres.size(); ++k) place_on_level(spheres[k], level, before_[k]);
  };
  if (team)
    team->run(levels_, work);
  else
    for (int level = 0; level < levels_; ++level) work(level);
}

// `before`: level of sphere i so far, or -1.
void NeighbourGrid::place_on_level(int i, int l, int before) {
  const int level = level_[i];
  Table* const was = before < 0 || l < before ? nullptr : l == before ? &own_[l] : &finer_[l];
  Table* const is = l < level ? nullptr : l == level ? &own_[l] : &finer_[l];
  if (was == nullptr && is == nullptr) return;
  const Quad& at = site_[i];
  const std::uint64_t k = key(cell(at.x, l), cell(at.y, l), cell(at.z, l));
  const std::int32_t slot = slot_[static_cast<std::size_t>(i) * levels_ + l];
  if (was == is && is->blocks[slot / kInBlock].key == k) return write(*is, slot, i);
  if (was != nullptr) take(*was, i, l);
  if (is != nullptr) put(*is, i, l, k);
}

void NeighbourGrid::remove(int i) {
  if (level_[i] < 0) return;
  for (int l = level_[i]; l < levels_; ++l) take(l == level_[i] ? own_[l] : finer_[l], i, l);
  level_[i] = -1;
}

std::size_t NeighbourGrid::bytes() const {
  std::size_t bytes =
      slot_.capacity() * sizeof(std::int32_t) + level_.capacity() + site_.capacity() * sizeof(Quad);
  for (const auto* tables : {&own_, &finer_})
    for (const Table& t : *tables)
      bytes += t.heads.capacity() * sizeof(std::int32_t) + t.blocks.capacity() * sizeof(Block);
  return bytes;
}

}  // namespace scree
