#include "sim/effects/registry.h"

namespace scree {

Effect ground_friction() {
  return {
      .name = "ground_friction",
      .title = "ground rougher or smoother than the rock",
      .doc = "Floor, bench face or laboratory wall do not have the friction of rock on rock.",
      .equation =
          "mu and mu_r of contacts with floor, bench, wall and the fixed balls of a base layer are times "
          "factor.",
      .source =
          "Potyondy, Geotechnique 11 (1961): friction of soils against steel, wood and concrete, 0.5 to 1 of "
          "their internal friction.",
      .parameters = {{.key = "factor",
                      .unit = "",
                      .low = 0,
                      .high = 10,
                      .standard = 0.6,
                      .prior_low = 0.3,
                      .prior_high = 1.7,
                      .doc = "Friction of the ground over that of rock on rock."}},
      .absent = 1,
      .experiments = {},
      .apply =
          [](std::span<const double> v, const EffectContext&, Modifications& model) {
            model.ground_mu *= v[0];
            model.ground_mu_r *= v[0];
            model.contact.fixed_mu *= v[0];
            model.contact.fixed_mu_r *= v[0];
          },
  };
}

}  // namespace scree
