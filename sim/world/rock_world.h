#pragma once
// A Bullet dynamics world of rock: one scene, two engines behind this interface.
//
// Spheres are Bullet rigid bodies with sphere shapes and meshes are kinematic Bullet bodies in both engines.
// `RrlinearWorld` steps the contact law explicitly on its own arrays; update_bullet() writes the bodies back,
// so that ray tests, debug drawing and serialisation of Bullet see the scene (stepSimulation() does it by
// itself); `ImpulseWorld` leaves the stepping to Bullet's solver.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/contact/contact_effects.h"
#include "sim/io/snapshot.h"
#include "sim/io/state_stream.h"
#include "sim/material/material.h"
#include "sim/world/breakage.h"
#include "sim/world/clumps.h"
#include "sim/world/energy_balance.h"
#include "sim/world/energy_watch.h"
#include "sim/world/mesh_body.h"
#include "sim/world/spheres.h"
#include "sim/world/vibration.h"

namespace scree {

struct WorldSettings {
  Material material;
  ContactEffects contact_effects;  ///< rrlinear
  double flight_damping = 1;       ///< share of local damping that acts in flight (rrlinear)
  Vec3 gravity{0, 0, -9.81};       ///< m/s2
  Vibration vibration;             ///< of gravity (rrlinear)
  Breakage breakage;               ///< of spheres (rrlinear)
  Clumps clumps;                   ///< grains of two spheres (rrlinear)
  Vec3 domain_low = Vec3::Constant(-1e6), domain_high = Vec3::Constant(1e6);  ///< m; a sphere outside is lost
  double time_step_safety = 0.8;   ///< share of the stable step (rrlinear)
  double fixed_time_step = 0;      ///< s; above 0 it is used instead (rrlinear; for tests)
  bool sleep = false;              ///< spheres at rest cost nothing until disturbed (rrlinear; see sleep.h)
  double wake_tolerance = 0.1;     ///< share of (weight + mean contact force) that wakes a sleeper (rrlinear)
  int threads = 1;                 ///< worker threads of this world (rrlinear)
  double smallest_diameter = 0.2;  ///< m, of the rock: how near is near (impulse)
  double impulse_time_step = 1e-3;  ///< s (impulse)
  int impulse_iterations = 20;      ///< solver iterations (impulse)
};

struct WorldStatistics {
  std::int64_t steps = 0;
  double particle_steps = 0;                    ///< sum over steps of spheres moved
  double time_step_min = 0, time_step_max = 0;  ///< s
  double largest_overlap_ratio = 0;             ///< overlap over the smaller radius
  std::int64_t lost_particles = 0;
  double lost_mass = 0;                  ///< kg
  std::int64_t list_repairs = 0;         ///< times the pair list was repaired
  std::int64_t squeezed_into_walls = 0;  ///< mesh contacts that began inside a closed mesh
  std::int64_t crowded_contacts = 0;     ///< mesh contacts left out because a sphere had too many
  std::int64_t asleep = 0;               ///< spheres asleep now
  std::int64_t broken_spheres = 0;       ///< spheres that fragments took the place of

  /// Every member, for checkpoints.
  template <class Stream>
  void state(Stream& stream) {
    stream(steps, particle_steps, time_step_min, time_step_max, largest_overlap_ratio, lost_particles,
           lost_mass, list_repairs, squeezed_into_walls, crowded_contacts, asleep, broken_spheres);
  }
};

/// Parts a Bullet world needs before it is made.
struct BulletParts {
  /// Lets Bullet throw std::bad_alloc where memory runs out, which it writes to unasked.
  struct Memory {
    Memory();
  } memory;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
};

class RockWorld : private BulletParts, public btDiscreteDynamicsWorld {
 public:
  explicit RockWorld(const WorldSettings& settings);
  ~RockWorld() override;
  RockWorld(const RockWorld&) = delete;
  RockWorld& operator=(const RockWorld&) = delete;

  /// Adds spheres, or clumps of the same volumes in the place of those that are not fixed; ids of grains are
  /// given in order, from 0 on.
  void add_spheres(const std::vector<NewSphere>& spheres);
  /// Keeps the ids below `count` for add_spheres(); fragments, and the second spheres of clumps, get those
  /// from there on.
  void reserve_numbers(std::int64_t count) { reserved_ = count; }
  /// Adds a mesh; returns its index, which stays valid.
  int add_mesh(TriangleMesh mesh, const Surface& surface, Motion motion);
  const MeshBody& mesh(int index) const { return *meshes_[index]; }
  /// Gives a sphere or clump another velocity (m/s) and spin (rad/s), and wakes it.
  void set_velocity(std::int64_t id, const Vec3& velocity, const Vec3& spin);
  /// The grains whose middle lies `inside`: their mass (kg); takes them out of the model, where they do not
  /// count as lost, and returns it.
  double mass_of(const std::function<bool(const Vec3& place)>& inside) const;
  double take_out(const std::function<bool(const Vec3& place)>& inside);
  /// Gives a mesh a new motion; it should start where the mesh is.
  void set_mesh_motion(int index, Motion motion);
  /// Takes a mesh out of the scene; its index is not used again.
  void remove_mesh(int index);

