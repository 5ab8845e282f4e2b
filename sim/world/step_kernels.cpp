#include "sim/world/step_kernels.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace scree {
namespace {

constexpr int kFull = 64;          // a queue this long is worked off
constexpr std::size_t kTake = 64;  // entries of a row that are taken between looks at the queues
constexpr std::size_t kAhead = 8;  // spheres whose rows are fetched ahead

// Pairs on their way. An entry stands in the row of its owner, or in that of its partner if only this one is
// awake.
template <std::size_t kRoom>
struct Queue {
  int count = 0;
  int row[kRoom];
  Neighbour* entry[kRoom];
  SCREE_INLINE void put(int at, int in_row, Neighbour& e) { row[at] = in_row, entry[at] = &e; }
  // Repeats the last one up to a full set of lanes.
  SCREE_INLINE void pad() {
    if (count == 0) return;
    for (int k = count; k % kLanes != 0; ++k) put(k, row[count - 1], *entry[count - 1]);
  }
};
// Before a piece of a row is taken both hold fewer than kFull; what was open joins the closed ones when the
// queues are worked off. Vectorised functions want the alignment.
struct alignas(32) Queues {
  Queue<kFull + kTake + kLanes> open;          // did not touch in the last step
  Queue<2 * (kFull + kTake) + kLanes> closed;  // touch
  Lanes overlap_ratio{};
  BasicContactLoss<Lanes> loss{};
};

SCREE_INLINE LaneVec3 load4(const Quad* quads, const int* index, Lanes& companion) {
  Lanes a = load(quads[index[0]]), b = load(quads[index[1]]), c = load(quads[index[2]]),
        d = load(quads[index[3]]);
  transpose(a, b, c, d);
  companion = d;
  return {a, b, c};
}
static_assert(sizeof(ContactMemory) == sizeof(TwinFloats));
SCREE_INLINE TwinFloats load(const ContactMemory& m) {
  TwinFloats v;
  __builtin_memcpy(&v, __builtin_assume_aligned(&m, sizeof v), sizeof v);
  return v;
}
SCREE_INLINE void store(ContactMemory& m, TwinFloats v) {
  __builtin_memcpy(__builtin_assume_aligned(&m, sizeof v), &v, sizeof v);
}

// A contact of spheres i and j has this force on the one that owns it: a sleeper among them may wake.
SCREE_INLINE void disturb(const StepView& view, BlockWork& work, int i, int j, const Neighbour& entry,
                          const Vec3& force) {
  const Spheres& s = view.spheres;
  if (j >= s.movable || s.asleep[i] == s.asleep[j]) return;
  const int sleeper = s.asleep[i] ? i : j;
  if (view.sleep.disturbs(view.pairs.rest(entry.memory()), sleeper, force)) work.disturbed.push_back(sleeper);
}

// A contact of row i has closed or opened since the last step. One that has opened has slipped by all that it
// remembered (contact_step).
void close_or_open(const StepView& view, BlockWork& work, int i, Neighbour& entry) {
  view.pairs.turn(i, entry);
  if (entry.touching()) return;
  disturb(view, work, i, entry.sphere, entry, Vec3::Zero());
}

// Adds the force of a contact to its pieces, of which `i` owns it.
SCREE_INLINE void add_force(const StepView& view, BlockWork& work, int i, int j, const Neighbour& entry,
                            Lanes force, Lanes torque1, Lanes torque2) {
  const Spheres& s = view.spheres;
  const bool closed = force[3] > 0;  // what is left of the pull of one that has opened disturbs nobody
  if (closed && view.sleep.asleep() > 0) disturb(view, work, i, j, entry, Vec3(force[0], force[1], force[2]));
  if (!s.asleep[i]) {
    ForceSum& own = view.sum[i];
    store(own.force, load(own.force) + force);
    store(own.torque, load(own.torque) + torque1);
  }
  if (j >= s.movable || s.asleep[j]) return;
  const LaneMask sign_bits = {1L << 63, 1L << 63, 1L << 63, 0};
  const Lanes back = reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(force) ^ sign_bits);
  if (!view.write_down || j < (work.block + 1) * kBlock) {
    ForceSum& other = view.sum[j];
    store(other.force, load(other.force) + back);
    store(other.torque, load(other.torque) + torque2);
    return;
  }
  const int block = j / kBlock;
  std::size_t to = 0;
  while (to < work.far_blocks && work.far[to].block != block) ++to;
  if (to == work.far_blocks) {
    if (++work.far_blocks > work.far.size()) work.far.emplace_back();
    work.far[to].block = block;
    work.far[to].entries.clear();
  }
  torque2[3] = j;
  work.far[to].entries.push_back({back, torque2});
}

