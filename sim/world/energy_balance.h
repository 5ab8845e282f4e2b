#pragma once
// The account of a run's energy: what was put in is still there or was taken out, term by term.
//
//   put in     rock as it came, with speed; the fall (work of gravity); tools; a platform that shakes;
//              velocities that were set; contacts that began pressed; growth of fragments
//   held       kinetic, elastic (springs of contacts), pull (potential of cohesion, negative)
//   taken out  friction (sliding, rolling, twisting), dashpots, local damping, spheres put to sleep or lost
//
// Each term is summed by itself in the loops of a step, none is what is left over by the others, so
//   error = put in - held - taken out
// is what the scheme of time makes or loses, or what nobody accounted for. A run in which it exceeds 1 % of
// what was put in says nothing (scene/watch.h).
//
// The terms follow leapfrog. From v- to v+ = v- + F dt / m the kinetic energy of a sphere changes by exactly
// F . (v- + v+) / 2 dt, whatever makes up F: so local damping and shaking are summed as their force times the
// mean of the two velocities. The force F(n) of a contact at x(n) thus works on half of the motion d(n) that
// led there and half of d(n + 1) that leads on; sorted by motions instead of by forces, a spring works on
// d(n) with (F(n-1) + F(n)) / 2. Of a spring of stiffness k, force s before, w = s + k d then, cut off to c
// w:
//   work - change of s^2 / 2k = (1 - c) w / k . (s + c w) / 2,
// the slip times the mean force. A contact that opens slips by all that its springs still hold (c = 0). A
// dashpot's force is c v, and its work on d(n) is v(n) . (v(n-1) + v(n)) / 2 c dt, for which the power of the
// step before is remembered: |v(n-1)| |v(n)| in place of the product. Where velocities lie half a step beyond
// places, at the end of the account, and where a step begins or ends a contact, energy is off by O(dt) of
// what that contact holds; it does not add up. Of the pull of cohesion, which does not grow from nothing, the
// force itself makes up for it (share_closed in contact/rrlinear.h).
namespace scree {

/// Energy taken from the motion for good, J.
struct EnergyLosses {
  double sliding = 0, rolling = 0, twisting = 0;
  double dashpots = 0;
  double local_damping = 0;

  double total() const { return sliding + rolling + twisting + dashpots + local_damping; }
  void add(const EnergyLosses& more) {
    sliding += more.sliding, rolling += more.rolling, twisting += more.twisting;
    dashpots += more.dashpots, local_damping += more.local_damping;
  }
  template <class Stream>
  void state(Stream& stream) {
    stream(sliding, rolling, twisting, dashpots, local_damping);
  }
};

/// Energies of the scene, J. Elastic: of the springs of contacts; pull: potential of cohesion, negative.
struct Energy {
  double kinetic = 0, potential = 0, elastic = 0, pull = 0;
  double total() const { return kinetic + potential + elastic + pull; }
  template <class Stream>
  void state(Stream& stream) {
    stream(kinetic, potential, elastic, pull);
  }
};

/// Sums over the run so far, J; plain numbers, so that they can be written down and read again.
struct EnergyAccount {
  // Put in.
  double came_moving = 0;     ///< kinetic energy of spheres when they were added
  double came_potential = 0;  ///< their potential energy then
  double set_moving = 0;      ///< by velocities that were set
  double tools = 0;           ///< work of meshes that move, and what left with those taken away (negative)
  double shaking = 0;         ///< work of the part of gravity that swings
  double pressed = 0;    ///< held by contacts that began while pressed, less by those that ended so: spheres
                         ///< put upon others, corners of meshes
  double fragments = 0;  ///< change when spheres broke and fragments grew; negative: lost in fracture
  // Taken out.
  EnergyLosses losses;
  double put_to_sleep = 0;    ///< kinetic energy of spheres that fell asleep
  double lost_potential = 0;  ///< potential energy of spheres when they left the model
  double lost_other = 0;      ///< what else they took along: kinetic, and of their contacts

  double weight_times_radius = 0;  ///< of all spheres: energies far below it do not matter

  template <class Stream>
  void state(Stream& stream) {
    stream(came_moving, came_potential, set_moving, tools, shaking, pressed, fragments, losses, put_to_sleep,
           lost_potential, lost_other, weight_times_radius);
  }
};

/// The account closed at one time.
struct EnergyBalance {
  Energy held;
  EnergyAccount account;

  /// Work of gravity, J.
  double fall() const { return account.came_potential - account.lost_potential - held.potential; }
  /// What was put in, J: the terms that gave energy, without those that took.
  double put_in() const;
  /// Put in and neither held nor taken out, J.
  double error() const;
  /// Error over what was put in, or over a thousandth of weight times radius if that is more.
  double relative_error() const;
  template <class Stream>
  void state(Stream& stream) {
    stream(held, account);
  }
};

}  // namespace scree
