#include "sim/world/impulse_world.h"

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {
namespace {

// kg in one unit of mass of Bullet: the impulse of 27 t at 15 m/s is then 0.04.
constexpr double kMassUnit = 1e7;

// How far apart contact points may be, and by how much boxes are fattened, over the smallest radius. Bullet's
// own margin of 0.05 m is several diameters of the laboratory's smallest spheres: each would be paired with
// hundreds.
constexpr double kReach = 0.1;

constexpr double kWindow = 0.1;  // s

const btSphereShape* sphere_of(const btCollisionObject* object) {
  const btCollisionShape* shape = object->getCollisionShape();
  return shape->getShapeType() == SPHERE_SHAPE_PROXYTYPE ? static_cast<const btSphereShape*>(shape) : nullptr;
}

// A surface's friction replaces the rock's; between two rocks both are the same.
template <class Get>
btScalar surface_value(const btCollisionObject* a, const btCollisionObject* b, Get get) {
  return sphere_of(a) ? get(b) : get(a);
}

btScalar combined_friction(const btCollisionObject* a, const btCollisionObject* b) {
  return surface_value(a, b, [](const btCollisionObject* o) { return o->getFriction(); });
}

btScalar combined_rolling(const btCollisionObject* a, const btCollisionObject* b) {
  const btScalar mu_r =
      surface_value(a, b, [](const btCollisionObject* o) { return o->getRollingFriction(); });
  const btSphereShape *sa = sphere_of(a), *sb = sphere_of(b);
  btScalar curvature = 0;
  if (sa) curvature += 1 / sa->getRadius();
  if (sb) curvature += 1 / sb->getRadius();
  return curvature > 0 ? mu_r / curvature : btScalar(0);
}

btScalar zero(const btCollisionObject*, const btCollisionObject*) {
  return 0;
}

}  // namespace

ImpulseWorld::ImpulseWorld(const WorldSettings& settings) : RockWorld(settings) {
  // Bullet keeps these as globals; every ImpulseWorld wants the same.
  gCalculateCombinedFrictionCallback = combined_friction;
  gCalculateCombinedRollingFrictionCallback = combined_rolling;
  gCalculateCombinedSpinningFrictionCallback = zero;
  gCalculateCombinedRestitutionCallback = zero;
  // Lengths in metres, not shares of each shape's size.
  auto& pairs = static_cast<btCollisionDispatcher&>(*getDispatcher());
  pairs.setDispatcherFlags(pairs.getDispatcherFlags() &
                           ~btCollisionDispatcher::CD_USE_RELATIVE_CONTACT_BREAKING_THRESHOLD);
  getSolverInfo().m_numIterations = settings_.impulse_iterations;
  getSolverInfo().m_restitutionVelocityThreshold = 0;
  setForceUpdateAllAabbs(false);  // what stands still keeps its box
}

std::unique_ptr<RockWorld> make_impulse_world(const WorldSettings& settings) {
  return std::make_unique<ImpulseWorld>(settings);
}

void ImpulseWorld::prepare() {
  changed_ = false;
  movable_.clear();
  for (int i = 0; i < spheres_.size(); ++i) {
    if (spheres_.lost[i]) continue;
    btRigidBody& body = *bodies_[static_cast<std::size_t>(spheres_.id[i])];
    body.setFriction(settings_.material.mu);
    body.setRollingFriction(settings_.material.mu_r);
    if (fixed_[i]) continue;
    body.setActivationState(DISABLE_DEACTIVATION);
    const double mass = spheres_.velocity[i].w / kMassUnit;
    body.setMassProps(mass, btVector3(1, 1, 1) * (spheres_.spin[i].w / kMassUnit));
    body.setGravity(to_bullet(settings_.gravity));
    body.updateInertiaTensor();
    movable_.push_back(i);
  }
  for (const auto& mesh : meshes_)
    if (mesh) mesh->body().setRollingFriction(mesh->surface().mu_r);
}

void ImpulseWorld::advance_to(double end) {
  if (changed_) prepare();
  // Globals of Bullet; a world of other rock may have set them. Worlds of the same rock want the same.
  const double reach = kReach * 0.5 * settings_.smallest_diameter;
  if (gContactBreakingThreshold != reach) gContactBreakingThreshold = reach;
  if (gDbvtMargin != reach) gDbvtMargin = reach;
  while (time_ < end) {
    const double left = end - time_;
    const bool last = left <= settings_.impulse_time_step * (1 + 1e-6);
    const double dt = last ? left : settings_.impulse_time_step;
    clearForces();
    applyGravity();
    internalSingleStepSimulation(dt);
    time_ = last ? end : time_ + dt;
    read_back();
    for (const auto& mesh : meshes_)
      if (mesh && mesh->motion().moves()) {
        mesh->move_to(time_);
        mesh->write_back();
      }
    ++statistics_.steps;
    statistics_.particle_steps += static_cast<double>(movable_.size());
    statistics_.time_step_min = statistics_.time_step_min > 0 ? std::min(statistics_.time_step_min, dt) : dt;
    statistics_.time_step_max = std::max(statistics_.time_step_max, dt);
    check_spheres(movable_);
    if (time_ >= looked_ + kWindow) look_how_far();
    if (changed_) prepare();
  }
}

void ImpulseWorld::look_how_far() {
  places_.resize(bodies_.size(), Vec3::Constant(std::numeric_limits<double>::infinity()));
  travelled_speed_.resize(bodies_.size());
  for (const int i : movable_) {
    const auto id = static_cast<std::size_t>(spheres_.id[i]);
    const Vec3 now = spheres_.place[i].vec();
    travelled_speed_[id] = (now - places_[id]).norm() / (time_ - looked_);
    places_[id] = now;
  }
  looked_ = time_;
}

double ImpulseWorld::speed_of(int sphere) const {
  const auto id = static_cast<std::size_t>(spheres_.id[sphere]);
  return id < travelled_speed_.size() ? travelled_speed_[id] : std::numeric_limits<double>::infinity();
}

void ImpulseWorld::integrateTransforms(btScalar dt) {
  const double alpha = settings_.material.local_damping;
  const auto damped = [alpha](double now, double before) {
    const double taken = std::min(alpha * std::abs(now - before), std::abs(now));
    return now > 0 ? now - taken : now + taken;
  };
  for (const int i : movable_) {
    btRigidBody& body = *bodies_[static_cast<std::size_t>(spheres_.id[i])];
    btVector3 v = body.getLinearVelocity(), w = body.getAngularVelocity();
    const Vec3 v0 = spheres_.velocity[i].vec(), w0 = spheres_.spin[i].vec();
    for (int k = 0; k < 3; ++k) {
      v[k] = damped(v[k], v0[k]);
      w[k] = damped(w[k], w0[k]);
    }
    body.setLinearVelocity(v);
    body.setAngularVelocity(w);
  }
  RockWorld::integrateTransforms(dt);
}

void ImpulseWorld::read_back() {
  for (const int i : movable_) {
    const btRigidBody& body = *bodies_[static_cast<std::size_t>(spheres_.id[i])];
    spheres_.place[i].set(from_bullet(body.getWorldTransform().getOrigin()));
    spheres_.velocity[i].set(from_bullet(body.getLinearVelocity()));
    spheres_.spin[i].set(from_bullet(body.getAngularVelocity()));
  }
  btDispatcher* pairs = getDispatcher();
  for (int m = 0; m < pairs->getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *pairs->getManifoldByIndexInternal(m);
    double radius = 1e300;
    for (const btCollisionObject* object : {manifold.getBody0(), manifold.getBody1()})
      if (const btSphereShape* s = sphere_of(object))
        radius = std::min(radius, static_cast<double>(s->getRadius()));
    for (int c = 0; c < manifold.getNumContacts(); ++c)
      statistics_.largest_overlap_ratio =
          std::max(statistics_.largest_overlap_ratio, -manifold.getContactPoint(c).getDistance() / radius);
  }
}

}  // namespace scree
