#include "sim/effects/registry.h"

namespace scree {

Effect undamped_flight() {
  return {
      .name = "undamped_flight",
      .title = "no damping in flight",
      .doc =
          "Rock in flight feels no damping but the air's; the base model damps it as if it lay in the pile.",
      .equation = "Local damping of a grain that touches nothing is alpha (1 - share).",
      .source =
          "Cundall, in: Analytical and Computational Methods in Engineering Rock Mechanics (1987); PFC "
          "documentation: local damping is not meant for free flight.",
      .parameters = {{.key = "share",
                      .unit = "",
                      .low = 0,
                      .high = 1,
                      .standard = 1,
                      .prior_low = 0,
                      .prior_high = 1,
                      .doc = "Share of the damping that flight does without."}},
      .absent = 0,
      .experiments = {},
      .needs = EffectNeed{&EffectScene::damped_flight, "material.damping_reach always"},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.flight_damping *= 1 - v[0]; },
  };
}

}  // namespace scree
