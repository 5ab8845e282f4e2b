// What of a world goes into a checkpoint: one function a class, which both writes and reads.
//
// A new member of a class below that a later step depends on is added to its function here, and the section's
// version is raised. The test SavedWorlds.HoldEveryMember fails when a class has grown, so that none is
// forgotten.
#include <fmt/format.h>

#include "sim/world/rrlinear_world.h"

namespace scree {

// Bytes that are the value: no pointers, no padding.
template <>
inline constexpr bool kPlainState<Quad> = sizeof(Quad) == 4 * sizeof(double);
template <>
inline constexpr bool kPlainState<Neighbour> = sizeof(Neighbour) == 8;
template <>
inline constexpr bool kPlainState<ContactMemory> = sizeof(ContactMemory) == 8 * sizeof(float);
template <>
inline constexpr bool kPlainState<RestForce> = sizeof(RestForce) == 16;
template <>
inline constexpr bool kPlainState<ForceSum> = sizeof(ForceSum) == 2 * sizeof(Quad);
template <>
inline constexpr bool kPlainState<FacetRef> = sizeof(FacetRef) == 2 * sizeof(int);
template <>
inline constexpr bool kPlainState<FrictionFactors> = sizeof(FrictionFactors) == 2 * sizeof(float);

template <class Stream>
void state(Stream& stream, Spheres& s) {
  stream(s.place, s.velocity, s.spin, s.id, s.dump, s.lost, s.asleep, s.movable, s.partner, s.angular);
}

template <class Stream>
void state(Stream& stream, BodyState& b) {
  stream(b.pose, b.velocity, b.spin);
}

template <class Stream>
void state(Stream& stream, ContactHistory& h) {
  stream(h.shear, h.rolling, h.twisting, h.dashpot_power);
}

template <class Stream>
void state(Stream& stream, MeshContact& c) {
  stream(c.body, c.normal, c.overlap, c.excess, c.history);
}

template <class Stream>
void state(Stream& stream, GrowingSphere& g) {
  stream(g.sphere, g.radius);
}

template <class Stream>
void state(Stream& stream, AwakeEnergy& e) {
  stream(e.kinetic, e.elastic, e.potential, e.scale);
}

template <class Stream>
void EnergyWatch::state(Stream& stream) {
  stream(known_, before_, supplied_, lost_before_);
}

template <class Stream>
void MeshBody::pose_state(Stream& stream) {
  stream(state_, marked_);
}

// Where rows lie in memory, and the room they have, is nobody's business.
template <class T>
template <class Stream>
void Rows<T>::state(Stream& stream) {
  std::vector<std::int32_t> counts;
  for (const Row& row : rows_) counts.push_back(row.count);
  stream(counts);
  if (Stream::kReads) reset(static_cast<int>(counts.size()));
  std::vector<T> items;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    items.resize(static_cast<std::size_t>(counts[i]));
    if (!Stream::kReads) std::copy_n(begin(static_cast<int>(i)), items.size(), items.begin());
    stream.bytes(items.data(), items.size() * sizeof(T));
    if (Stream::kReads) assign(static_cast<int>(i), items);
  }
}

// The cells follow from the places at which spheres were put; what a query finds does not depend on the order
// in which they came into their cells (PairList sorts it).
template <class Stream>
void NeighbourGrid::state(Stream& stream, Team* team) {
  std::vector<double> cells = cell_;
  std::vector<Quad> sites = site_;
  std::vector<std::int8_t> levels = level_;
  stream(cells, sites, levels);
  if (!Stream::kReads || cells.empty()) return;
  reset(static_cast<int>(sites.size()), cells.front() / kCellReaches, cells.back() / kCellReaches);
  std::vector<int> present;
  std::vector<Quad> at;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    site_[i] = sites[i];
    if (levels[i] < 0) continue;
    present.push_back(static_cast<int>(i));
    at.push_back(sites[i]);
  }
  place(present, at, team);
}

