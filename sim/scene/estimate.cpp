#include "sim/scene/estimate.h"

#include <cmath>
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

double estimated_spheres(const Grading& grading, double mass, double density) {
  double per_volume = 0;  // spheres of diameter d in the volume of rock: 1 / (pi/6 d^3)
  const auto& points = grading.points();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double d1 = points[i - 1].diameter, d2 = points[i].diameter;
    const double inverse_cube = (std::pow(d1, -3) - std::pow(d2, -3)) / (3 * std::log(d2 / d1));
    per_volume += (points[i].passing - points[i - 1].passing) * inverse_cube * 6 / std::numbers::pi;
  }
  return per_volume * mass / density;
}

double estimated_spheres(const Scenario& scenario) {
  if (std::holds_alternative<DropTest>(scenario.experiment)) return 1;
  const EffectiveModel model = effective_model(scenario);
  return model.changes.clumps.spheres() *
         estimated_spheres(model.grading, total_mass(scenario), scenario.material.density);
}

}  // namespace scree