// Four contacts in lanes: each one's entry, and the spheres that it joins.
struct FourContacts {
  Neighbour* entry[kLanes];
  int first[kLanes], second[kLanes];  // its owner and the other
};

// Spins of the first and the second of each pair, and velocity and spin of the second against the first.
struct Motions {
  LaneVector<LaneFloats> spin1, spin2;
  LaneVector<TwinFloats> relative;
};
SCREE_INLINE Motions motions_of(const Spheres& s, const FourContacts& four) {
  TwinFloats relative[kLanes], spins[kLanes];
  for (int k = 0; k < kLanes; ++k) {
    const int i = four.first[k], j = four.second[k];
    const Lanes w1 = load(s.spin[i]), w2 = load(s.spin[j]);
    relative[k] = twin(narrow(load(s.velocity[j]) - load(s.velocity[i])), narrow(w2 - w1));
    spins[k] = twin(narrow(w1), narrow(w2));
  }
  transpose(relative[0], relative[1], relative[2], relative[3]);
  transpose(spins[0], spins[1], spins[2], spins[3]);
  return {{first_half(spins[0]), first_half(spins[1]), first_half(spins[2])},
          {second_half(spins[0]), second_half(spins[1]), second_half(spins[2])},
          {relative[0], relative[1], relative[2]}};
}

// Friction of the contacts of four pairs.
SCREE_INLINE EffectFriction friction_of(const StepView& view, const FourContacts& four) {
  EffectFriction friction;
  for (int k = 0; k < kLanes; ++k) {
    const FrictionFactors &a = view.friction[four.first[k]], &b = view.friction[four.second[k]];
    friction.mu[k] = view.law.mu * a.mu * b.mu;
    friction.mu_r[k] = view.law.mu_r * a.mu_r * b.mu_r;
  }
  return friction;
}

// Adds what the first `count` of four contacts have lost.
template <bool kEffects>
SCREE_INLINE void add_loss(const StepView& view, BasicContactLoss<Lanes> loss, int count,
                           BasicContactLoss<Lanes>& sum) {
  if (count < kLanes) {
    const LaneMask there = LaneMask{0, 1, 2, 3} < LaneMask{} + count;
    const Lanes none{};
    loss.sliding = pick(there, loss.sliding, none), loss.rolling = pick(there, loss.rolling, none);
    loss.twisting = pick(there, loss.twisting, none), loss.dashpots = pick(there, loss.dashpots, none);
  }
  sum.sliding += loss.sliding, sum.rolling += loss.rolling;
  if (view.law.has_dashpots()) sum.dashpots += loss.dashpots;
  if constexpr (kEffects) sum.twisting += loss.twisting;
}