  /// Steps to a time (s). Throws BlowUp.
  virtual void advance_to(double time) = 0;

  double time() const { return time_; }

  /// Whether the engine can be saved and go on with the same bits.
  virtual bool keeps_state() const { return false; }
  /// Writes everything that later steps depend on, but for the scene's meshes and their motions.
  virtual void save_state(StateWriter&) { throw StateError("this engine cannot be saved"); }
  /// Goes on from a saved state. The same meshes must have been added, moved and removed before, in the same
  /// order and at the same times; spheres and time come from the state. Throws StateError if it does not fit.
  virtual void load_state(StateReader&) { throw StateError("this engine cannot be saved"); }
  /// Lets time pass (to `time`, s) without a step: before load_state(), when a scene is built again.
  void skip_to(double time) { time_ = time; }

  const WorldSettings& settings() const { return settings_; }
  const WorldStatistics& statistics() const { return statistics_; }
  const Spheres& spheres() const { return spheres_; }
  /// Grains that are still in the model, by id: movable spheres, and clumps as spheres of their volume.
  Snapshot snapshot() const;
  /// Fixed balls, by id.
  std::vector<Grain> fixed_balls() const;
  /// Mass of the rock in the model, kg.
  double mass() const;
  /// Share of the mass in the model that moves faster than `speed` (m/s).
  double moving_mass_share(double speed) const;
  /// Speed (m/s) of a movable sphere (its index) as moving_mass_share() takes it.
  virtual double speed_of(int sphere) const { return spheres_.velocity[sphere].vec().norm(); }
  virtual Energy energy() const;
  /// The account of energy so far, closed now; none where the engine keeps none (impulse: Bullet's solver
  /// works with impulses and pushes overlaps apart, so no force has a work that could be summed).
  virtual std::optional<EnergyBalance> energy_balance() const { return std::nullopt; }
  /// Brings Bullet's bodies and boxes to the present state.
  virtual void update_bullet() {}
  /// The Bullet body of a sphere, by id, in its present state; null when lost.
  btRigidBody* sphere_body(std::int64_t id);

 protected:
  /// Called when spheres were added (they are the last ones) or meshes changed.
  virtual void scene_changed() = 0;
  /// True if the engine moves spheres through Bullet's solver.
  virtual bool bullet_moves_spheres() const = 0;
  /// Counts and takes out those of some movable spheres that are beyond the domain; throws BlowUp if one is
  /// not finite or too fast.
  void check_spheres(std::span<const int> spheres);
  /// Puts fragments into the place of a movable sphere (its index); those but the first are the last spheres
  /// then. Returns their indices. The engine has to know: scene_changed().
  std::array<int, Breakage::kFragments> replace_by_fragments(int sphere);
  /// Gives a sphere another radius (m); its mass stays.
  void set_radius(int sphere, double radius);
  /// Makes the Bullet bodies that are not there yet. The explicit engine needs none to step.
  void make_bodies();
  /// Whether a sphere (its index) is rock that is in the model: not a fixed ball, and not lost. Where fixed
  /// balls stand among the others is the engine's choice.
  bool is_rock(int sphere) const { return !fixed_[sphere] && !spheres_.lost[sphere]; }
  double gravity_energy(int sphere) const;  ///< potential, against the origin, J
  virtual void sphere_pushed(int) {}
  virtual void mesh_leaves(int) {}
  virtual void sphere_lost(int index) = 0;
  void leave(int index);
  // Grains whose middle lies inside; of a clump one of its spheres.
  std::vector<int> leaders(const std::function<bool(const Vec3& place)>& inside) const;
  /// State that both engines share (world_state.cpp).
  template <class Stream>
  void shared_state(Stream& stream);

  WorldSettings settings_;
  WorldStatistics statistics_;
  EnergyAccount account_;
  double time_ = 0;
  Spheres spheres_;
  std::vector<std::uint8_t> fixed_;                     // by index
  std::vector<std::unique_ptr<MeshBody>> meshes_;       // null: removed
  std::vector<std::unique_ptr<btRigidBody>> bodies_;    // by id; those made so far
  std::vector<std::unique_ptr<btSphereShape>> shapes_;  // by id

 private:
  void add_sphere(const NewSphere& sphere, double mass, std::int64_t id);
  void add_clump(const NewSphere& grain, double mass, std::int64_t id);
  void drop_body(std::int64_t id);

  std::int64_t next_ = 0, reserved_ = 0, next_fragment_ = 0;  // ids
};

/// Makes the world of an engine.
std::unique_ptr<RockWorld> make_rrlinear_world(const WorldSettings& settings);
std::unique_ptr<RockWorld> make_impulse_world(const WorldSettings& settings);

}  // namespace scree
