#include "sim/effects/registry.h"

namespace scree {

Effect friction_by_size() {
  return {
      .name = "friction_by_size",
      .title = "friction that changes with size",
      .doc = "Sliding friction falls (or rises) with the size of the blocks.",
      .equation = "mu of a contact is times (sqrt(d1 d2) / D50)^exponent; ground and tools count as of D50.",
      .source =
          "Barton & Kjaernsli, J. Geotech. Eng. Div. ASCE 107 (1981): shear strength of rockfill falls with "
          "size.",
      .parameters = {{.key = "exponent",
                      .unit = "",
                      .low = -3,
                      .high = 3,
                      .standard = -0.3,
                      .prior_low = -0.8,
                      .prior_high = 0.8,
                      .doc = "Of size in the sliding friction; below 0 the coarse slides more easily."}},
      .absent = 0,
      .experiments = {},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.contact.mu_exponent += v[0]; },
  };
}

}  // namespace scree
