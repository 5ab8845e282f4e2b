#include "sim/world/step_kernels.h"

#include <bit>

namespace scree {
namespace {

constexpr int kBatch = 64, kOpen = 64;

// Contacts on their way through the law. An entry stands in the row of its owner, or in that of its partner
// if only this one is awake.
struct Batch {
  int count = 0;
  int owner[kBatch + kLanes], partner[kBatch + kLanes];
  Neighbour* entry[kBatch + kLanes];
  SCREE_INLINE void add(int row, Neighbour& e) {
    owner[count] = row < e.sphere ? row : e.sphere;
    partner[count] = row < e.sphere ? e.sphere : row;
    entry[count++] = &e;
  }
};

// Pairs that were open in the last step.
struct Open {
  int count = 0;
  int row[kOpen + kLanes];
  Neighbour* entry[kOpen + kLanes];
};

SCREE_INLINE LaneVec3 load4(const Quad* quads, const int* index, Lanes& companion) {
  Lanes a = load(quads[index[0]]), b = load(quads[index[1]]), c = load(quads[index[2]]),
        d = load(quads[index[3]]);
  transpose(a, b, c, d);
  companion = d;
  return {a, b, c};
}
static_assert(sizeof(ContactMemory) == 8 * sizeof(float));
SCREE_INLINE LaneFloats load_half(const ContactMemory& m, int half) {
  LaneFloats v;
  __builtin_memcpy(&v, reinterpret_cast<const char*>(__builtin_assume_aligned(&m, 32)) + 16 * half, 16);
  return v;
}
SCREE_INLINE void store_half(ContactMemory& m, int half, LaneFloats v) {
  __builtin_memcpy(reinterpret_cast<char*>(__builtin_assume_aligned(&m, 32)) + 16 * half, &v, 16);
}
SCREE_INLINE Lanes wide(LaneFloats v) {
  return __builtin_convertvector(v, Lanes);
}
SCREE_INLINE LaneFloats narrow(Lanes v) {
  return __builtin_convertvector(v, LaneFloats);
}

// A contact of row i has closed or opened since the last step.
void close_or_open(const StepView& view, BlockWork& work, int i, Neighbour& entry) {
  const Spheres& s = view.spheres;
  view.pairs.turn(i, entry);
  if (entry.touching()) return;
  view.pairs.memory(entry) = {};
  const int j = entry.sphere;
  if (j >= s.movable || s.asleep[i] == s.asleep[j]) return;
  const int sleeper = s.asleep[i] ? i : j;
  if (view.sleep.disturbs(view.pairs.rest(entry.memory()), sleeper, Vec3::Zero()))
    work.disturbed.push_back(sleeper);
}

// Adds the force of contact `at` to its pieces.
SCREE_INLINE void add_force(const StepView& view, BlockWork& work, const Batch& batch, int at, Lanes force,
                            Lanes torque1, Lanes torque2) {
  const Spheres& s = view.spheres;
  const int i = batch.owner[at], j = batch.partner[at];
  if (view.sleep.asleep() > 0 && j < s.movable && (s.asleep[i] | s.asleep[j]) != 0) {
    const int sleeper = s.asleep[i] ? i : j;
    if (view.sleep.disturbs(view.pairs.rest(batch.entry[at]->memory()), sleeper,
                            Vec3(force[0], force[1], force[2])))
      work.disturbed.push_back(sleeper);
  }
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

// The law for four contacts from `at` on, of which the first `count` are there.
SCREE_INLINE void four_contacts(const StepView& view, BlockWork& work, const Batch& batch, int at, int count,
                                Lanes& overlap_ratio) {
  const Spheres& s = view.spheres;
  ContactMemory* memories = view.pairs.memories();
  const int *first = batch.owner + at, *second = batch.partner + at;
  Lanes r1, r2, m1, m2, unused;
  const LaneVec3 x1 = load4(s.place.data(), first, r1), x2 = load4(s.place.data(), second, r2);
  const LaneVec3 v1 = load4(s.velocity.data(), first, m1), v2 = load4(s.velocity.data(), second, m2);
  const LaneVec3 w1 = load4(s.spin.data(), first, unused), w2 = load4(s.spin.data(), second, unused);

  const Lanes zero{}, one = zero + 1.0;
  const LaneVec3 apart = x2 - x1;
  const Lanes distance = root(apart.squaredNorm()), per_distance = one / distance;
  const LaneMask distinct = distance > zero;
  BasicContactMotion<Lanes> motion;
  motion.normal = {pick(distinct, apart.x_ * per_distance, zero),
                   pick(distinct, apart.y_ * per_distance, zero),
                   pick(distinct, apart.z_ * per_distance, one)};
  motion.overlap = r1 + r2 - distance;
  const unsigned there = (1u << count) - 1u, opened = ~signs(-motion.overlap) & there;
  // The contact point halves the overlap. It may lie beyond the centre of a small sphere pressed into a
  // block: the arms always add up to the distance, so angular momentum is kept.
  const Lanes arm1 = r1 - 0.5 * motion.overlap, arm2 = r2 - 0.5 * motion.overlap;
  motion.velocity = v2 - v1 - (arm1 * w1 + arm2 * w2).cross(motion.normal);
  motion.spin = w2 - w1;
  motion.twist = 0.5 * (w1 + w2).dot(motion.normal);
  motion.dt = view.last_dt;
  if (view.law.beta_n > 0 || view.law.beta_s > 0) {
    for (int k = 0; k < kLanes; ++k)
      if (second[k] >= s.movable) m2[k] = 1e300;
    motion.reduced_mass = m1 / (one + m1 / m2);
  } else {
    motion.reduced_mass = zero;
  }

  ContactMemory *a = memories + batch.entry[at]->memory(), *b = memories + batch.entry[at + 1]->memory(),
                *c = memories + batch.entry[at + 2]->memory(), *d = memories + batch.entry[at + 3]->memory();
  BasicContactHistory<Lanes> history;
  LaneFloats a0 = load_half(*a, 0), b0 = load_half(*b, 0), c0 = load_half(*c, 0), d0 = load_half(*d, 0);
  LaneFloats a1 = load_half(*a, 1), b1 = load_half(*b, 1), c1 = load_half(*c, 1), d1 = load_half(*d, 1);
  transpose(a0, b0, c0, d0);
  transpose(a1, b1, c1, d1);
  history.shear = {wide(a0), wide(b0), wide(c0)};
  history.rolling = {wide(d0), wide(a1), wide(b1)};

  const BasicContactForce<Lanes> f =
      contact_step<Lanes>(view.law, ball_ball<Lanes>(view.law, r1, r2), motion, history);

  a0 = narrow(history.shear.x_), b0 = narrow(history.shear.y_), c0 = narrow(history.shear.z_);
  d0 = narrow(history.rolling.x_), a1 = narrow(history.rolling.y_), b1 = narrow(history.rolling.z_);
  transpose(a0, b0, c0, d0);
  transpose(a1, b1, c1, d1);
  store_half(*a, 0, a0), store_half(*b, 0, b0), store_half(*c, 0, c0), store_half(*d, 0, d0);
  store_half(*a, 1, a1), store_half(*b, 1, b1), store_half(*c, 1, c1), store_half(*d, 1, d1);
  overlap_ratio = larger(overlap_ratio, motion.overlap / smaller(r1, r2));

  const LaneVec3 lever = motion.normal.cross(f.force);
  LaneVec3 force = f.force, torque1 = arm1 * lever + f.rolling, torque2 = arm2 * lever - f.rolling;
  Lanes counts = one, none1 = zero, none2 = zero;
  transpose(force.x_, force.y_, force.z_, counts);
  transpose(torque1.x_, torque1.y_, torque1.z_, none1);
  transpose(torque2.x_, torque2.y_, torque2.z_, none2);
  if (opened == 0 && count == kLanes) {
    add_force(view, work, batch, at, force.x_, torque1.x_, torque2.x_);
    add_force(view, work, batch, at + 1, force.y_, torque1.y_, torque2.y_);
    add_force(view, work, batch, at + 2, force.z_, torque1.z_, torque2.z_);
    add_force(view, work, batch, at + 3, counts, none1, none2);
    return;
  }
  const Lanes forces[] = {force.x_, force.y_, force.z_, counts},
              torques1[] = {torque1.x_, torque1.y_, torque1.z_, none1},
              torques2[] = {torque2.x_, torque2.y_, torque2.z_, none2};
  for (int k = 0; k < count; ++k) {
    if ((opened >> k & 1u) == 0) {
      add_force(view, work, batch, at + k, forces[k], torques1[k], torques2[k]);
      continue;
    }
    Neighbour& entry = *batch.entry[at + k];
    close_or_open(view, work, entry.sphere == first[k] ? second[k] : first[k], entry);
  }
}

// Computes the contacts of a batch; unless it is the last of a block, up to three wait for others.
SCREE_INLINE void compute(const StepView& view, Batch& batch, bool last, Lanes& overlap_ratio,
                          BlockWork& work) {
  int k = 0;
  for (; k + kLanes <= batch.count; k += kLanes) four_contacts(view, work, batch, k, kLanes, overlap_ratio);
  const int left = batch.count - k;
  for (int q = 0; q < left; ++q) {
    batch.owner[q] = batch.owner[k + q];
    batch.partner[q] = batch.partner[k + q];
    batch.entry[q] = batch.entry[k + q];
  }
  batch.count = left;
  if (!last || left == 0) return;
  for (int q = left; q < kLanes; ++q) {
    batch.owner[q] = batch.owner[left - 1];
    batch.partner[q] = batch.partner[left - 1];
    batch.entry[q] = batch.entry[left - 1];
  }
  four_contacts(view, work, batch, 0, left, overlap_ratio);
  batch.count = 0;
}

// Which of the open pairs have closed: they join the batch.
SCREE_INLINE void sieve(const StepView& view, Open& open, Batch& batch, Lanes& overlap_ratio,
                        BlockWork& work) {
  const Quad* place = view.spheres.place.data();
  for (int q = open.count; q < open.count + kLanes - 1 && open.count > 0; ++q) {
    open.row[q] = open.row[0];
    open.entry[q] = open.entry[0];
  }
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
      if (batch.count >= kBatch) compute(view, batch, false, overlap_ratio, work);
      close_or_open(view, work, open.row[q], *open.entry[q]);
      batch.add(open.row[q], *open.entry[q]);
    }
  }
  open.count = 0;
}

}  // namespace

