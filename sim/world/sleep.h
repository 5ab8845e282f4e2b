#pragma once
// Which spheres sleep, and what wakes them.
//
// A sphere falls asleep when it has been quiet for two windows in a row: moved less than kQuietTravel of its
// radius, and pulled by less than kQuietPull of its weight. Its place is then frozen; contacts between two
// sleepers keep their forces and are not computed. Contacts between a sleeper and an awake sphere are: the
// sleeper remembers the force it has got used to, and wakes when the force of any one contact has changed by
// more than kWake times (its weight + the mean of its contact forces). A sphere near a tool that moves does
// not sleep.
#include <vector>

#include "sim/world/pair_list.h"
#include "sim/world/spheres.h"

namespace scree {

class Sleep {
 public:
  explicit Sleep(bool on) : on_(on) {}
  bool on() const { return on_; }

  /// After spheres were re-sorted or added: `order[k]` is the old index of sphere k; what is known of it
  /// follows. `awake[i]`: must not sleep.
  void renumber(const std::vector<int>& order, Spheres& spheres, PairList& pairs,
                const std::vector<std::uint8_t>& awake, double time, double gravity);
  /// Lists which rows of the pair list have anything to compute; after the lists were repaired.
  void mark_rows(const Spheres& spheres, const PairList& pairs);
  bool row_active(int i) const { return row_active_[i] != 0; }

  /// At the end of a window puts quiet spheres to sleep. Spheres::force holds the
  /// contact forces of the last step.
  void look(Spheres& spheres, PairList& pairs, const std::vector<std::uint8_t>& awake, const ContactLaw& law,
            double time, const Vec3& gravity);

  /// A contact of a sleeper (with an awake sphere) has this force now. Safe from several threads.
  void feel(PairList& pairs, int p, int sleeper, const Vec3& force) {
    if (!pairs.rest_known[p]) {
      pairs.rest_known[p] = 1;
      pairs.rest_force[p] = force;
    } else if ((force - pairs.rest_force[p]).squaredNorm() > tolerance2_[sleeper]) {
      __atomic_store_n(&disturbed_[sleeper], std::uint8_t{1}, __ATOMIC_RELAXED);
      __atomic_store_n(&any_disturbed_, true, __ATOMIC_RELAXED);
    }
  }
  /// Wakes those that felt a disturbance.
  void wake_disturbed(Spheres& spheres, PairList& pairs);
  /// Wakes one sphere.
  void wake(int i, Spheres& spheres, PairList& pairs);
  std::int64_t asleep() const { return asleep_; }

 private:
  static void forget_rest(int i, PairList& pairs);

  bool on_;
  double window_ = 0, window_end_ = 0;  // s
  std::vector<Vec3> window_start_;      // places
  std::vector<std::uint8_t> quiet_windows_;
  std::vector<double> tolerance2_;  // N^2
  std::vector<std::uint8_t> disturbed_, row_active_;
  bool any_disturbed_ = false;
  std::int64_t asleep_ = 0;
};

}  // namespace scree
