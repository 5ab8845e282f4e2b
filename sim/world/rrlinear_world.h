#pragma once
// The explicit engine: the rrlinear law, stepped by leapfrog with synchronised contact memory.
//
// One step from t to t + dt:
//   1. forces at x(t): pairs (PairList), meshes (mesh_contact), each through contact_step(); the displacement
//   increments of shear and
//      rolling are v(t - dt/2) dt, exactly what led from x(t - dt) to x(t), so memory and positions never run
//      apart (Vyas et al., Computer Physics Communications 310, 2025);
//   2. gravity and local damping; v(t + dt/2) = v(t - dt/2) + a dt; x(t + dt) = x(t) + v(t + dt/2) dt;
//   3. tools move; spheres that may have left their skin are listed anew.
// The step is recomputed as the run goes on: safety * min over spheres and axes of sqrt(m / k), sqrt(I /
// k_rot) with k summed over the contacts a sphere has and those it may soon have. Spheres at rest may sleep
// (sleep.h).
//
// Sums over contacts run in a fixed order: a sphere's force is (contacts in which it is partner, by owner) +
// (contacts it owns, by partner) + (meshes), whether one thread adds as it goes or several gather afterwards,
// so results are bitwise the same for any number of threads.
#include <tbb/task_arena.h>

#include "sim/contact/rrlinear.h"
#include "sim/world/mesh_contact.h"
#include "sim/world/pair_list.h"
#include "sim/world/rock_world.h"
#include "sim/world/sleep.h"

namespace scree {

class RrlinearWorld final : public RockWorld {
 public:
  explicit RrlinearWorld(const WorldSettings& settings);
  void advance_to(double time) override;
  Energy energy() const override;
  const PairList& pairs() const { return pairs_; }
  /// Contacts of a sphere with meshes now (index as in spheres()).
  std::vector<MeshContact> mesh_contacts(int index) const;
  /// Bullet's own entry: steps by `span` seconds.
  int stepSimulation(btScalar span, int max_sub_steps = 1, btScalar fixed = 1. / 60) override;
  void update_bullet() override;

 protected:
  void scene_changed() override { changed_ = true; }
  bool bullet_moves_spheres() const override { return false; }
  void sphere_lost(int index) override;

 private:
  struct PairForce {
    double force[3], torque[3];  // on the partner
  };
  void prepare();
  void step(double dt);
  void forces();
  template <bool kScatter>
  double pair_forces(int first, int last);
  double mesh_forces(int first, int last);
  void gather(int first, int last);
  bool integrate(int first, int last, double dt);
  void move_tools();
  void repair();
  void list_facets(const std::vector<int>& listed, bool tools_moved);
  double stable_step(bool sleepers_too);
  void find_watched();
  double horizon() const;
  bool several_threads() const { return settings_.threads > 1; }
  template <class Body>
  double for_ranges(int count, Body&& body);

  ContactLaw law_;
  bool changed_ = true;            // spheres or meshes were added or removed
  bool repair_due_ = false;        // a sphere may have left its skin, or was lost
  std::vector<double> own_step2_;  // square of each sphere's own stable step, s2
  double dt_ = 0;                  // stable step, s
  double last_dt_ = 0;             // the step that led to the present places, s
  int steps_to_check_ = 0;
  std::int64_t next_sort_ = 0;  // step
  PairList pairs_;
  std::vector<Quad> incoming_force_, incoming_torque_;  // from contacts in which the sphere is partner
  std::vector<PairForce> pair_force_;                   // several threads only
  // Facets near each movable sphere, in rows; spheres with none have an empty row.
  std::vector<int> facet_begin_;
  std::vector<FacetRef> facets_;
  std::vector<int> slot_of_;  // first slot of a sphere, or -1
  std::vector<MeshContact> slots_;
  std::vector<int> facet_rows_;  // spheres with facets, rising
  double tool_skin_ = 0;
  Sleep sleep_;
  std::vector<std::uint8_t> watched_;  // near a tool that moves: does not sleep
  std::unique_ptr<tbb::task_arena> arena_;
};

}  // namespace scree
