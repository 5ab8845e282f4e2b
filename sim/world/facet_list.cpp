#include "sim/world/facet_list.h"

#include <cmath>
#include <utility>

namespace scree {

std::vector<std::uint8_t> FacetList::renumber(const std::vector<int>& order, const Spheres& s,
                                              const Meshes& meshes) {
  const int n = s.movable;
  std::vector<std::uint8_t> bereft(s.size(), 0);
  std::vector<int> slot_of(n, -1);
  std::vector<std::uint8_t> closed(n, 0);
  std::vector<Contacts> contacts;  // of spheres that have facets
  for (int i = 0; i < n; ++i) {
    const int old = order[i];
    if (old >= static_cast<int>(slot_of_.size()) || slot_of_[old] < 0) continue;
    slot_of[i] = static_cast<int>(contacts.size()) + 1;
    Contacts& mine = contacts.emplace_back();
    for (int k = 0; k < closed_[old]; ++k) {
      if (meshes[contact(old, k).body])
        mine[closed[i]++] = contact(old, k);
      else
        bereft[i] = 1;
    }
  }
  slot_of_.swap(slot_of);
  closed_.assign(n, 0);
  first_.assign(contacts.size() + 1, {});
  others_.assign(contacts.size() + 1, {});
  for (int i = 0; i < n; ++i)
    if (slot_of_[i] >= 0) store(i, contacts[at(i) - 1]);
  free_slots_.clear();
  rows_.reset(n);
  return bereft;
}

void FacetList::find_boxes(bool tools_moved, const Meshes& meshes) {
  boxes_.clear();
  for (std::size_t b = 0; b < meshes.size(); ++b) {
    if (!meshes[b]) continue;
    if (tools_moved) meshes[b]->mark();
    btVector3 low, high;
    meshes[b]->body().getCollisionShape()->getAabb(to_bullet(meshes[b]->state().pose), low, high);
    boxes_.push_back({static_cast<int>(b), meshes[b]->motion().moves(), from_bullet(low), from_bullet(high)});
  }
}

void FacetList::list_all(const Spheres& s, const PairList& pairs, const Meshes& meshes) {
  find_boxes(true, meshes);
  for (int i = 0; i < s.movable; ++i) list_one(i, true, s, pairs, meshes);
}

void FacetList::list(std::span<const int> listed, bool tools_moved, const Spheres& s, const PairList& pairs,
                     const Meshes& meshes) {
  find_boxes(tools_moved, meshes);
  for (const int i : listed) list_one(i, true, s, pairs, meshes);
  if (tools_moved)
    for (int i = 0; i < s.movable; ++i) list_one(i, false, s, pairs, meshes);
}

// `anew`: all its facets; otherwise those of meshes that move.
void FacetList::list_one(int i, bool anew, const Spheres& s, const PairList& pairs, const Meshes& meshes) {
  if (s.lost[i]) {
    rows_.assign(i, {});
    set_slot(i, false);
    return;
  }
  const Vec3 x = pairs.ball_at(i);
  // Two tool skins: this tool may be one away from its mark already and one to go.
  const double range = s.place[i].w + pairs.skin(i, s.place[i]) + 2.0 * tool_skin_;
  const auto near = [&](const Box& box) {
    return ((x - box.low).array() >= -range).all() && ((x - box.high).array() <= range).all();
  };
  if (rows_.count(i) == 0) {  // nothing to take over: most spheres
    bool any = false;
    for (const Box& box : boxes_) any = any || ((anew || box.moves) && near(box));
    if (!any) return set_slot(i, false);
  }
  row_.clear();
  for (const Box& box : boxes_) {
    if (!anew && !box.moves) {
      for (const FacetRef& f : rows_.row(i))
        if (f.body == box.body) row_.push_back(f);
      continue;
    }
    if (!near(box)) continue;
    found_.clear();
    const MeshBody& mesh = *meshes[box.body];
    mesh.facets_near(x, range, found_);
    const Vec3 local = mesh.state().pose.to_local(x);
    for (const int f : found_) {
      const Facet& facet = mesh.facets()[f];
      if (std::abs((local - facet.a).dot(facet.normal)) < range && facet.box_within(local, range))
        row_.push_back({box.body, f});
    }
  }
  rows_.assign(i, row_);
  set_slot(i, !row_.empty());
}

void FacetList::set_slot(int i, bool needed) {
  if (needed == (slot_of_[i] >= 0)) return;
  if (!needed) {
    free_slots_.push_back(slot_of_[i]);
    slot_of_[i] = -1;
    closed_[i] = 0;
    return;
  }
  if (free_slots_.empty()) {
    slot_of_[i] = static_cast<int>(first_.size());
    first_.emplace_back();
    others_.emplace_back();
  } else {
    slot_of_[i] = free_slots_.back();
    free_slots_.pop_back();
  }
  closed_[i] = 0;
}

void FacetList::store(int i, const Contacts& contacts) {
  closed_[i] = 0;
  for (const MeshContact& contact : contacts) {
    if (contact.body < 0) break;
    (closed_[i] == 0 ? first_[at(i)] : others_[at(i)][static_cast<std::size_t>(closed_[i]) - 1]) = contact;
    ++closed_[i];
  }
}

std::vector<int> FacetList::near_tools(const Meshes& meshes, double time) const {
  std::vector<int> spheres;
  bool any_moves = false;
  for (const auto& mesh : meshes)
    any_moves = any_moves || (mesh && mesh->motion().moves() && mesh->motion().last_time() >= time);
  if (!any_moves) return spheres;
  for (int i = 0; i < rows(); ++i)
    for (const FacetRef& f : facets(i)) {
      const Motion& motion = meshes[f.body]->motion();
      if (!motion.moves() || motion.last_time() < time) continue;
      spheres.push_back(i);
      break;
    }
  return spheres;
}

std::size_t FacetList::bytes() const {
  return rows_.bytes() + slot_of_.capacity() * sizeof(int) + first_.capacity() * sizeof(Contacts) +
         closed_.capacity();
}

}  // namespace scree
