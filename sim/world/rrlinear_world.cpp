#include "sim/world/rrlinear_world.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

namespace scree {
namespace {

constexpr int kStepsBetweenChecks = 20;  // of the stable step, of lost and runaway spheres
constexpr int kStepsBetweenSorts = 400;  // after which neighbours in space are neighbours in memory again
constexpr double kSkinHorizon = 20.0;    // steps that a sphere's skin should last
constexpr double kToolSkin =
    0.5;  // of the smallest radius: how far a tool moves before facets are listed anew
constexpr double kNearGap =
    0.05;  // of the smaller radius: gap below which a contact is expected (stable step)
constexpr double kMostTravel = 0.2;    // of the radius: most that a sphere may travel in one step
constexpr double kLargestStep = 0.05;  // s; for scenes with nothing stiff in them
constexpr int kRangeSize = 1024;       // spheres a task

}  // namespace

RrlinearWorld::RrlinearWorld(const WorldSettings& settings)
    : RockWorld(settings), law_(settings.material), sleep_(settings.sleep) {
  if (!several_threads()) return;
  arena_ = std::make_unique<tbb::task_arena>(settings_.threads);
  pairs_.use_threads([this](int count, const std::function<void(int, int)>& body) {
    arena_->execute([&] {
      tbb::parallel_for(tbb::blocked_range<int>(0, count),
                        [&](const tbb::blocked_range<int>& r) { body(r.begin(), r.end()); });
    });
  });
}

std::unique_ptr<RockWorld> make_rrlinear_world(const WorldSettings& settings) {
  return std::make_unique<RrlinearWorld>(settings);
}

// Runs body(first, last) over [0, count) and returns the largest value it gave.
template <class Body>
double RrlinearWorld::for_ranges(int count, Body&& body) {
  if (!arena_) return count > 0 ? body(0, count) : 0.0;
  std::atomic<double> largest{0.0};
  arena_->execute([&] {
    tbb::parallel_for(tbb::blocked_range<int>(0, count, kRangeSize), [&](const tbb::blocked_range<int>& r) {
      const double value = body(r.begin(), r.end());
      double seen = largest.load();
      while (value > seen && !largest.compare_exchange_weak(seen, value)) {
      }
    });
  });
  return largest.load();
}

double RrlinearWorld::horizon() const {
  return kSkinHorizon * dt_;
}

int RrlinearWorld::stepSimulation(btScalar span, int, btScalar) {
  const auto before = statistics_.steps;
  advance_to(time_ + span);
  update_bullet();
  return static_cast<int>(statistics_.steps - before);
}

void RrlinearWorld::sphere_lost(int index) {
  pairs_.drop(index);
  repair_due_ = true;
}

void RrlinearWorld::advance_to(double end) {
  if (changed_) prepare();
  while (time_ < end) {
    if (statistics_.steps >= next_sort_) prepare();
    if (steps_to_check_-- <= 0) {
      steps_to_check_ = kStepsBetweenChecks;
      check_spheres();
      if (repair_due_) repair();
      sleep_.look(spheres_, pairs_, watched_, law_, time_, settings_.gravity);
      dt_ = stable_step(false);
    }
    // The last step is cut to end on time; a remainder below a millionth of a step is rounding.
    const double left = end - time_;
    const bool last = left <= dt_ * (1 + 1e-6);
    step(last ? left : dt_);
    if (last) time_ = end;
  }
}

void RrlinearWorld::prepare() {
  changed_ = false;
  next_sort_ = statistics_.steps + kStepsBetweenSorts;
  const std::vector<int> order = sort_spheres(spheres_, fixed_);
  {
    std::vector<std::uint8_t> fixed(fixed_.size());
    for (std::size_t k = 0; k < order.size(); ++k) fixed[k] = fixed_[order[k]];
    fixed_.swap(fixed);
  }
  const int n = spheres_.size();
  double smallest = std::numeric_limits<double>::max();
  for (const Quad& p : spheres_.place) smallest = std::min(smallest, p.w);
  tool_skin_ = n > 0 ? kToolSkin * smallest : 0.0;
  incoming_force_.assign(n, {});
  incoming_torque_.assign(n, {});

  pairs_.rebuild(spheres_, order, horizon());

  // Memory of mesh contacts follows its sphere.
  std::vector<int> old_slot(n, -1);
  for (int k = 0; k < n; ++k)
    if (order[k] < static_cast<int>(slot_of_.size())) old_slot[k] = slot_of_[order[k]];
  slot_of_ = old_slot;
  facet_begin_.assign(spheres_.movable + 1, 0);
  facets_.clear();
  std::vector<int> all(spheres_.movable);
  std::iota(all.begin(), all.end(), 0);
  // A sphere that touched a mesh which was taken away has lost its hold.
  std::vector<std::uint8_t> bereft(n, 0);
  for (int i = 0; i < spheres_.movable; ++i)
    if (slot_of_[i] >= 0)
      for (int k = 0; k < kMeshContactSlots; ++k) {
        MeshContact& slot = slots_[slot_of_[i] + k];
        if (slot.body >= 0 && !meshes_[slot.body]) slot.body = -1, bereft[i] = 1;
      }
  list_facets(all, true);
  find_watched();
  for (int i = 0; i < n; ++i) bereft[i] |= watched_[i];
  sleep_.renumber(order, spheres_, pairs_, bereft, time_, settings_.gravity.norm());
  own_step2_.assign(spheres_.movable, 0.0);
  dt_ = stable_step(true);
  steps_to_check_ = 0;
}

void RrlinearWorld::find_watched() {
  watched_.assign(spheres_.size(), 0);
  if (!sleep_.on()) return;
  for (const int i : facet_rows_)
    for (int k = facet_begin_[i]; k < facet_begin_[i + 1]; ++k) {
      const Motion& motion = meshes_[facets_[k].body]->motion();
      if (motion.moves() && motion.last_time() >= time_) watched_[i] = 1;
    }
}

void RrlinearWorld::repair() {
  repair_due_ = false;
  ++statistics_.list_repairs;
  const std::vector<int>& listed = pairs_.repair(spheres_, horizon());
  bool tools_moved = false;
  for (const auto& mesh : meshes_)
    if (mesh && mesh->moved_since_mark() > tool_skin_) tools_moved = true;
  if (!listed.empty() || tools_moved) list_facets(listed, tools_moved);
  if (sleep_.on()) {
    find_watched();
    for (int i = 0; i < spheres_.movable; ++i)
      if (watched_[i] && spheres_.asleep[i]) sleep_.wake(i, spheres_, pairs_);
    sleep_.mark_rows(spheres_, pairs_);
  }
}

void RrlinearWorld::list_facets(const std::vector<int>& listed, bool tools_moved) {
  struct Box {
    int body;
    Vec3 low, high;
  };
  std::vector<Box> boxes;
  for (std::size_t b = 0; b < meshes_.size(); ++b) {
    if (!meshes_[b]) continue;
    if (tools_moved) meshes_[b]->mark();
    btVector3 low, high;
    meshes_[b]->body().getCollisionShape()->getAabb(to_bullet(meshes_[b]->state().pose), low, high);
    boxes.push_back({static_cast<int>(b), from_bullet(low), from_bullet(high)});
  }
  const int movable = spheres_.movable;
  std::vector<std::uint8_t> anew(movable, 0);
  for (const int i : listed) anew[i] = 1;

  std::vector<FacetRef> facets;
  std::vector<int> begin(movable + 1), found;
  std::vector<MeshContact> slots;
  facet_rows_.clear();
  for (int i = 0; i < movable; ++i) {
    begin[i] = static_cast<int>(facets.size());
    if (!spheres_.lost[i]) {
      const Vec3& x = pairs_.listed_at(i);
      // Two tool skins: this tool may be one away from its mark already and one to go.
      const double range = spheres_.place[i].w + pairs_.skin(i) + 2.0 * tool_skin_;
      const int old_first = facet_begin_[i], old_last = facet_begin_[i + 1];
      for (const Box& box : boxes) {
        if (!anew[i] && !(tools_moved && meshes_[box.body]->motion().moves())) {
          for (int k = old_first; k < old_last; ++k)
            if (facets_[k].body == box.body) facets.push_back(facets_[k]);
          continue;
        }
        if (((x - box.low).array() < -range).any() || ((x - box.high).array() > range).any()) continue;
        found.clear();
        meshes_[box.body]->facets_near(x, range, found);
        const Vec3 local = meshes_[box.body]->state().pose.to_local(x);
        for (const int f : found) {
          const Facet& facet = meshes_[box.body]->facets()[f];
          if (std::abs((local - facet.a).dot(facet.normal)) < range) facets.push_back({box.body, f});
        }
      }
    }
    int slot = -1;
    if (static_cast<int>(facets.size()) > begin[i]) {
      facet_rows_.push_back(i);
      slot = static_cast<int>(slots.size());
      if (slot_of_[i] >= 0)
        slots.insert(slots.end(), slots_.begin() + slot_of_[i],
                     slots_.begin() + slot_of_[i] + kMeshContactSlots);
      else
        slots.resize(slots.size() + kMeshContactSlots);
    }
    slot_of_[i] = slot;
  }
  begin[movable] = static_cast<int>(facets.size());
  facet_begin_.swap(begin);
  facets_.swap(facets);
  slots_.swap(slots);
}

template <bool kScatter>
double RrlinearWorld::pair_forces(int first, int last) {
  const Quad* place = spheres_.place.data();
  const Quad* velocity = spheres_.velocity.data();
  const Quad* spin = spheres_.spin.data();
  const std::uint8_t* asleep = spheres_.asleep.data();
  double overlap_ratio = 0;
  for (int i = first; i < last; ++i) {
    if (!sleep_.row_active(i)) continue;
    const bool owner_sleeps = asleep[i] != 0;
    const Quad pi = place[i];
    const Vec3 vi = velocity[i].vec(), wi = spin[i].vec();
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    double contacts = 0;
    for (int p = pairs_.begin(i); p < pairs_.end(i); ++p) {
      const int j = pairs_.partner(p);
      // Fixed balls count as asleep beside a sleeper: nothing between them changes.
      const bool partner_sleeps = asleep[j] != 0;
      if (owner_sleeps && (partner_sleeps || j >= spheres_.movable)) continue;
      const Quad pj = place[j];
      const double dx = pj.x - pi.x, dy = pj.y - pi.y, dz = pj.z - pi.z, reach = pi.w + pj.w;
      const double d2 = dx * dx + dy * dy + dz * dz;
      if (d2 >= reach * reach) {
        if (pairs_.touching[p]) {
          pairs_.touching[p] = 0;
          pairs_.history[p] = {};
        }
        if (owner_sleeps != partner_sleeps) sleep_.feel(pairs_, p, owner_sleeps ? i : j, Vec3::Zero());
        continue;
      }
      pairs_.touching[p] = 1;
      const double d = std::sqrt(d2);
      const double per_d = 1.0 / d;
      const Vec3 n = d > 0 ? Vec3(dx * per_d, dy * per_d, dz * per_d) : Vec3(0, 0, 1);
      const double overlap = reach - d;
      // The contact point halves the overlap. It may lie beyond the centre of a small sphere pressed into a block: the arms
      // always add up to the distance, so angular momentum is kept.
      const double arm1 = pi.w - 0.5 * overlap, arm2 = pj.w - 0.5 * overlap;
      const Vec3 vj = velocity[j].vec(), wj = spin[j].vec();
      const double m1 = velocity[i].w, m2 = velocity[j].w;
      ContactMotion motion;
      motion.normal = n;
      motion.overlap = overlap;
      motion.velocity = vj - vi - (arm1 * wi + arm2 * wj).cross(n);
      motion.spin = wj - wi;
      motion.twist = 0.5 * (wi + wj).dot(n);
      motion.reduced_mass = j < spheres_.movable ? m1 * m2 / (m1 + m2) : m1;
      motion.dt = last_dt_;
      const ContactForce f = contact_step(law_, ball_ball(law_, pi.w, pj.w), motion, pairs_.history[p]);
      if (owner_sleeps != partner_sleeps) sleep_.feel(pairs_, p, owner_sleeps ? i : j, f.force);
      const Vec3 lever = n.cross(f.force);
      force += f.force;
      torque += arm1 * lever + f.rolling;
      contacts += 1;
      const Vec3 torque2 = arm2 * lever - f.rolling;
      if constexpr (kScatter) {
        Quad& fj = incoming_force_[j];
        fj.x -= f.force.x(), fj.y -= f.force.y(), fj.z -= f.force.z(), fj.w += 1;
        incoming_torque_[j].add(torque2);
      } else {
        pair_force_[p] = {{f.force.x(), f.force.y(), f.force.z()}, {torque2.x(), torque2.y(), torque2.z()}};
      }
      overlap_ratio = std::max(overlap_ratio, overlap / std::min(pi.w, pj.w));
    }
    spheres_.force[i] = {force.x(), force.y(), force.z(), contacts};
    spheres_.torque[i] = {torque.x(), torque.y(), torque.z(), 0};
  }
  return overlap_ratio;
}

// Sums over the contacts in which a sphere is partner, by rising owner: the order in which one thread
// scatters them.
void RrlinearWorld::gather(int first, int last) {
  for (int j = first; j < last; ++j) {
    if (spheres_.asleep[j]) continue;
    Quad force, torque;
    for (int k = pairs_.incoming_begin[j]; k < pairs_.incoming_begin[j + 1]; ++k) {
      const int p = pairs_.incoming_pair[k];
      if (!pairs_.touching[p]) continue;
      const PairForce& f = pair_force_[p];
      force.x -= f.force[0], force.y -= f.force[1], force.z -= f.force[2], force.w += 1;
      torque.x += f.torque[0], torque.y += f.torque[1], torque.z += f.torque[2];
    }
    incoming_force_[j] = force;
    incoming_torque_[j] = torque;
  }
}

double RrlinearWorld::mesh_forces(int first, int last) {
  double overlap_ratio = 0;
  ContactLaw law = law_;
  for (int row = first; row < last; ++row) {
    const int i = facet_rows_[row];
    if (spheres_.asleep[i]) continue;
    const Quad place = spheres_.place[i];
    const std::span<MeshContact> slots(slots_.data() + slot_of_[i], kMeshContactSlots);
    const std::span<const FacetRef> facets(facets_.data() + facet_begin_[i],
                                           static_cast<std::size_t>(facet_begin_[i + 1] - facet_begin_[i]));
    const MeshContactChanges changes = update_mesh_contacts(meshes_, facets, place.vec(), place.w, slots);
    if (changes.born_inside > 0)
      __atomic_fetch_add(&statistics_.squeezed_into_walls, changes.born_inside, __ATOMIC_RELAXED);
    if (changes.without_slot > 0)
      __atomic_fetch_add(&statistics_.crowded_contacts, changes.without_slot, __ATOMIC_RELAXED);
    const Vec3 v = spheres_.velocity[i].vec(), w = spheres_.spin[i].vec();
    for (MeshContact& c : slots) {
      if (c.body < 0) continue;
      const MeshBody& body = *meshes_[c.body];
      law.mu = body.surface().mu;
      law.mu_r = body.surface().mu_r;
      const double arm = std::max(place.w - 0.5 * c.overlap, 0.1 * place.w);
      const Vec3 normal = -c.normal;  // from the sphere to the surface
      const Vec3 point = place.vec() + arm * normal;
      ContactMotion motion;
      motion.normal = normal;
      motion.overlap = c.overlap;
      motion.velocity = body.state().velocity_at(point) - v - arm * w.cross(normal);
      motion.spin = body.state().spin - w;
      motion.twist = 0.5 * (w + body.state().spin).dot(normal);
      motion.reduced_mass = spheres_.velocity[i].w;
      motion.dt = last_dt_;
      const ContactForce f = contact_step(law, ball_facet(law, place.w), motion, c.history);
      spheres_.force[i].add(f.force);
      spheres_.force[i].w += 1;
      spheres_.torque[i].add(arm * normal.cross(f.force) + f.rolling);
      overlap_ratio = std::max(overlap_ratio, c.overlap / place.w);
    }
  }
  return overlap_ratio;
}

void RrlinearWorld::forces() {
  const int movable = spheres_.movable;
  double overlap = 0;
  if (several_threads()) {
    pair_force_.resize(pairs_.size());
    overlap = for_ranges(movable, [&](int a, int b) { return pair_forces<false>(a, b); });
    for_ranges(movable, [&](int a, int b) { return gather(a, b), 0.0; });
  } else {
    overlap = pair_forces<true>(0, movable);
  }
  const int rows = static_cast<int>(facet_rows_.size());
  overlap = std::max(overlap, for_ranges(rows, [&](int a, int b) { return mesh_forces(a, b); }));
  statistics_.largest_overlap_ratio = std::max(statistics_.largest_overlap_ratio, overlap);
}

// Returns true if a sphere may have left its skin.
bool RrlinearWorld::integrate(int first, int last, double dt) {
  const double alpha = settings_.material.local_damping;
  const bool always = settings_.material.damping_reach == DampingReach::always;
  const Vec3 g = settings_.gravity;
  bool left = false;
  for (int i = first; i < last; ++i) {
    if (spheres_.lost[i]) continue;
    if (spheres_.asleep[i]) {
      incoming_force_[i] = incoming_torque_[i] = {};
      continue;
    }
    Quad& x = spheres_.place[i];
    Quad& v = spheres_.velocity[i];
    Quad& w = spheres_.spin[i];
    Quad& f = spheres_.force[i];
    const Quad& t = spheres_.torque[i];
    Quad& fi = incoming_force_[i];
    Quad& ti = incoming_torque_[i];
    f = {fi.x + f.x, fi.y + f.y, fi.z + f.z, fi.w + f.w};
    const double a = always || f.w > 0 ? alpha : 0.0;
    const double per_mass = dt / v.w, per_inertia = dt / w.w;
    v.x += per_mass * locally_damped(f.x + v.w * g.x(), v.x, a);
    v.y += per_mass * locally_damped(f.y + v.w * g.y(), v.y, a);
    v.z += per_mass * locally_damped(f.z + v.w * g.z(), v.z, a);
    w.x += per_inertia * locally_damped(ti.x + t.x, w.x, a);
    w.y += per_inertia * locally_damped(ti.y + t.y, w.y, a);
    w.z += per_inertia * locally_damped(ti.z + t.z, w.z, a);
    x.x += dt * v.x;
    x.y += dt * v.y;
    x.z += dt * v.z;
    fi = ti = {};  // summed anew in the next step
    if (pairs_.left_skin(i, x)) left = true;
  }
  return left;
}

void RrlinearWorld::move_tools() {
  for (const auto& mesh : meshes_) {
    if (!mesh || !mesh->motion().moves()) continue;
    mesh->move_to(time_);
    if (mesh->moved_since_mark() > tool_skin_) repair_due_ = true;
  }
}

void RrlinearWorld::step(double dt) {
  forces();
  if (for_ranges(spheres_.movable, [&](int a, int b) { return integrate(a, b, dt) ? 1.0 : 0.0; }) > 0)
    repair_due_ = true;
  statistics_.particle_steps +=
      static_cast<double>(spheres_.movable - statistics_.lost_particles - sleep_.asleep());
  sleep_.wake_disturbed(spheres_, pairs_);
  statistics_.asleep = sleep_.asleep();
  time_ += dt;
  last_dt_ = dt;
  move_tools();
  if (repair_due_) repair();
  ++statistics_.steps;
  statistics_.time_step_max = std::max(statistics_.time_step_max, dt);
  if (statistics_.time_step_min == 0 || dt_ < statistics_.time_step_min) statistics_.time_step_min = dt_;
}

double RrlinearWorld::stable_step(bool sleepers_too) {
  if (settings_.fixed_time_step > 0) return settings_.fixed_time_step;
  const int n = spheres_.movable;
  struct Stiffness {
    Vec3 shift = Vec3::Zero(), turn = Vec3::Zero();
  };
  std::vector<Stiffness> sum(n);
  const auto add = [&](int i, const ContactStiffness& k, const Vec3& normal, double arm) {
    if (i >= n) return;
    const Vec3 along = normal.cwiseAbs2(), across = Vec3::Ones() - along;
    sum[i].shift += k.kn * along + k.ks * across;
    sum[i].turn += (k.ks * arm * arm + k.kr) * across;
  };
  for (int i = 0; i < n; ++i) {
    if (!sleepers_too && !sleep_.row_active(i)) continue;
    for (int p = pairs_.begin(i); p < pairs_.end(i); ++p) {
      const int j = pairs_.partner(p);
      const Quad &a = spheres_.place[i], &b = spheres_.place[j];
      const Vec3 d = b.vec() - a.vec();
      const double reach = a.w + b.w + kNearGap * std::min(a.w, b.w);
      const double d2 = d.squaredNorm();
      if (d2 >= reach * reach || d2 == 0) continue;
      const ContactStiffness k = ball_ball(law_, a.w, b.w);
      const Vec3 normal = d / std::sqrt(d2);
      add(i, k, normal, a.w);
      add(j, k, normal, b.w);
    }
  }
  double smallest = kLargestStep * kLargestStep;  // squared
  double travel = kLargestStep;
  for (int i = 0; i < n; ++i) {
    if (spheres_.lost[i]) continue;
    if (spheres_.asleep[i] && !sleepers_too) {
      // A sleeper may wake before the next look: its own step, known from when it fell asleep, still counts.
      smallest = std::min(smallest, own_step2_[i]);
      continue;
    }
    const double radius = spheres_.place[i].w;
    const ContactStiffness wall = ball_facet(law_, radius);
    if (slot_of_[i] >= 0) {
      int touching = 0;
      for (int k = 0; k < kMeshContactSlots; ++k) {
        const MeshContact& c = slots_[slot_of_[i] + k];
        if (c.body < 0) continue;
        add(i, wall, c.normal, radius);
        ++touching;
      }
      if (touching == 0) add(i, wall, Vec3(0, 0, 1), radius);
    }
    // A sphere in free flight may meet one other at least: as stiff as a partner of any size can be.
    const ContactStiffness any = ball_ball(law_, radius, radius);
    const double shift = std::max(sum[i].shift.maxCoeff(), any.kn);
    const double turn = std::max(sum[i].turn.maxCoeff(), any.ks * radius * radius + any.kr);
    own_step2_[i] = std::min(spheres_.velocity[i].w / shift, spheres_.spin[i].w / turn);
    smallest = std::min(smallest, own_step2_[i]);
    const double speed = spheres_.velocity[i].vec().norm();
    if (speed * travel > kMostTravel * radius) travel = kMostTravel * radius / speed;
  }
  return std::min(settings_.time_step_safety * std::sqrt(smallest), travel);
}

Energy RrlinearWorld::energy() const {
  Energy e = RockWorld::energy();
  for (int i = 0; i < std::min(spheres_.movable, pairs_.rows()); ++i)  // no rows before the first step
    for (int p = pairs_.begin(i); p < pairs_.end(i); ++p) {
      if (!pairs_.touching[p]) continue;
      const Quad &a = spheres_.place[i], &b = spheres_.place[pairs_.partner(p)];
      const double overlap = a.w + b.w - (b.vec() - a.vec()).norm();
      if (overlap > 0) e.elastic += elastic_energy(ball_ball(law_, a.w, b.w), overlap, pairs_.history[p]);
    }
  for (const int i : facet_rows_)
    for (int k = 0; k < kMeshContactSlots; ++k) {
      const MeshContact& c = slots_[slot_of_[i] + k];
      if (c.body >= 0)
        e.elastic += elastic_energy(ball_facet(law_, spheres_.place[i].w), c.overlap, c.history);
    }
  return e;
}

std::vector<MeshContact> RrlinearWorld::mesh_contacts(int index) const {
  std::vector<MeshContact> contacts;
  if (index < static_cast<int>(slot_of_.size()) && slot_of_[index] >= 0)
    for (int k = 0; k < kMeshContactSlots; ++k)
      if (slots_[slot_of_[index] + k].body >= 0) contacts.push_back(slots_[slot_of_[index] + k]);
  return contacts;
}

void RrlinearWorld::update_bullet() {
  for (const auto& mesh : meshes_)
    if (mesh && mesh->motion().moves()) {
      mesh->write_back();
      updateSingleAabb(&mesh->body());
    }
  for (int i = 0; i < spheres_.movable; ++i) {
    if (spheres_.lost[i]) continue;
    btRigidBody& body = *bodies_[static_cast<std::size_t>(spheres_.id[i])];
    const btVector3 origin = to_bullet(spheres_.place[i].vec());
    if (origin == body.getWorldTransform().getOrigin()) continue;
    body.getWorldTransform().setOrigin(origin);
    body.setLinearVelocity(to_bullet(spheres_.velocity[i].vec()));
    body.setAngularVelocity(to_bullet(spheres_.spin[i].vec()));
    updateSingleAabb(&body);
  }
}

}  // namespace scree