// The law for four contacts, of which the first `count` are there.
template <bool kEffects>
SCREE_INLINE void compute(const StepView& view, BlockWork& work, const FourContacts& four, int count,
                          Queues& queues) {
  const Spheres& s = view.spheres;
  const Lanes zero{}, one = zero + 1.0;
  Lanes r1, r2;
  const LaneVec3 x1 = load4(s.place.data(), four.first, r1), x2 = load4(s.place.data(), four.second, r2);
  const LaneVec3 apart = x2 - x1;
  const Lanes distance = root(apart.squaredNorm()), per_distance = one / distance;
  const LaneMask distinct = distance > zero;
  LaneContactMotion motion;
  motion.normal = {pick(distinct, apart.x_ * per_distance, zero),
                   pick(distinct, apart.y_ * per_distance, zero),
                   pick(distinct, apart.z_ * per_distance, one)};
  motion.overlap = r1 + r2 - distance;
  const unsigned opened = ~signs(-motion.overlap) & ((1u << count) - 1u);

  // The contact point halves the overlap. It may lie beyond the centre of a small sphere pressed into a
  // block: the arms always add up to the distance, so angular momentum is kept.
  const Lanes arm1 = r1 - 0.5 * motion.overlap, arm2 = r2 - 0.5 * motion.overlap;
  const Motions m = motions_of(s, four);
  const LaneVector<LaneFloats> n = narrow(motion.normal);
  const LaneVector<LaneFloats> rim = (m.spin1 * narrow(arm1) + m.spin2 * narrow(arm2)).cross(n);
  const LaneFloats nothing{};
  motion.rounded_normal = n;
  motion.velocity_and_spin = m.relative - LaneVector<TwinFloats>{twin(rim.x_, nothing), twin(rim.y_, nothing),
                                                                 twin(rim.z_, nothing)};
  motion.twist = (m.spin1 + m.spin2).dot(n) * 0.5f;
  motion.dt = view.last_dt;
  motion.reduced_mass = zero;
  if (view.law.has_dashpots())
    for (int k = 0; k < kLanes; ++k) motion.reduced_mass[k] = s.reduced_mass(four.first[k], four.second[k]);

  ContactMemory* const memories = view.pairs.memories();
  ContactMemory* memory[kLanes];
  TwinFloats held[kLanes];
  for (int k = 0; k < kLanes; ++k) held[k] = load(*(memory[k] = memories + four.entry[k]->memory()));
  transpose(held[0], held[1], held[2], held[3]);
  LaneContactHistory history = {{held[0], held[1], held[2]}, held[3]};
  const auto friction = [&] {
    if constexpr (kEffects)
      return friction_of(view, four);
    else
      return PlainFriction{view.law.mu, view.law.mu_r};
  }();
  const BasicContactForce<Lanes> f =
      contact_step(view.law, friction, ball_ball<Lanes>(view.law, r1, r2), motion, history);
  held[0] = history.springs.x_, held[1] = history.springs.y_, held[2] = history.springs.z_;
  held[3] = history.further;
  transpose(held[0], held[1], held[2], held[3]);
  for (int k = 0; k < kLanes; ++k) store(*memory[k], held[k]);
  queues.overlap_ratio = larger(queues.overlap_ratio, motion.overlap / smaller(r1, r2));
  add_loss<kEffects>(view, f.loss, count, queues.loss);

  const LaneVec3 lever = motion.normal.cross(f.force), moment1 = lever * arm1 + f.rolling,
                 moment2 = lever * arm2 - f.rolling;
  Lanes force[] = {f.force.x_, f.force.y_, f.force.z_, one};  // their companion counts contacts
  Lanes torque1[] = {moment1.x_, moment1.y_, moment1.z_, zero},
        torque2[] = {moment2.x_, moment2.y_, moment2.z_, zero};
  transpose(force[0], force[1], force[2], force[3]);
  transpose(torque1[0], torque1[1], torque1[2], torque1[3]);
  transpose(torque2[0], torque2[1], torque2[2], torque2[3]);
  if (opened == 0 && count == kLanes) {  // nearly always; without a branch each
#pragma GCC unroll 4
    for (int k = 0; k < kLanes; ++k)
      add_force(view, work, four.first[k], four.second[k], *four.entry[k], force[k], torque1[k], torque2[k]);
    return;
  }
#pragma GCC unroll 1
  for (int k = 0; k < count; ++k) {
    Neighbour& entry = *four.entry[k];
    const bool opens = (opened >> k & 1u) != 0;
    if (opens) force[k][3] = 0;
    if (!opens || (kEffects && view.law.pull > 0))
      add_force(view, work, four.first[k], four.second[k], entry, force[k], torque1[k], torque2[k]);
    if (opens)
      close_or_open(view, work, entry.sphere == four.first[k] ? four.second[k] : four.first[k], entry);
  }
}

