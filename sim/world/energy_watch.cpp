#include "sim/world/energy_watch.h"

#include <fmt/format.h>

#include <algorithm>

namespace scree {
namespace {
constexpr double kMost = 2.0;    // times what energy can have grown to
constexpr double kSmall = 0.01;  // of weight times radius of all: below this nothing blows up
}  // namespace

void EnergyWatch::check(const AwakeEnergy& now, double lost, double time) {
  const double had = before_.kinetic + before_.elastic, has = now.kinetic + now.elastic;
  const double taken = lost - lost_before_;
  const double fallen = std::max(before_.potential - now.potential, 0.0);
  if (known_ && has + taken > kMost * (had + fallen + supplied_) + kSmall * now.scale)
    throw BlowUp(
        fmt::format("the run blew up at t = {:.4f} s (energy of motion and contacts went from {:.3g} J to "
                    "{:.3g} J and {:.3g} J were lost, with {:.3g} J to account for it): lower "
                    "numerics.time_step_safety",
                    time, had, has, taken, fallen + supplied_));
  known_ = true;
  before_ = now;
  supplied_ = 0;
  lost_before_ = lost;
}

}  // namespace scree
