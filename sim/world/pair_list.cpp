#include "sim/world/pair_list.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace scree {
namespace {
// Skin of a sphere at rest, as a share of its radius: small enough to list few pairs that do not touch, large
// enough that a settling pile seldom repairs.
constexpr double kSkinAtRest = 0.12;
constexpr int kPart = 64;  // spheres that one task looks up
}  // namespace

void PairList::list_anew(int i, const Spheres& s, double horizon) {
  const double radius = s.place[i].w;
  double skin = 0.0;
  if (i < s.movable) {
    skin = kSkinAtRest * radius + s.velocity[i].vec().norm() * horizon;
    skin = std::min(skin, grid_.max_reach() - radius);
  }
  skin2_[i] = skin * skin;
  radius_[i] = radius;
  grid_.place(i, s.place[i].vec(), radius + skin);
}

void PairList::rebuild(const Spheres& s, const std::vector<int>& order, double horizon) {
  const int n = s.size();
  // Pairs of before, under their new numbers.
  std::vector<int> new_index(n, -1);
  for (int k = 0; k < n; ++k)
    if (order[k] >= 0) new_index[order[k]] = k;
  struct Kept {
    std::uint64_t key;
    int pair;
    bool swapped;
  };
  std::vector<Kept> kept;
  for (int i = 0; i < rows(); ++i)
    for (int p = begin_[i]; p < begin_[i + 1]; ++p) {
      if (!touching[p]) continue;
      const int a = new_index[i], b = new_index[partner_[p]];
      if (a < 0 || b < 0) continue;
      kept.push_back(
          {static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint64_t>(std::max(a, b)), p,
           a > b});
    }
  std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) { return a.key < b.key; });
  const std::vector<ContactHistory> old_history = history;
  const std::vector<Vec3> old_rest_force = rest_force;
  const std::vector<std::uint8_t> old_rest_known = rest_known;

  double min_radius = std::numeric_limits<double>::max(), max_radius = 0;
  for (int i = 0; i < n; ++i) {
    if (s.lost[i]) continue;
    min_radius = std::min(min_radius, s.place[i].w);
    max_radius = std::max(max_radius, s.place[i].w);
  }
  begin_.assign(n + 1, 0);
  partner_.clear();
  history.clear();
  touching.clear();
  rest_force.clear();
  rest_known.clear();
  dirty_.assign(n, 0);
  radius_.assign(n, 0.0);
  skin2_.assign(n, 0.0);
  dropped_.clear();
  listed_.clear();
  if (max_radius > 0) {
    grid_.reset(n, min_radius * (1 + kSkinAtRest), 2.0 * max_radius);
    for (int i = 0; i < n; ++i) {
      if (s.lost[i]) continue;
      list_anew(i, s, horizon);
      if (i < s.movable) listed_.push_back(i);
    }
  }
  find_pairs_of(listed_, s);
  merge(s);
  for (const Kept& k : kept) {
    const int owner = static_cast<int>(k.key >> 32), other = static_cast<int>(k.key & 0xffffffffu);
    const auto row = partner_.begin() + begin_[owner], row_end = partner_.begin() + begin_[owner + 1];
    const auto at = std::lower_bound(row, row_end, other);
    assert(at != row_end && *at == other);
    const auto p = static_cast<std::size_t>(at - partner_.begin());
    touching[p] = 1;
    // Forces and moments act on piece 1, so they change sign with the order of the pieces.
    const double sign = k.swapped ? -1.0 : 1.0;
    history[p].shear = sign * old_history[k.pair].shear;
    history[p].rolling = sign * old_history[k.pair].rolling;
    rest_force[p] = sign * old_rest_force[k.pair];
    rest_known[p] = old_rest_known[k.pair];
  }
}

const std::vector<int>& PairList::repair(const Spheres& s, double horizon) {
  listed_.clear();
  std::sort(dropped_.begin(), dropped_.end());
  for (const int i : dropped_) grid_.remove(i);
  for (int i = 0; i < s.movable; ++i) {
    if (s.lost[i] || s.asleep[i]) continue;
    const Vec3& at = grid_.position(i);
    if ((s.place[i].vec() - at).squaredNorm() > 0.5 * skin2_[i]) listed_.push_back(i);
  }
  for (const int i : listed_) list_anew(i, s, horizon);
  for (const int i : dropped_) listed_.push_back(i);
  find_pairs_of(listed_, s);
  for (std::size_t k = 0; k < dropped_.size(); ++k) listed_.pop_back();
  merge(s);
  dropped_.clear();
  return listed_;
}

