#include "sim/scene/watch.h"

#include <fmt/format.h>

#include <cmath>

namespace scree {

bool closes(const EnergyBalance& balance) {
  return std::abs(balance.relative_error()) <= kMostEnergyError;
}

std::vector<std::string> watch_failures(const RunOutcome& outcome) {
  std::vector<std::string> failures;
  double mass = outcome.statistics.lost_mass;
  bool finite = true;
  for (const Grain& grain : outcome.final_state.grains) {
    mass += grain.mass;
    finite = finite && grain.position.allFinite() && grain.velocity.allFinite();
  }
  if (!finite)
    failures.emplace_back("a sphere has no finite place or velocity: lower numerics.time_step_safety");
  const double lost = outcome.statistics.lost_mass;
  const bool leaks = lost > kMostLost * mass;
  if (outcome.energy) {
    const double error = outcome.energy->relative_error();
    // Energy that is missing may have gone with the rock that left; energy out of nothing has not.
    if (!closes(*outcome.energy) && !(leaks && error > 0))
      failures.push_back(
          fmt::format("the energy balance is open by {:+.2f} % of what was put in, more than {:.0f} %: lower "
                      "numerics.time_step_safety",
                      -100 * error, 100 * kMostEnergyError));
  }
  if (leaks)
    failures.push_back(fmt::format(
        "{:.2f} % of the mass left the model, more than {:.0f} %: widen the bench or its floor, or "
        "close the container's mesh",
        100 * lost / mass, 100 * kMostLost));
  return failures;
}

}  // namespace scree
