#pragma once
// The two loops in which nearly all of the time goes: forces of contacts between spheres, and leapfrog.
//
// Spheres are handled in blocks of kBlock neighbours in memory (and so in space). A block goes through the
// contacts that its awake spheres own, and those that they have with sleeping owners, row by row. Some sixty
// at a time are computed in groups of four (lanes.h); forces and moments are added one contact after another
// in the order in which they were collected, which does not depend on threads. What acts on a sphere is the
// sum of
//   far:  contacts owned by spheres of earlier blocks, and
//   near: contacts of its own block, then with meshes.
// One thread adds far forces as it goes; several write them down block by block and add them afterwards.
// Order and grouping are the same, so the sums are too, bit by bit.
#include <span>
#include <vector>

#include "sim/contact/rrlinear.h"
#include "sim/world/energy_balance.h"
#include "sim/world/energy_watch.h"
#include "sim/world/pair_list.h"
#include "sim/world/sleep.h"
#include "sim/world/spheres.h"

namespace scree {

inline constexpr int kBlock = 512;  ///< spheres a block

/// Forces that one block's contacts exert on spheres of a later block, in the order of the contacts.
struct FarForces {
  int block;  ///< the later one
  struct alignas(64) Entry {
    Lanes force, torque;  // the torque's companion is the sphere's number
    int sphere() const { return static_cast<int>(torque[3]); }
  };
  std::vector<Entry> entries;
};

/// What one block works on and brings back.
struct BlockWork {
  int block = 0;                  ///< spheres block * kBlock and on
  std::span<const int> awake;     ///< spheres of the block that move
  std::vector<int> near_meshes;   ///< awake spheres of the block that have facets
  std::vector<int> disturbed;     ///< sleepers that one of its contacts wakes
  double overlap_ratio = 0;       ///< largest overlap over the smaller radius
  double supplied = 0;            ///< work of tools, and energy that contacts with meshes brought (J)
  EnergyLosses losses;            ///< of this step
  double tools = 0, pressed = 0;  ///< of this step (EnergyAccount), J
  Vec3 momentum;                  ///< sum of mass times the mean of the velocities before and after, kg m/s
  std::vector<int> broken;        ///< awake spheres that break
  AwakeEnergy energy;             ///< of its awake spheres, when asked for
  bool left_ball = false;         ///< a sphere has left its ball (PairList)
  std::vector<int> near_rim;      ///< those that have, or are near its rim
  double step2 = 0, travel = 0;   ///< stable step squared (s2) and the step for the longest travel (s)
  std::vector<FarForces> far;     ///< written down for later blocks (several threads); the first far_blocks
  std::size_t far_blocks = 0;
  std::span<const FarForces> written_down() const { return std::span(far).first(far_blocks); }
  std::vector<const FarForces*>
      inbox;  ///< what earlier blocks wrote down for this one, in the order of adding
};

/// Makes `blocks` one for each block that has awake spheres, rising, each with its share of them; nobody is
/// near its rim yet.
void split_into_blocks(std::span<const int> awake, std::vector<BlockWork>& blocks);

struct StepView {
  Spheres& spheres;
  PairList& pairs;
  const Sleep& sleep;
  const ContactLaw& law;
  const FrictionFactors* friction;  ///< by sphere; null: the plain law, without effects on contacts
  double last_dt;                   ///< s, the step that led to the present places
  ForceSum* sum;                    ///< by sphere
  bool write_down;                  ///< forces that cross a border are written down instead of added
};

/// Forces of the contacts that the block's awake spheres own, or have with sleepers that own them, what they
/// write down, and whom they wake; the sums of the block's awake spheres begin here, from zero.
void contact_forces(const StepView& view, BlockWork& work);

struct LeapfrogView {
  Spheres& spheres;
  const PairList& pairs;
  ForceSum* sum;  ///< by sphere; what was written down is added first
  Vec3 gravity;   ///< m/s2
  double alpha;   ///< local damping of what touches something
  double alpha_in_flight;
  double dt;  ///< s
};

/// Moves the block's spheres by one step, but for those of clumps (clumps.h); finds those near the rim of
/// their balls.
void leapfrog(const LeapfrogView& view, BlockWork& work);

}  // namespace scree
