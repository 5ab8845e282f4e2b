#include "sim/world/pair_list.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <limits>
#include <numeric>

namespace scree {
namespace {
// Skin of a sphere at rest, as a share of its radius: small enough to list few pairs that do not touch, large
// enough that a settling pile seldom repairs.
constexpr double kSkinAtRest = 0.12;
constexpr int kPart = 32;  // spheres that one task looks up

int place_in(std::span<const Neighbour> row, int sphere) {
  int k = 0;
  while (k < static_cast<int>(row.size()) && row[k].sphere < sphere) ++k;
  return k;
}

}  // namespace

// The ball lies ahead of a sphere that moves, so that it crosses the whole of it.
Quad PairList::ball(int i, const Spheres& s, double horizon) const {
  const double radius = s.place[i].w;
  Vec3 ahead = Vec3::Zero();
  double skin = 0.0;
  if (i < s.movable) {
    const double rest = kSkinAtRest * radius, most = grid_.max_reach() - radius;
    ahead = 0.5 * horizon * s.velocity[i].vec();
    const double length = ahead.norm();
    if (length > most - rest) ahead *= (most - rest) / length;
    skin = std::min(rest + length, most);
  }
  const Vec3 middle = s.place[i].vec() + ahead;
  return {middle.x(), middle.y(), middle.z(), radius + skin};
}

// True if sphere i is about to leave its ball: most of the way out, and gone in less than `horizon` at its
// present velocity.
bool PairList::leaves_soon(int i, const Spheres& s, double horizon) const {
  const double now = way_out2(i, s.place[i]);
  if (now <= kNearRim2 || now > 1) return now > 1;
  const Vec3 later = s.place[i].vec() + horizon * s.velocity[i].vec();
  return way_out2(i, {later.x(), later.y(), later.z(), s.place[i].w}) > 1;
}

void PairList::rebuild(const Spheres& s, const std::vector<int>& order, double horizon) {
  const int n = s.size();
  partner_ = s.partner.empty() ? nullptr : s.partner.data();
  const Rows<Neighbour> old_rows = std::move(rows_);
  const std::vector<std::int32_t> old_below = std::move(below_);
  const std::vector<ContactMemory> old_memory = std::move(memory_);
  const std::vector<RestForce> old_rest = std::move(rest_);

  double min_radius = std::numeric_limits<double>::max(), max_radius = 0;
  for (int i = 0; i < n; ++i) {
    if (s.lost[i]) continue;
    min_radius = std::min(min_radius, s.place[i].w);
    max_radius = std::max(max_radius, s.place[i].w);
  }
  rows_ = {};
  rows_.reset(s.movable);
  below_.assign(s.movable, 0);
  memory_ = {};
  memory_.reserve(old_memory.size());
  rest_ = {};
  rest_.reserve(old_rest.size());
  free_memory_.clear();
  dropped_.clear();
  listed_.clear();
  listings_ = 0;
  if (max_radius == 0) return;

  grid_.reset(n, min_radius * (1 + kSkinAtRest), 2.0 * max_radius);
  balls_.clear();
  for (int i = 0; i < n; ++i)
    if (!s.lost[i]) listed_.push_back(i), balls_.push_back(ball(i, s, horizon));
  grid_.place(listed_, balls_, team_);
  while (!listed_.empty() && listed_.back() >= s.movable) listed_.pop_back();

  // Memory of a pair that was closed before, with the sign that goes with the new order of its pieces.
  const auto carry = [&](int i, int j, Neighbour& entry) {
    const int a = order[i], b = order[j];
    if (a < 0 || b < 0) return;
    const int owner = std::min(a, b), other = std::max(a, b);
    if (owner >= old_rows.rows()) return;
    const std::span<const Neighbour> row = old_rows.row(owner).subspan(old_below[owner]);
    const int at = place_in(row, other);
    if (at == static_cast<int>(row.size()) || row[at].sphere != other || !row[at].touching()) return;
    ContactMemory& memory = memory_[entry.memory()];
    RestForce& rest = rest_[entry.memory()];
    memory = old_memory[row[at].memory()];
    rest = old_rest[row[at].memory()];
    entry.tag |= 1u;
    if (a < b) return;
    for (int k = 0; k < 3; ++k) memory.shear[k] = -memory.shear[k], memory.rolling[k] = -memory.rolling[k];
    rest.x = -rest.x, rest.y = -rest.y, rest.z = -rest.z;
  };
  find_neighbours([&](int i, std::span<const int> found) {
    row_.clear();
    for (const int j : found) {
      Neighbour entry{j, 0};
      if (j < i) {
        const auto row = owned(j);
        entry.tag = row[place_in(row, i)].tag;
        ++below_[i];
      } else {
        entry.tag = new_memory() << 1;
        carry(i, j, entry);
      }
      row_.push_back(entry);
    }
    rows_.assign(i, row_);
  });
}

const std::vector<int>& PairList::repair(const Spheres& s, std::span<const int> near_rim, double horizon) {
  partner_ = s.partner.empty() ? nullptr : s.partner.data();
  listed_.clear();
  balls_.clear();
  std::sort(dropped_.begin(), dropped_.end());
  for (const int i : dropped_) {
    grid_.remove(i);
    clear_row(i, s.movable);
  }
  dropped_.clear();
  for (const int i : near_rim) {
    if (s.lost[i] || !leaves_soon(i, s, horizon)) continue;
    listed_.push_back(i);
    balls_.push_back(ball(i, s, horizon));
  }
  grid_.place(listed_, balls_, team_);
  listings_ += static_cast<std::int64_t>(listed_.size());
  find_neighbours([&](int i, std::span<const int> found) { apply(i, found, s.movable); });
  return listed_;
}

void PairList::find_neighbours(int i, std::vector<int>& found) const {
  const Quad at = grid_.site(i);
  const std::size_t first = found.size();
  grid_.query(i, [&](int j) {
    const Quad& other = grid_.site(j);
    const double dx = at.x - other.x, dy = at.y - other.y, dz = at.z - other.z, range = at.w + other.w;
    if (dx * dx + dy * dy + dz * dz < range * range && (partner_ == nullptr || partner_[i] != j))
      found.push_back(j);
  });
  std::sort(found.begin() + static_cast<std::ptrdiff_t>(first), found.end());
}

// Finds the neighbours of the spheres listed and calls apply(i, found) for one after another, in their order.
// Several threads search; whoever has ended a part applies what is ready, unless another thread does already.
template <class Apply>
void PairList::find_neighbours(const Apply& apply) {
  const int count = static_cast<int>(listed_.size()), parts = (count + kPart - 1) / kPart;
  if (static_cast<int>(parts_.size()) < parts) parts_.resize(parts);
  for (int p = 0; p < parts; ++p) parts_[p].searched = false;
  const auto searched = [&](int p) { return std::atomic_ref<bool>(parts_[p].searched); };
  int next = 0;  // part to apply; of the thread that applies
  std::atomic<bool> applying{false};
  const auto apply_what_is_ready = [&] {
    while (!applying.exchange(true, std::memory_order_seq_cst)) {
      for (; next < parts && searched(next).load(std::memory_order_acquire); ++next) {
        const Part& part = parts_[next];
        int begin = 0;
        for (std::size_t k = 0; k < part.ends.size(); begin = part.ends[k++])
          apply(listed_[static_cast<std::size_t>(next) * kPart + k],
                std::span(part.found).subspan(begin, part.ends[k] - begin));
      }
      const int waiting = next;
      applying.store(false, std::memory_order_seq_cst);
      // One that ended its part while this thread held the work has left it behind.
      if (waiting >= parts || !searched(waiting).load(std::memory_order_seq_cst)) return;
    }
  };
  const auto search = [&](int p) {
    Part& part = parts_[p];
    part.found.clear();
    part.ends.clear();
    for (int k = p * kPart; k < std::min(count, (p + 1) * kPart); ++k) {
      find_neighbours(listed_[k], part.found);
      part.ends.push_back(static_cast<int>(part.found.size()));
    }
    searched(p).store(true, std::memory_order_seq_cst);
    apply_what_is_ready();
  };
  if (team_)
    team_->run(parts, search);
  else
    for (int p = 0; p < parts; ++p) search(p);
  assert(next == parts);
}

std::uint32_t PairList::new_memory() {
  if (free_memory_.empty()) {
    memory_.emplace_back();
    rest_.emplace_back();
    return static_cast<std::uint32_t>(memory_.size() - 1);
  }
  const std::uint32_t id = free_memory_.back();
  free_memory_.pop_back();
  memory_[id] = {};
  rest_[id] = {};
  return id;
}

void PairList::add_entry(int i, Neighbour entry) {
  rows_.insert(i, place_in(rows_.row(i), entry.sphere), entry);
  if (entry.sphere < i) ++below_[i];
}

void PairList::take_entry(int i, int neighbour) {
  rows_.erase(i, place_in(rows_.row(i), neighbour));
  if (neighbour < i) --below_[i];
}

// Brings row i, and the entries of i in other rows, to what was found.
void PairList::apply(int i, std::span<const int> found, int movable) {
  row_.clear();
  int below = 0;
  const std::span<const Neighbour> old = rows_.row(i);
  const auto part_with = [&](const Neighbour& entry) {
    free_memory_.push_back(entry.memory());
    if (entry.sphere < movable) take_entry(entry.sphere, i);
  };
  std::size_t k = 0;
  new_.clear();
  for (const int j : found) {
    for (; k < old.size() && old[k].sphere < j; ++k) part_with(old[k]);
    if (j < i) ++below;
    if (k < old.size() && old[k].sphere == j) {
      row_.push_back(old[k++]);
      continue;
    }
    row_.push_back({j, new_memory() << 1});
    if (j < movable) new_.push_back(row_.back());
  }
  for (; k < old.size(); ++k) part_with(old[k]);
  // New pairs enter the other rows when this one is not read any more: rows may move.
  rows_.assign(i, row_);
  below_[i] = below;
  for (const Neighbour& entry : new_) add_entry(entry.sphere, {i, entry.tag});
}

void PairList::clear_row(int i, int movable) {
  for (const Neighbour& entry : rows_.row(i)) {
    free_memory_.push_back(entry.memory());
    if (entry.sphere < movable) take_entry(entry.sphere, i);
  }
  rows_.assign(i, {});
  below_[i] = 0;
}

std::size_t PairList::bytes() const {
  return rows_.bytes() + below_.capacity() * sizeof(std::int32_t) +
         memory_.capacity() * sizeof(ContactMemory) + rest_.capacity() * sizeof(RestForce) +
         free_memory_.capacity() * sizeof(std::uint32_t) + grid_.bytes();
}

}  // namespace scree