template <class Stream>
void PairList::state(Stream& stream) {
  grid_.state(stream, team_);
  rows_.state(stream);
  stream(below_, memory_, rest_, free_memory_, dropped_, listings_);
}

template <class Stream>
void FacetList::state(Stream& stream) {
  rows_.state(stream);
  std::vector<std::uint8_t> contacts = closed_, any;
  for (const int slot : slot_of_) any.push_back(slot >= 0 ? 1 : 0);
  stream(any, contacts, tool_skin_);
  if (Stream::kReads) {
    slot_of_.assign(any.size(), -1);
    closed_.assign(any.size(), 0);
    first_.assign(1, {});
    others_.assign(1, {});
    free_slots_.clear();
  }
  for (int i = 0; i < rows(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (any[k] == 0) continue;
    if (Stream::kReads) set_slot(i, true);
    Contacts held;
    if (!Stream::kReads) load(i, held);
    for (std::size_t c = 0; c < contacts[k]; ++c) stream(held[c]);
    if (Stream::kReads) store(i, held);
  }
}

template <class Stream>
void Sleep::state(Stream& stream) {
  stream(window_, window_end_, smallest_radius_, window_start_, quiet_windows_, tolerance2_, awake_,
         fallen_asleep_, asleep_, put_to_sleep_);
}

template <class Stream>
void RockWorld::shared_state(Stream& stream) {
  stream.section("world", 2);
  stream(time_, statistics_, account_, spheres_, fixed_, next_, reserved_, next_fragment_);
  if (Stream::kReads) {  // of the scene as it was built: made again when somebody asks
    for (std::size_t id = 0; id < bodies_.size(); ++id) drop_body(static_cast<std::int64_t>(id));
    bodies_.clear();
    shapes_.clear();
  }
  stream.section("meshes", 1);
  std::vector<std::uint8_t> there;
  for (const auto& mesh : meshes_) there.push_back(mesh ? 1 : 0);
  const std::vector<std::uint8_t> built = there;
  stream(there);
  if (there != built) throw StateError("saved state: it is of a scene with other meshes");
  for (const auto& mesh : meshes_)
    if (mesh) mesh->pose_state(stream);
}

template <class Stream>
void RrlinearWorld::state(Stream& stream) {
  shared_state(stream);
  stream.section("rrlinear", 3);
  stream(changed_, repair_due_, dt_, smallest_radius_, longest_step_, last_dt_, steps_to_check_,
         checks_to_energy_, energy_watch_, friction_, watched_, growing_, bears_, last_growth_, blocks_due_,
         pairs_, facets_, sleep_, sorted_spheres_, before_fragments_);
  // Forces on sleepers are not those of anything, nor are the companions of torques: what is added up there
  // depends on the threads.
  std::vector<ForceSum> sums(sum_.size());
  for (const int i : sleep_.awake())
    if (!Stream::kReads && i < static_cast<int>(sums.size())) {
      sums[i] = sum_[i];
      sums[i].torque.w = 0;
    }
  stream(sums);
  if (Stream::kReads) sum_ = std::move(sums);
  // Of the blocks only that is wanted which the next step does not find out anew.
  std::vector<std::vector<int>> near_rim;
  for (const BlockWork& work : blocks_) near_rim.push_back(work.near_rim);
  stream(near_rim);
  if (!Stream::kReads) return;
  if (blocks_due_) {  // they are no longer those of the spheres awake
    blocks_.assign(near_rim.size(), {});
  } else {
    split_awake();
    if (near_rim.size() != blocks_.size()) throw StateError("saved state: it has other blocks");
  }
  for (std::size_t k = 0; k < near_rim.size(); ++k) blocks_[k].near_rim = std::move(near_rim[k]);
}

void RrlinearWorld::save_state(StateWriter& writer) {
  state(writer);
}

void RrlinearWorld::load_state(StateReader& reader) {
  state(reader);
}

}  // namespace scree