void PairList::find_pairs_of(int i, std::vector<std::uint64_t>& found) const {
  const Vec3& x = grid_.position(i);
  const double reach = grid_.reach(i);
  grid_.query(i, [&](int j) {
    if (dirty_[j] && j < i) return;  // found from the other side
    const double range = reach + grid_.reach(j);
    if ((x - grid_.position(j)).squaredNorm() >= range * range) return;
    found.push_back(static_cast<std::uint64_t>(std::min(i, j)) << 32 |
                    static_cast<std::uint64_t>(std::max(i, j)));
  });
}

void PairList::find_pairs_of(const std::vector<int>& listed, const Spheres& s) {
  found_.clear();
  for (const int i : listed) dirty_[i] = 1;
  const int count = static_cast<int>(listed.size());
  if (for_ranges_ && count > kPart) {
    const int parts = (count + kPart - 1) / kPart;
    if (static_cast<int>(found_parts_.size()) < parts) found_parts_.resize(parts);
    for_ranges_(parts, [&](int first, int last) {
      for (int part = first; part < last; ++part) {
        found_parts_[part].clear();
        for (int k = part * kPart; k < std::min(count, (part + 1) * kPart); ++k)
          if (!s.lost[listed[k]]) find_pairs_of(listed[k], found_parts_[part]);
      }
    });
    for (int part = 0; part < parts; ++part)
      found_.insert(found_.end(), found_parts_[part].begin(), found_parts_[part].end());
  } else {
    for (const int i : listed)
      if (!s.lost[i]) find_pairs_of(i, found_);
  }
  std::sort(found_.begin(), found_.end());
}

void PairList::merge(const Spheres& s) {
  const int n = s.size();
  new_begin_.resize(n + 1);
  new_partner_.clear();
  new_history_.clear();
  new_touching_.clear();
  new_rest_force_.clear();
  new_rest_known_.clear();
  std::size_t f = 0;
  for (int i = 0; i < n; ++i) {
    new_begin_[i] = static_cast<int>(new_partner_.size());
    int p = i < rows() ? begin_[i] : 0;
    const int p_end = i < rows() ? begin_[i + 1] : 0;
    while (true) {
      const bool has_found = f < found_.size() && static_cast<int>(found_[f] >> 32) == i;
      const int found =
          has_found ? static_cast<int>(found_[f] & 0xffffffffu) : std::numeric_limits<int>::max();
      if (p < p_end && partner_[p] <= found) {
        const int j = partner_[p];
        if (j == found || !(dirty_[i] || dirty_[j])) {
          new_partner_.push_back(j);
          new_history_.push_back(history[p]);
          new_touching_.push_back(touching[p]);
          new_rest_force_.push_back(rest_force[p]);
          new_rest_known_.push_back(rest_known[p]);
        }
        if (j == found) ++f;
        ++p;
      } else if (has_found) {
        new_partner_.push_back(found);
        new_history_.emplace_back();
        new_touching_.push_back(0);
        new_rest_force_.push_back(Vec3::Zero());
        new_rest_known_.push_back(0);
        ++f;
      } else {
        break;
      }
    }
  }
  new_begin_[n] = static_cast<int>(new_partner_.size());
  begin_.swap(new_begin_);
  partner_.swap(new_partner_);
  history.swap(new_history_);
  touching.swap(new_touching_);
  rest_force.swap(new_rest_force_);
  rest_known.swap(new_rest_known_);
  for (const int i : listed_) dirty_[i] = 0;
  for (const int i : dropped_) dirty_[i] = 0;
  index_incoming(n);
}

void PairList::index_incoming(int count) {
  incoming_begin.assign(count + 1, 0);
  for (const int j : partner_) ++incoming_begin[j + 1];
  for (int i = 0; i < count; ++i) incoming_begin[i + 1] += incoming_begin[i];
  incoming_pair.resize(partner_.size());
  owner_.resize(partner_.size());
  next_.assign(incoming_begin.begin(), incoming_begin.end() - 1);
  for (int i = 0; i < count; ++i)
    for (int p = begin_[i]; p < begin_[i + 1]; ++p) {
      owner_[p] = i;
      incoming_pair[next_[partner_[p]]++] = p;
    }
}

}  // namespace scree