// Which of the open pairs have closed: they join the others.
SCREE_INLINE void sieve(const StepView& view, BlockWork& work, Queues& queues) {
  const Quad* place = view.spheres.place.data();
  auto& open = queues.open;
  open.pad();
  for (int k = 0; k < open.count; k += kLanes) {
    const int partner[kLanes] = {open.entry[k]->sphere, open.entry[k + 1]->sphere, open.entry[k + 2]->sphere,
                                 open.entry[k + 3]->sphere};
    Lanes r1, r2;
    const LaneVec3 apart = load4(place, open.row + k, r1) - load4(place, partner, r2);
    const Lanes reach = r1 + r2;
    unsigned closed = signs(apart.squaredNorm() - reach * reach);
    if (open.count - k < kLanes) closed &= (1u << (open.count - k)) - 1u;
    for (; closed != 0; closed &= closed - 1) {
      const int q = k + std::countr_zero(closed);
      close_or_open(view, work, open.row[q], *open.entry[q]);
      queues.closed.put(queues.closed.count++, open.row[q], *open.entry[q]);
    }
  }
  open.count = 0;
}

// Computes what has been collected; unless it is the last of a block, up to three contacts wait for others.
template <bool kEffects>
SCREE_INLINE void work_off_as(const StepView& view, BlockWork& work, Queues& queues, bool last) {
  sieve(view, work, queues);
  auto& closed = queues.closed;
  assert(closed.count <= static_cast<int>(2 * (kFull + kTake)));
  if (last) closed.pad();
  int k = 0;
  for (; k < closed.count; k += kLanes) {
    const int count = std::min(closed.count - k, kLanes);
    if (count < kLanes && !last) break;
    FourContacts four;
    for (int q = 0; q < kLanes; ++q) {
      const int row = closed.row[k + q], other = closed.entry[k + q]->sphere;
      four.entry[q] = closed.entry[k + q];
      four.first[q] = std::min(row, other);
      four.second[q] = std::max(row, other);
    }
    compute<kEffects>(view, work, four, count, queues);
  }
  const int left = std::max(closed.count - k, 0);
  for (int q = 0; q < left; ++q) closed.put(q, closed.row[k + q], *closed.entry[k + q]);
  closed.count = left;
}
SCREE_VECTORISED
void work_off(const StepView& view, BlockWork& work, Queues& queues, bool last) {
  work_off_as<false>(view, work, queues, last);
}
SCREE_VECTORISED
void work_off_with_effects(const StepView& view, BlockWork& work, Queues& queues, bool last) {
  work_off_as<true>(view, work, queues, last);
}

}  // namespace

void split_into_blocks(std::span<const int> awake, std::vector<BlockWork>& blocks) {
  std::size_t count = 0;
  for (std::size_t a = 0; a < awake.size();) {
    const std::size_t first = a;
    const int block = awake[a] / kBlock;
    while (a < awake.size() && awake[a] / kBlock == block) ++a;
    if (blocks.size() == count) blocks.emplace_back();
    BlockWork& work = blocks[count++];
    work.block = block;
    work.awake = awake.subspan(first, a - first);
    work.near_rim.clear();
  }
  blocks.resize(count);
}

void contact_forces(const StepView& view, BlockWork& work) {
  const Spheres& s = view.spheres;
  Queues queues;
  auto& open = queues.open;
  auto& closed = queues.closed;
  work.far_blocks = 0;
  work.disturbed.clear();
  const auto put = [&](int row, Neighbour& entry) {
    // Both queues get it, and one keeps it: no branch to guess wrong.
    const int touching = entry.touching() ? 1 : 0;
    closed.put(closed.count, row, entry);
    open.put(open.count, row, entry);
    closed.count += touching;
    open.count += 1 - touching;
    __builtin_prefetch(view.pairs.memories() + entry.memory(), 1);
  };
  const auto work_it_off = view.friction == nullptr ? work_off : work_off_with_effects;
  const auto work_off_if_full = [&] {
    if (closed.count >= kFull || open.count >= kFull) work_it_off(view, work, queues, false);
  };
  for (const int i : work.awake) view.sum[i] = {};
  const bool sleepers = view.sleep.asleep() > 0;
  for (std::size_t n = 0; n < work.awake.size(); ++n) {
    const int i = work.awake[n];
    if (n + kAhead < work.awake.size())
      __builtin_prefetch(view.pairs.neighbours(work.awake[n + kAhead]).data());
    const std::span<Neighbour> owned = view.pairs.owned(i);
    for (std::size_t first = 0; first < owned.size(); first += kTake) {
      for (Neighbour& entry : owned.subspan(first, std::min(kTake, owned.size() - first))) put(i, entry);
      work_off_if_full();
    }
    if (!sleepers) continue;
    for (Neighbour& entry : view.pairs.below(i)) {
      if (!s.asleep[entry.sphere]) continue;  // the entry may be turned by its owner's thread just now
      put(i, entry);
      work_off_if_full();
    }
  }
  work_it_off(view, work, queues, true);
  work.losses = {};
  for (int k = 0; k < kLanes; ++k) {
    work.overlap_ratio = std::max(work.overlap_ratio, queues.overlap_ratio[k]);
    work.losses.add({queues.loss.sliding[k], queues.loss.rolling[k], queues.loss.twisting[k],
                     queues.loss.dashpots[k], 0});
  }
}