SCREE_VECTORISED
void contact_forces(const StepView& view, BlockWork& work) {
  const Spheres& s = view.spheres;
  Batch batch;
  Open open;
  Lanes overlap_ratio{};
  work.far_blocks = 0;
  work.disturbed.clear();
  for (const int i : work.awake) store(view.sum[i].force, Lanes{}), store(view.sum[i].torque, Lanes{});
  const auto take = [&](int row, Neighbour& entry) __attribute__((always_inline)) {
    if (batch.count >= kBatch) compute(view, batch, false, overlap_ratio, work);
    if (open.count >= kOpen) sieve(view, open, batch, overlap_ratio, work);
    // Both lists get it, and one keeps it: no branch to guess wrong.
    const int touching = static_cast<int>(entry.tag & 1u), count = batch.count;
    batch.add(row, entry);
    batch.count = count + touching;
    open.row[open.count] = row;
    open.entry[open.count] = &entry;
    open.count += 1 - touching;
  };
  const bool sleepers = view.sleep.asleep() > 0;
  for (const int i : work.awake) {
    for (Neighbour& entry : view.pairs.owned(i)) take(i, entry);
    if (!sleepers) continue;
    for (Neighbour& entry : view.pairs.below(i))
      if (s.asleep[entry.sphere]) take(i, entry);
  }
  sieve(view, open, batch, overlap_ratio, work);
  compute(view, batch, true, overlap_ratio, work);
  for (int k = 0; k < kLanes; ++k)
    if (overlap_ratio[k] > work.overlap_ratio) work.overlap_ratio = overlap_ratio[k];
}

