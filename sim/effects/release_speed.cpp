#include "sim/effects/registry.h"

namespace scree {

Effect release_speed() {
  return {
      .name = "release_speed",
      .title = "load that leaves the bed at speed",
      .doc =
          "A bed that is hoisted throws its load out; in the base model a gate opens before rock that has "
          "settled for a second.",
      .equation = "When the gate opens, all grains of the load move along the bed with this speed.",
      .source = "Hoisted and gated dumping compared in scenarios/hoist_dump.yaml.",
      .parameters = {{.key = "speed_m_per_s",
                      .unit = "m/s",
                      .low = 0,
                      .high = 20,
                      .standard = 1,
                      .prior_low = 0,
                      .prior_high = 4,
                      .doc = "Speed along the bed when the gate opens."}},
      .absent = 0,
      .experiments = {"end_dump"},
      .needs = EffectNeed{&EffectScene::gate_opens, "experiment.truck.release open_gate"},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.release_speed += v[0]; },
  };
}

}  // namespace scree
