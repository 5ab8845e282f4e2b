#pragma once
// The explicit engine: the rrlinear law, stepped by leapfrog with synchronised contact memory.
//
// One step from t to t + dt:
//   1. forces at x(t): pairs (PairList), meshes (mesh_contact), each through contact_step(); the displacement
//      increments of shear and rolling are v(t - dt/2) dt, exactly what led from x(t - dt) to x(t), so memory
//      and positions never run apart (Vyas et al., Computer Physics Communications 310, 2025);
//   2. gravity and local damping; v(t + dt/2) = v(t - dt/2) + a dt; x(t + dt) = x(t) + v(t + dt/2) dt;
//   3. tools move; spheres that have left their ball are listed anew.
// The step is recomputed as the run goes on: safety * min over the spheres that move and their axes of sqrt(m
// / k), sqrt(I / k_rot) with k summed over the contacts a sphere has and those it may soon have, shorter
// where they have dashpots, and at most that of the smallest sphere in flight; a sphere that wakes brings its
// own bound. Spheres at rest may sleep (sleep.h).
//
// Sums over contacts run in a fixed order (step_kernels.h), so results are bitwise the same for any number of
// threads.
#include "sim/contact/rrlinear.h"
#include "sim/world/facet_list.h"
#include "sim/world/pair_list.h"
#include "sim/world/rock_world.h"
#include "sim/world/sleep.h"
#include "sim/world/step_kernels.h"
#include "sim/world/team.h"

namespace scree {

class RrlinearWorld final : public RockWorld {
 public:
  explicit RrlinearWorld(const WorldSettings& settings);
  void advance_to(double time) override;
  Energy energy() const override;
  std::optional<EnergyBalance> energy_balance() const override;
  const PairList& pairs() const { return pairs_; }
  /// Contacts of a sphere with meshes now (index as in spheres()).
  std::vector<MeshContact> mesh_contacts(int index) const;
  /// Bytes held for spheres and contacts, without Bullet's bodies.
  std::size_t bytes() const;
  /// Bullet's own entry: steps by `span` seconds.
  int stepSimulation(btScalar span, int max_sub_steps = 1, btScalar fixed = 1. / 60) override;
  void update_bullet() override;
  bool keeps_state() const override { return true; }
  void save_state(StateWriter& writer) override;
  void load_state(StateReader& reader) override;

 protected:
  void scene_changed() override { changed_ = true; }
  bool bullet_moves_spheres() const override { return false; }
  void sphere_pushed(int index) override;
  void sphere_lost(int index) override;
  void mesh_leaves(int index) override;

 private:
  template <class Stream>
  void state(Stream& stream);
  void prepare();
  void step(double dt);
  void split_awake();
  void forces(double dt);
  void mesh_forces(BlockWork& work, double dt);
  void move_tools();
  void repair();
  void wake(std::vector<int>& disturbed);
  void find_broken(BlockWork& work) const;
  void break_spheres();
  void grow_fragments();
  void supply_of_vibration(BlockWork& work, double dt) const;
  double free_step2(double radius, double mass, double inertia) const;
  double own_step2(int i) const;
  double potential_energy(int i) const;
  double pull_work(int i, const Neighbour& n) const;
  double elastic_energy_of(int i, const Neighbour& n) const;
  double elastic_energy_of(const MeshContact& c, int i) const;
  double pull_work(const MeshContact& c, int i) const;
  double held_by(int i, const Neighbour& n) const { return elastic_energy_of(i, n) - pull_work(i, n); }
  double held_by(const MeshContact& c, int i) const { return elastic_energy_of(c, i) - pull_work(c, i); }
  double energy_by_places() const;
  void account_for_new(const std::vector<int>& order, int known);
  AwakeEnergy awake_energy(const BlockWork& work) const;
  void check_energy();
  double stable_step();
  void find_watched();
  double horizon() const;
  bool several_threads() const { return settings_.threads > 1; }
  template <class Body>
  void for_blocks(Body&& body);

  ContactLaw law_;
  std::vector<FrictionFactors> friction_;  // by sphere; empty without effects on contacts
  Team team_;
  bool changed_ = true;         // spheres or meshes were added or removed
  int sorted_spheres_ = 0;      // spheres that there were when they were last sorted
  bool repair_due_ = false;     // a sphere has left its ball, or was lost
  double dt_ = 0;               // stable step, s
  double smallest_radius_ = 0;  // of the spheres that move, m
  double longest_step_ = 0;     // that of the smallest sphere in flight, s
  double last_dt_ = 0;          // the step that led to the present places, s
  int steps_to_check_ = 0, checks_to_energy_ = 0;
  EnergyWatch energy_watch_;
  PairList pairs_;
  FacetList facets_;
  Sleep sleep_;
  std::vector<std::uint8_t> watched_;  // near a tool that moves: does not sleep
  std::vector<ForceSum> sum_;          // by sphere; of awake ones, from the last step
  std::vector<BlockWork> blocks_;      // those with anything to do
  std::vector<int> block_at_;          // by block: its place in blocks_, or -1
  std::vector<int> disturbed_, near_rim_;
  std::vector<GrowingSphere> growing_;
  std::vector<double> bears_;               // by sphere: energy of a contact that does not break it, J
  double last_growth_ = 0;                  // of fragments, s
  std::optional<double> before_fragments_;  // energy of the scene before spheres broke or fragments grew, J
  bool blocks_due_ = true;                  // who is awake has changed
};

}  // namespace scree
