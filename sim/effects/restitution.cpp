#include "sim/effects/registry.h"

namespace scree {

Effect restitution() {
  return {
      .name = "restitution",
      .title = "energy lost in collisions",
      .doc = "Collisions lose more energy than local damping takes: corners crush, edges chip.",
      .equation =
          "A dashpot along the normal with damping_ratio of the critical damping: F = 2 beta sqrt(m kn) "
          "times the closing speed, never a pull.",
      .source = "Schwager & Poeschel, Granular Matter 9 (2007).",
      .parameters = {{.key = "damping_ratio",
                      .unit = "",
                      .low = 0,
                      .high = 2,
                      .standard = 0.3,
                      .prior_low = 0,
                      .prior_high = 0.8,
                      .doc = "Share of critical damping of the normal dashpot, added to the material's."}},
      .absent = 0,
      .experiments = {},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.normal_damping_ratio += v[0]; },
  };
}

}  // namespace scree
