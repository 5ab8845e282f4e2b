#pragma once
// Notices a run that makes energy out of nothing, as an explicit scheme does when its step is too long.
//
// Over an interval, kinetic and elastic energy of the spheres that are awake, with what friction and local
// damping took of it, may grow by no more than what they lost in height, what tools did to them, and what
// contacts that began in the interval, or those of spheres that woke, brought with them. The limit is twice
// that: velocities are half a step away from places, and single impacts show it; a step that is too long
// doubles the energy every few steps, or, where friction bounds the motion, feeds friction.
#include <stdexcept>

namespace scree {

/// A run that came to nothing: no numbers, a runaway sphere, or energy out of nothing.
struct BlowUp : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Energies of the spheres that are awake and of their contacts, J.
struct AwakeEnergy {
  double kinetic = 0, elastic = 0;
  double potential = 0;  ///< against the origin
  double scale = 0;      ///< sum of weight times radius: motion far below it does not matter
};

class EnergyWatch {
 public:
  /// Spheres or meshes were added or taken away: the next check begins anew.
  void restart() { known_ = false; }
  /// A sphere woke, with this elastic energy in its contacts.
  void add_awake(double potential, double elastic) {
    supplied_ += elastic;
    before_.potential += potential;
  }
  /// Spheres of this potential energy fell asleep; the energy of their contacts stays in the account.
  void take_asleep(double potential) { before_.potential -= potential; }
  /// Tools did this work, or contacts began with this energy.
  void supply(double energy) { supplied_ += energy; }

  /// Compares with the check before; `lost`: what friction and local damping have taken since the run began,
  /// J. Not what dashpots have: they act on the velocity of half a step ago, and may take most of it in one.
  /// Throws BlowUp.
  void check(const AwakeEnergy& now, double lost, double time);

  /// For saving and going on: world_state.cpp.
  template <class Stream>
  void state(Stream& stream);

 private:
  bool known_ = false;
  AwakeEnergy before_;
  double supplied_ = 0;
  double lost_before_ = 0;
};

}  // namespace scree