namespace {

template <bool kClumps>
SCREE_INLINE void leapfrog_as(const LeapfrogView& view, BlockWork& work) {
  Spheres& s = view.spheres;
  const Lanes zero{}, one = zero + 1.0, gravity = {view.gravity.x(), view.gravity.y(), view.gravity.z(), 0},
                      dt = {view.dt, view.dt, view.dt, 0};
  // alpha |f| sign(v); see locally_damped().
  const auto damping = [&](Lanes f, Lanes v, Lanes alpha) __attribute__((always_inline)) {
    const Lanes size = pick(f < zero, -f, f), sign = pick(v > zero, one, pick(v < zero, -one, zero));
    return alpha * size * sign;
  };
  for (const FarForces* far : work.inbox)
    for (const FarForces::Entry& entry : far->entries) {
      ForceSum& sum = view.sum[entry.sphere()];
      store(sum.force, load(sum.force) + entry.force);
      store(sum.torque, load(sum.torque) + entry.torque);  // the companion of a torque is not used
    }
  bool left = false;
  Lanes damped = zero, momentum = zero;  // twice the work over dt, and twice the mean momentum
  work.near_rim.clear();
  for (const int i : work.awake) {
    if constexpr (kClumps)
      if (s.partner[i] >= 0) continue;
    const Lanes force = load(view.sum[i].force), torque = load(view.sum[i].torque);
    Lanes v = load(s.velocity[i]), w = load(s.spin[i]), x = load(s.place[i]);
    const Lanes alpha = zero + (force[3] > 0 ? view.alpha : view.alpha_in_flight);
    const double mass = v[3], inertia = w[3];
    const Lanes pull = force + mass * gravity, shift_damping = damping(pull, v, alpha),
                turn_damping = damping(torque, w, alpha), v0 = v, w0 = w;
    v += dt / mass * (pull - shift_damping);
    w += dt / inertia * (torque - turn_damping);
    x += dt * v;
    damped += shift_damping * (v0 + v) + turn_damping * (w0 + w);
    momentum += mass * (v0 + v);
    store(s.velocity[i], v), store(s.spin[i], w), store(s.place[i], x);
    if (const double way_out2 = view.pairs.way_out2(i, s.place[i]); way_out2 > PairList::kNearRim2) {
      work.near_rim.push_back(i);
      left = left || way_out2 > 1;
    }
  }
  work.left_ball = left;
  work.losses.local_damping = 0.5 * view.dt * (damped[0] + damped[1] + damped[2]);
  work.momentum = 0.5 * Vec3(momentum[0], momentum[1], momentum[2]);
}
SCREE_VECTORISED
void leapfrog_of_spheres(const LeapfrogView& view, BlockWork& work) {
  leapfrog_as<false>(view, work);
}
SCREE_VECTORISED
void leapfrog_beside_clumps(const LeapfrogView& view, BlockWork& work) {
  leapfrog_as<true>(view, work);
}

}  // namespace

void leapfrog(const LeapfrogView& view, BlockWork& work) {
  (view.spheres.partner.empty() ? leapfrog_of_spheres : leapfrog_beside_clumps)(view, work);
}

}  // namespace scree
