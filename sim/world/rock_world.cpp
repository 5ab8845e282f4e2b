#include "sim/world/rock_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <new>
#include <stdexcept>

namespace scree {
namespace {

constexpr double kTooFast = 500.0;  // m/s; no fall of this field is a tenth of it

// Collision groups. Where Bullet moves the rock it meets fixed balls and tools, which do not meet each other.
// In the explicit engine spheres meet nothing of Bullet's but queries and bodies that others add.
constexpr int kRockGroup = 1 << 10, kFixedGroup = 1 << 11, kToolGroup = 1 << 12;

int mask_of(int group, bool bullet_moves_spheres) {
  if (!bullet_moves_spheres) return btBroadphaseProxy::DefaultFilter;
  return group == kRockGroup ? btBroadphaseProxy::AllFilter : btBroadphaseProxy::DefaultFilter | kRockGroup;
}

void* allocate(std::size_t size) {
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

BulletParts::Memory::Memory() {
  static const bool set = [] {
    btAlignedAllocSetCustom(allocate, std::free);
    return true;
  }();
  static_cast<void>(set);
}

RockWorld::RockWorld(const WorldSettings& settings)
    : btDiscreteDynamicsWorld(&dispatcher, &broadphase, &solver, &configuration), settings_(settings) {
  setGravity(to_bullet(settings_.gravity));
}

RockWorld::~RockWorld() {
  for (const auto& body : bodies_)
    if (body && body->isInWorld()) removeRigidBody(body.get());
  for (const auto& mesh : meshes_)
    if (mesh) removeRigidBody(&mesh->body());
}

void RockWorld::add_sphere(const NewSphere& s, double mass, std::int64_t id) {
  const double radius = 0.5 * s.diameter;
  spheres_.place.push_back({s.position.x(), s.position.y(), s.position.z(), radius});
  spheres_.velocity.push_back({s.velocity.x(), s.velocity.y(), s.velocity.z(), mass});
  spheres_.spin.push_back({s.spin.x(), s.spin.y(), s.spin.z(), 0.4 * mass * radius * radius});
  spheres_.id.push_back(id);
  spheres_.dump.push_back(s.dump);
  spheres_.lost.push_back(0);
  spheres_.asleep.push_back(0);
  fixed_.push_back(s.fixed ? 1 : 0);
  if (!settings_.clumps.on()) return;
  spheres_.partner.push_back(-1);
  spheres_.angular.push_back({0, 0, 0, 0});
}

void RockWorld::add_clump(const NewSphere& grain, double mass, std::int64_t id) {
  const ClumpSpheres two = spheres_of_clump(settings_.clumps, grain, mass);
  const int first = spheres_.size();
  for (int k = 0; k < 2; ++k) {
    NewSphere one = grain;
    one.position = two.place[k];
    one.velocity = two.velocity[k];
    one.diameter = two.diameter;
    if (k > 0) {
      next_fragment_ = std::max({next_fragment_, next_, reserved_});
      id = next_fragment_++;
    }
    add_sphere(one, 0.5 * mass, id);
    spheres_.partner.back() = k == 0 ? first + 1 : first;
    spheres_.angular.back().set(two.angular_momentum);
  }
}

void RockWorld::add_spheres(const std::vector<NewSphere>& spheres) {
  if (next_ >= reserved_) next_ = std::max(next_, next_fragment_);
  if (settings_.clumps.on())  // grains are numbered in order, their second spheres after them
    reserved_ = std::max(reserved_, next_ + static_cast<std::int64_t>(spheres.size()));
  for (const NewSphere& s : spheres) {
    if (next_ >= reserved_) next_ = std::max(next_, next_fragment_);
    const double mass = sphere_mass(settings_.material, s.diameter);
    const int known = spheres_.size();
    const std::int64_t id = next_++;
    if (settings_.clumps.on() && !s.fixed)
      add_clump(s, mass, id);
    else
      add_sphere(s, mass, id);
    if (s.fixed) continue;
    for (int i = known; i < spheres_.size(); ++i) {
      account_.came_moving += spheres_.kinetic_energy(i);
      account_.came_potential += gravity_energy(i);
      account_.weight_times_radius += spheres_.velocity[i].w * settings_.gravity.norm() * spheres_.place[i].w;
    }
  }
  spheres_.movable = static_cast<int>(std::count(fixed_.begin(), fixed_.end(), 0));
  if (bullet_moves_spheres()) make_bodies();
  scene_changed();
}

std::array<int, Breakage::kFragments> RockWorld::replace_by_fragments(int i) {
  const Vec3 middle = spheres_.place[i].vec(), velocity = spheres_.velocity[i].vec(),
             spin = Breakage::spin_at_first() * spheres_.spin[i].vec();
  const double radius = spheres_.place[i].w, mass = spheres_.velocity[i].w / Breakage::kFragments;
  const auto places = fragment_places(static_cast<std::uint64_t>(spheres_.id[i]));
  std::array<int, Breakage::kFragments> fragments{};
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Vec3 arm = radius * places[k];
    NewSphere fragment;
    fragment.position = middle + arm;
    fragment.diameter = 2 * Breakage::kSizeAtFirst * radius;
    fragment.dump = spheres_.dump[i];
    fragment.velocity = velocity + spin.cross(arm);
    fragment.spin = spin;
    if (k > 0) {
      fragments[k] = spheres_.size();
      next_fragment_ = std::max({next_fragment_, next_, reserved_});
      add_sphere(fragment, mass, next_fragment_++);
      continue;
    }
    fragments[0] = i;
    const double r = 0.5 * fragment.diameter;
    spheres_.place[i] = {fragment.position.x(), fragment.position.y(), fragment.position.z(), r};
    spheres_.velocity[i] = {fragment.velocity.x(), fragment.velocity.y(), fragment.velocity.z(), mass};
    spheres_.spin[i] = {spin.x(), spin.y(), spin.z(), 0.4 * mass * r * r};
    drop_body(spheres_.id[i]);
  }
  spheres_.movable += Breakage::kFragments - 1;
  ++statistics_.broken_spheres;
  return fragments;
}

void RockWorld::set_radius(int i, double radius) {
  Quad& spin = spheres_.spin[i];
  const double before = spin.w;
  spheres_.place[i].w = radius;
  spin.w = 0.4 * spheres_.velocity[i].w * radius * radius;
  spin.set(before / spin.w * spin.vec());
  drop_body(spheres_.id[i]);
}

void RockWorld::drop_body(std::int64_t number) {
  const auto id = static_cast<std::size_t>(number);
  if (id >= bodies_.size() || !bodies_[id]) return;
  removeRigidBody(bodies_[id].get());
  bodies_[id].reset();
}

void RockWorld::make_bodies() {
  std::int64_t count = 0;
  for (const std::int64_t id : spheres_.id) count = std::max(count, id + 1);
  bodies_.resize(static_cast<std::size_t>(count));
  shapes_.resize(static_cast<std::size_t>(count));
  std::vector<int> by_id(static_cast<std::size_t>(count), -1);  // Bullet's order does not depend on ours
  for (int i = 0; i < spheres_.size(); ++i)
    if (!spheres_.lost[i]) by_id[static_cast<std::size_t>(spheres_.id[i])] = i;
  for (std::size_t id = 0; id < by_id.size(); ++id) {
    const int i = by_id[id];
    if (i < 0 || bodies_[id]) continue;
    const double mass = spheres_.velocity[i].w;
    shapes_[id] = std::make_unique<btSphereShape>(spheres_.place[i].w);
    const bool dynamic = bullet_moves_spheres() && !fixed_[i];
    btVector3 inertia(0, 0, 0);
    if (dynamic) shapes_[id]->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(dynamic ? mass : 0.0, nullptr, shapes_[id].get(), inertia);
    info.m_startWorldTransform.setIdentity();
    info.m_startWorldTransform.setOrigin(to_bullet(spheres_.place[i].vec()));
    bodies_[id] = std::make_unique<btRigidBody>(info);
    btRigidBody& body = *bodies_[id];
    body.setUserIndex(static_cast<int>(id));
    if (dynamic) {
      body.setLinearVelocity(to_bullet(spheres_.velocity[i].vec()));
      body.setAngularVelocity(to_bullet(spheres_.spin[i].vec()));
    } else if (!fixed_[i]) {
      body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    }
    const int group = fixed_[i] ? kFixedGroup : kRockGroup;
    addRigidBody(&body, group, mask_of(group, bullet_moves_spheres()));
  }
}

int RockWorld::add_mesh(TriangleMesh mesh, const Surface& surface, Motion motion) {
  meshes_.push_back(std::make_unique<MeshBody>(std::move(mesh), surface, std::move(motion)));
  meshes_.back()->move_to(time_);
  meshes_.back()->mark();
  meshes_.back()->write_back();
  addRigidBody(&meshes_.back()->body(), kToolGroup, mask_of(kToolGroup, bullet_moves_spheres()));
  scene_changed();
  return static_cast<int>(meshes_.size()) - 1;
}

void RockWorld::set_velocity(std::int64_t id, const Vec3& velocity, const Vec3& spin) {
  const auto at = std::find(spheres_.id.begin(), spheres_.id.end(), id);
  if (at == spheres_.id.end()) throw std::out_of_range(fmt::format("no sphere has the number {}", id));
  const auto i = static_cast<int>(at - spheres_.id.begin());
  if (spheres_.lost[i]) return;
  const int other = spheres_.partner.empty() ? -1 : spheres_.partner[i];
  if (other >= 0) {
    const Vec3 arm = 0.5 * (spheres_.place[i].vec() - spheres_.place[other].vec());
    const Vec3 angular = clump_angular_momentum(settings_.clumps, spin, arm.normalized(),
                                                spheres_.grain_mass(i), spheres_.place[i].w);
    for (const int k : {i, other}) {
      account_.set_moving -= spheres_.kinetic_energy(k);
      spheres_.velocity[k].set(velocity + spin.cross(k == i ? arm : Vec3(-arm)));
      spheres_.spin[k].set(spin);
      spheres_.angular[k].set(angular);
      account_.set_moving += spheres_.kinetic_energy(k);
    }
    return sphere_pushed(i);
  }
  account_.set_moving -= spheres_.kinetic_energy(i);
  spheres_.velocity[i].set(velocity);
  spheres_.spin[i].set(spin);
  account_.set_moving += spheres_.kinetic_energy(i);
  if (bullet_moves_spheres()) {
    bodies_[static_cast<std::size_t>(id)]->setLinearVelocity(to_bullet(velocity));
    bodies_[static_cast<std::size_t>(id)]->setAngularVelocity(to_bullet(spin));
  }
  sphere_pushed(i);
}

void RockWorld::set_mesh_motion(int index, Motion motion) {
  meshes_[index]->set_motion(std::move(motion));
  scene_changed();
}

void RockWorld::remove_mesh(int index) {
  if (!meshes_[index]) return;
  mesh_leaves(index);
  removeRigidBody(&meshes_[index]->body());
  meshes_[index].reset();
  scene_changed();
}

Snapshot RockWorld::snapshot() const {
  Snapshot shot;
  shot.time = time_;
  for (int i = 0; i < spheres_.size(); ++i) {
    if (!is_rock(i) || !spheres_.leads(i)) continue;
    const int other = spheres_.partner.empty() ? -1 : spheres_.partner[i];
    if (other < 0)
      shot.grains.push_back({spheres_.id[i], spheres_.place[i].vec(), spheres_.velocity[i].vec(),
                             2.0 * spheres_.place[i].w, spheres_.velocity[i].w, spheres_.dump[i]});
    else
      shot.grains.push_back({spheres_.id[i], 0.5 * (spheres_.place[i].vec() + spheres_.place[other].vec()),
                             0.5 * (spheres_.velocity[i].vec() + spheres_.velocity[other].vec()),
                             2.0 * spheres_.place[i].w / settings_.clumps.size(),
                             spheres_.velocity[i].w + spheres_.velocity[other].w, spheres_.dump[i]});
  }
  std::sort(shot.grains.begin(), shot.grains.end(),
            [](const Grain& a, const Grain& b) { return a.id < b.id; });
  return shot;
}

std::vector<Grain> RockWorld::fixed_balls() const {
  std::vector<Grain> balls;
  for (int i = 0; i < spheres_.size(); ++i)
    if (fixed_[i])
      balls.push_back({spheres_.id[i], spheres_.place[i].vec(), Vec3::Zero(), 2.0 * spheres_.place[i].w,
                       spheres_.velocity[i].w, 0});
  std::sort(balls.begin(), balls.end(), [](const Grain& a, const Grain& b) { return a.id < b.id; });
  return balls;
}

double RockWorld::mass() const {
  double mass = 0;
  for (int i = 0; i < spheres_.size(); ++i)
    if (is_rock(i)) mass += spheres_.velocity[i].w;
  return mass;
}

double RockWorld::moving_mass_share(double speed) const {
  double moving = 0;
  for (int i = 0; i < spheres_.size(); ++i)
    if (is_rock(i) && speed_of(i) > speed) moving += spheres_.velocity[i].w;
  const double all = mass();
  return all > 0 ? moving / all : 0.0;
}

Energy RockWorld::energy() const {
  Energy e;
  for (int i = 0; i < spheres_.size(); ++i) {
    if (!is_rock(i)) continue;
    e.kinetic += spheres_.kinetic_energy(i);
    e.potential += gravity_energy(i);
  }
  return e;
}

double RockWorld::gravity_energy(int i) const {
  return -spheres_.velocity[i].w * settings_.gravity.dot(spheres_.place[i].vec());
}

btRigidBody* RockWorld::sphere_body(std::int64_t id) {
  update_bullet();
  return bodies_[static_cast<std::size_t>(id)].get();
}

void RockWorld::check_spheres(std::span<const int> spheres) {
  std::vector<int> lost;
  for (const int i : spheres) {
    const Vec3 x = spheres_.place[i].vec(), v = spheres_.velocity[i].vec();
    const bool finite = x.allFinite() && v.allFinite() && spheres_.spin[i].vec().allFinite();
    if (!finite || v.squaredNorm() > kTooFast * kTooFast)
      throw BlowUp(fmt::format(
          "the run blew up at t = {:.4f} s (a sphere of {:.3f} m {}): lower numerics.time_step_safety", time_,
          2.0 * spheres_.place[i].w,
          finite ? fmt::format("moves at {:.0f} m/s", v.norm()) : "has no finite position"));
    if ((x.array() < settings_.domain_low.array()).any() || (x.array() > settings_.domain_high.array()).any())
      lost.push_back(i);
  }
  if (!spheres_.partner.empty()) {  // a clump leaves as one
    for (std::size_t k = 0, count = lost.size(); k < count; ++k)
      if (const int other = spheres_.partner[lost[k]]; other >= 0) lost.push_back(other);
    std::sort(lost.begin(), lost.end());
    lost.erase(std::unique(lost.begin(), lost.end()), lost.end());
  }
  for (const int i : lost) {
    if (spheres_.leads(i)) ++statistics_.lost_particles;
    statistics_.lost_mass += spheres_.velocity[i].w;
    leave(i);
  }
}

// Takes no part any more.
void RockWorld::leave(int index) {
  spheres_.lost[index] = 1;
  drop_body(spheres_.id[index]);
  account_.lost_potential += gravity_energy(index);
  account_.lost_other += spheres_.kinetic_energy(index);
  spheres_.velocity[index].set(Vec3::Zero());
  spheres_.spin[index].set(Vec3::Zero());
  sphere_lost(index);
}

std::vector<int> RockWorld::leaders(const std::function<bool(const Vec3& place)>& inside) const {
  std::vector<int> found;
  for (int i = 0; i < spheres_.size(); ++i) {
    if (!is_rock(i) || !spheres_.leads(i)) continue;
    const int other = spheres_.partner.empty() ? -1 : spheres_.partner[i];
    const Vec3 place = spheres_.place[i].vec();
    if (inside(other < 0 ? place : Vec3(0.5 * (place + spheres_.place[other].vec())))) found.push_back(i);
  }
  return found;
}

double RockWorld::mass_of(const std::function<bool(const Vec3& place)>& inside) const {
  double mass = 0;
  for (const int i : leaders(inside)) mass += spheres_.grain_mass(i);
  return mass;
}

double RockWorld::take_out(const std::function<bool(const Vec3& place)>& inside) {
  double mass = 0;
  for (const int i : leaders(inside)) {
    const int other = spheres_.partner.empty() ? -1 : spheres_.partner[i];
    mass += spheres_.grain_mass(i);
    leave(i);
    if (other >= 0) leave(other);
  }
  return mass;
}

}  // namespace scree
