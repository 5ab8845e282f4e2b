#include "sim/effects/registry.h"

namespace scree {

Effect weakening() {
  return {
      .name = "weakening",
      .title = "friction that falls with speed",
      .doc = "Fast slip has less friction than slow slip, as in rockslides.",
      .equation = "mu(v) = mu (1 - share v / (v + speed)), v the speed of slip in the contact.",
      .source = "Lucas, Mangeney & Ampuero, Nature Communications 5 (2014) 3417.",
      .parameters = {{.key = "share",
                      .unit = "",
                      .low = 0,
                      .high = 1,
                      .standard = 0.4,
                      .prior_low = 0,
                      .prior_high = 0.8,
                      .doc = "Share of the friction that fast slip takes away."},
                     {.key = "speed_m_per_s",
                      .unit = "m/s",
                      .low = 0.001,
                      .high = 100,
                      .standard = 0.3,
                      .prior_low = 0.1,
                      .prior_high = 1,
                      .doc = "Speed of slip at which half of that is gone."}},
      .absent = 0,
      .experiments = {},
      .apply =
          [](std::span<const double> v, const EffectContext&, Modifications& model) {
            model.contact.weakening = v[0];
            model.contact.weakening_speed = v[1];
          },
  };
}

}  // namespace scree