SCREE_VECTORISED
void leapfrog(const LeapfrogView& view, BlockWork& work) {
  Spheres& s = view.spheres;
  const Lanes zero{}, one = zero + 1.0, gravity = {view.gravity.x(), view.gravity.y(), view.gravity.z(), 0},
                      dt = {view.dt, view.dt, view.dt, 0};
  // f - alpha |f| sign(v); see locally_damped().
  const auto damped = [&](Lanes f, Lanes v, Lanes alpha) __attribute__((always_inline)) {
    const Lanes size = pick(f < zero, -f, f), sign = pick(v > zero, one, pick(v < zero, -one, zero));
    return f - alpha * size * sign;
  };
  for (const FarForces* far : work.inbox)
    for (const FarForces::Entry& entry : far->entries) {
      ForceSum& sum = view.sum[entry.sphere()];
      store(sum.force, load(sum.force) + entry.force);
      store(sum.torque, load(sum.torque) + entry.torque);  // the companion of a torque is not used
    }
  bool left = false;
  work.near_rim.clear();
  for (const int i : work.awake) {
    const Lanes force = load(view.sum[i].force), torque = load(view.sum[i].torque);
    Lanes v = load(s.velocity[i]), w = load(s.spin[i]), x = load(s.place[i]);
    const Lanes alpha = zero + (view.damped_in_flight || force[3] > 0 ? view.alpha : 0.0);
    const double mass = v[3], inertia = w[3];
    v += dt / mass * damped(force + mass * gravity, v, alpha);
    w += dt / inertia * damped(torque, w, alpha);
    x += dt * v;
    store(s.velocity[i], v), store(s.spin[i], w), store(s.place[i], x);
    if (const double way_out2 = view.pairs.way_out2(i, s.place[i]); way_out2 > PairList::kNearRim2) {
      work.near_rim.push_back(i);
      left = left || way_out2 > 1;
    }
  }
  work.left_ball = left;
}

}  // namespace scree
