// A scenario's rock and grading with what its effects change.
#include <algorithm>

#include "sim/scene/scenario.h"

namespace scree {

EffectUse* Scenario::effect(const Effect& wanted) {
  const auto at = std::find_if(effects.begin(), effects.end(),
                               [&](const EffectUse& use) { return use.effect == &wanted; });
  return at == effects.end() ? nullptr : &*at;
}

const EffectUse* Scenario::effect(const Effect& wanted) const {
  return const_cast<Scenario*>(this)->effect(wanted);
}

Grading grading_of(const Scenario& scenario) {
  return read_grading(scenario.grading_file, scenario.grading_from);
}

EffectiveModel effective_model(const Scenario& scenario) {
  EffectiveModel model{{}, grading_of(scenario), scenario.material, {}};
  EffectContext& context = model.context;
  context = {.d50 = scenario.effect_diameter.value_or(model.grading.diameter(0.5)),
             .smallest = model.grading.min_diameter(),
             .density = scenario.material.density};
  model.changes = modifications(scenario.effects, context);
  model.material.normal_damping_ratio += model.changes.normal_damping_ratio;
  model.material.density_exponent = model.changes.density_exponent;
  model.material.density_diameter = context.d50;
  if (model.changes.fines_share > 0)
    model.grading = model.grading.with_fines(model.changes.fines_share, model.changes.fines_ratio);
  return model;
}

EffectScene effect_scene(const Scenario& scenario) {
  EffectScene scene{.experiment = experiment_type(scenario)};
  if (const auto* dump = std::get_if<EndDump>(&scenario.experiment))
    scene.gate_opens = dump->truck.release == Release::open_gate;
  scene.damped_flight = scenario.material.damping_reach == DampingReach::always;
  return scene;
}

std::vector<std::string> effects_in_words(const Scenario& scenario) {
  std::vector<std::string> lines;
  if (scenario.effects.empty()) return lines;
  const EffectContext context = effective_model(scenario).context;
  for (const EffectUse& use : scenario.effects) lines.push_back(effect_in_words(use, context));
  return lines;
}

}  // namespace scree
