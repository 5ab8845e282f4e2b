#include "sim/scene/estimate.h"

#include <numbers>

namespace scree {

double total_mass(const Scenario& scenario) {
  if (const auto* dump = std::get_if<EndDump>(&scenario.experiment)) return dump->payload * dump->dumps;
  if (const auto* push = std::get_if<PushDump>(&scenario.experiment)) return push->payload * push->dumps;
  if (const auto* buckets = std::get_if<BucketDump>(&scenario.experiment))
    return buckets->mass * buckets->buckets;
  if (const auto* lift = std::get_if<ReposeLift>(&scenario.experiment)) return lift->mass;
  const double diameter = std::get<DropTest>(scenario.experiment).diameter;
  return scenario.material.density * std::numbers::pi / 6 * diameter * diameter * diameter;
}

double estimated_spheres(const Scenario& scenario) {
  if (std::holds_alternative<DropTest>(scenario.experiment)) return 1;
  const EffectiveModel model = effective_model(scenario);
  return model.changes.clumps.spheres() *
         expected_spheres(model.grading, total_mass(scenario), density_of(model.material));
}

}  // namespace scree
