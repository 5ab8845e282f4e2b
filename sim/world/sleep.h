#pragma once
// Which spheres sleep, and what wakes them.
//
// A sphere falls asleep when it has been quiet for twice 3 sqrt(radius / g): slower than kQuietTravel of its
// radius in one of these, 0.0017 sqrt(radius g), in each of the windows that it is looked at in, which are
// the smallest sphere's, and pulled by less than kQuietPull of its weight. Its place is then frozen; contacts
// between two sleepers keep their forces and are not computed. Contacts between a sleeper and an awake sphere
// are: the sleeper remembers the force it has got used to, and wakes when the force of any one contact has
// changed by more than the tolerance times (its weight + the mean of its contact forces). A sphere near a
// tool that moves does not sleep.
//
// Whatever is done every step goes over the lists kept here, not over all spheres.
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "sim/world/pair_list.h"
#include "sim/world/spheres.h"

namespace scree {

/// Force (N; its companion counts contacts) and moment (N m) on a sphere.
struct alignas(64) ForceSum {
  Quad force, torque;
};

class Sleep {
 public:
  Sleep(bool on, double wake_tolerance) : on_(on), wake_tolerance_(wake_tolerance) {}
  bool on() const { return on_; }

  /// Spheres that move, rising.
  std::span<const int> awake() const { return awake_; }

  /// After spheres were re-sorted or added: `order[k]` is the old index of sphere k; what is known of it
  /// follows. `stay_awake[i]`: must not sleep.
  void renumber(const std::vector<int>& order, Spheres& spheres, PairList& pairs,
                const std::vector<std::uint8_t>& stay_awake, double time, double gravity);
  /// A sphere has left the model.
  void lose(int i, Spheres& spheres);

  /// At the end of a window puts quiet spheres to sleep. `sums` hold what acted on each in the last step.
  /// `stay_awake[i]`: must not sleep.
  void look(Spheres& spheres, std::span<const ForceSum> sums, PairList& pairs,
            const std::vector<std::uint8_t>& stay_awake, const ContactLaw& law, double time,
            const Vec3& gravity);

  /// A contact of a sleeper with an awake sphere has this force now. True if it wakes the sleeper.
  bool disturbs(RestForce& rest, int sleeper, const Vec3& force) const {
    if (rest.known != 0) return (force - Vec3(rest.x, rest.y, rest.z)).squaredNorm() > tolerance2_[sleeper];
    rest = {static_cast<float>(force.x()), static_cast<float>(force.y()), static_cast<float>(force.z()), 1};
    return false;
  }
  /// Wakes these (in any order, each as often as it likes), and leaves in `disturbed` those that were asleep,
  /// rising. True if there were any.
  bool wake(std::vector<int>& disturbed, Spheres& spheres, PairList& pairs);
  std::int64_t asleep() const { return asleep_; }
  /// Those that the last look() put to sleep.
  std::span<const int> fallen_asleep() const { return fallen_asleep_; }
  /// Kinetic energy that these had, J.
  double put_to_sleep() const { return put_to_sleep_; }
  /// For saving and going on: world_state.cpp.
  template <class Stream>
  void state(Stream& stream);
  /// Bytes held.
  std::size_t bytes() const {
    return window_start_.capacity() * (sizeof(Vec3) + 2 + sizeof(double)) + awake_.capacity() * sizeof(int);
  }

 private:
  /// Windows that make one of a sphere's own.
  double own_windows(double radius) const { return std::sqrt(std::max(radius / smallest_radius_, 1.0)); }
  static void forget_rest(int i, const Spheres& spheres, PairList& pairs);

  bool on_;
  double wake_tolerance_;
  double window_ = 0, window_end_ = 0;  // s
  double smallest_radius_ = 0;          // m
  std::vector<Vec3> window_start_;      // places
  std::vector<std::uint8_t> quiet_windows_;
  std::vector<double> tolerance2_;  // N^2
  std::vector<int> awake_, fallen_asleep_;
  std::int64_t asleep_ = 0;
  double put_to_sleep_ = 0;
};

}  // namespace scree
