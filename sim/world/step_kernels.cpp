#include "sim/world/step_kernels.h"

#include <bit>

namespace scree {
namespace {

constexpr int kBatch = 96;  // contacts computed before their forces are added: they stay in the first cache

// Closed contacts on their way through the law.
struct Batch {
  int count = 0;
  int owner[kBatch + 3 * kLanes], partner[kBatch + 3 * kLanes];
  std::uint32_t memory[kBatch + 3 * kLanes];
  Quad force[kBatch + 3 * kLanes], torque1[kBatch + 3 * kLanes], torque2[kBatch + 3 * kLanes];
};

SCREE_INLINE LaneVec3 load4(const Quad* quads, const int* index, Lanes& companion) {
  Lanes a = load(quads[index[0]]), b = load(quads[index[1]]), c = load(quads[index[2]]),
        d = load(quads[index[3]]);
  transpose(a, b, c, d);
  companion = d;
  return {a, b, c};
}
SCREE_INLINE void store4(Quad* quads, LaneVec3 v, Lanes companion) {
  transpose(v.x_, v.y_, v.z_, companion);
  store(quads[0], v.x_);
  store(quads[1], v.y_);
  store(quads[2], v.z_);
  store(quads[3], companion);
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

// The law for four contacts, from `at` on.
SCREE_INLINE void four_contacts(const StepView& view, Batch& batch, int at, Lanes& overlap_ratio) {
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

  ContactMemory *a = memories + batch.memory[at], *b = memories + batch.memory[at + 1],
                *c = memories + batch.memory[at + 2], *d = memories + batch.memory[at + 3];
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

  const LaneVec3 lever = motion.normal.cross(f.force);
  store4(batch.force + at, f.force, one);
  store4(batch.torque1 + at, arm1 * lever + f.rolling, zero);
  store4(batch.torque2 + at, arm2 * lever - f.rolling, zero);
  overlap_ratio = larger(overlap_ratio, motion.overlap / smaller(r1, r2));
}

SCREE_INLINE void finish_batch(const StepView& view, Batch& batch, Lanes& overlap_ratio, BlockWork& work) {
  const Spheres& s = view.spheres;
  const bool sleepers = view.sleep.asleep() > 0;
  if (batch.count == 0) return;
  for (int k = batch.count; k < batch.count + kLanes - 1; ++k) {
    batch.owner[k] = batch.owner[batch.count - 1];
    batch.partner[k] = batch.partner[batch.count - 1];
    batch.memory[k] = batch.memory[batch.count - 1];
  }
  for (int k = 0; k < batch.count; k += kLanes) four_contacts(view, batch, k, overlap_ratio);

  const int end = (work.block + 1) * kBlock;
  const LaneMask sign_bits = {1L << 63, 1L << 63, 1L << 63, 0};
  for (int k = 0; k < batch.count; ++k) {
    const int i = batch.owner[k], j = batch.partner[k];
    const Lanes force = load(batch.force[k]);
    if (sleepers && j < s.movable && s.asleep[i] != s.asleep[j]) {
      const int sleeper = s.asleep[i] ? i : j;
      if (view.sleep.disturbs(view.pairs.rest(batch.memory[k]), sleeper, batch.force[k].vec()))
        work.disturbed.push_back(sleeper);
    }
    if (!sleepers || !s.asleep[i]) {
      ForceSum& own = view.sum[i];
      store(own.force, load(own.force) + force);
      store(own.torque, load(own.torque) + load(batch.torque1[k]));
    }
    if (j >= s.movable || (sleepers && s.asleep[j])) continue;
    const Lanes back = reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(force) ^ sign_bits);
    if (j < end || !view.write_down) {
      ForceSum& other = view.sum[j];
      store(other.force, load(other.force) + back);
      store(other.torque, load(other.torque) + load(batch.torque2[k]));
    } else {
      const int block = j / kBlock;
      std::size_t at = 0;
      while (at < work.far_blocks && work.far[at].block != block) ++at;
      if (at == work.far_blocks) {
        if (++work.far_blocks > work.far.size()) work.far.emplace_back();
        work.far[at].block = block;
        work.far[at].entries.clear();
      }
      work.far[at].entries.push_back({back, load(batch.torque2[k]), j});
    }
  }
  batch.count = 0;
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

}  // namespace

SCREE_VECTORISED
void contact_forces(const StepView& view, BlockWork& work) {
  const Spheres& s = view.spheres;
  const Quad* place = s.place.data();
  Batch batch;
  Lanes overlap_ratio{};
  work.far_blocks = 0;
  work.disturbed.clear();
  for (const int i : work.awake) store(view.sum[i].force, Lanes{}), store(view.sum[i].torque, Lanes{});
  const bool sleepers = view.sleep.asleep() > 0;
  for (const int i : work.awake) {
    const std::span<Neighbour> row = view.pairs.owned(i);
    const int count = static_cast<int>(row.size());
    const Lanes zero{}, xi = zero + place[i].x, yi = zero + place[i].y, zi = zero + place[i].z,
                        ri = zero + place[i].w;
    for (int k = 0; k < count; k += kLanes) {
      // Lanes behind the row's end look at what lies there (Rows::kBehind) and are masked.
      Neighbour* const entry = row.data() + k;
      const int partner[kLanes] = {entry[0].sphere, entry[1].sphere, entry[2].sphere, entry[3].sphere};
      const unsigned tag[kLanes] = {entry[0].tag, entry[1].tag, entry[2].tag, entry[3].tag};
      Lanes rj;
      const LaneVec3 apart = load4(place, partner, rj) - LaneVec3{xi, yi, zi};
      const Lanes reach = ri + rj;
      const unsigned lanes = count - k < kLanes ? (1u << (count - k)) - 1u : 0xfu;
      const unsigned closed = signs(apart.squaredNorm() - reach * reach) & lanes;
      for (int q = 0; q < kLanes; ++q) {
        batch.owner[batch.count] = i;
        batch.partner[batch.count] = partner[q];
        batch.memory[batch.count] = tag[q] >> 1;
        batch.count += static_cast<int>(closed >> q & 1u);
      }
      const unsigned before =
          ((tag[0] & 1u) | (tag[1] & 1u) << 1 | (tag[2] & 1u) << 2 | (tag[3] & 1u) << 3) & lanes;
      for (unsigned changed = closed ^ before; changed != 0; changed &= changed - 1)
        close_or_open(view, work, i, entry[std::countr_zero(changed)]);
      if (batch.count >= kBatch) finish_batch(view, batch, overlap_ratio, work);
    }
    if (!sleepers) continue;
    for (Neighbour& entry : view.pairs.below(i)) {
      const int j = entry.sphere;
      if (!s.asleep[j]) continue;
      const double dx = place[j].x - place[i].x, dy = place[j].y - place[i].y, dz = place[j].z - place[i].z,
                   reach = place[j].w + place[i].w;
      const bool closed = dx * dx + dy * dy + dz * dz < reach * reach;
      if (closed != entry.touching()) close_or_open(view, work, i, entry);
      if (!closed) continue;
      batch.owner[batch.count] = j;
      batch.partner[batch.count] = i;
      batch.memory[batch.count++] = entry.memory();
      if (batch.count >= kBatch) finish_batch(view, batch, overlap_ratio, work);
    }
  }
  finish_batch(view, batch, overlap_ratio, work);
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
      ForceSum& sum = view.sum[entry.sphere];
      store(sum.force, load(sum.force) + entry.force);
      store(sum.torque, load(sum.torque) + entry.torque);
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
