#include "sim/effects/registry.h"

namespace scree {

Effect rolling_by_size() {
  return {
      .name = "rolling_by_size",
      .title = "rolling resistance that changes with size",
      .doc = "Small and large grains differ in shape, so that they do not roll alike.",
      .equation =
          "mu_r of a contact is times (sqrt(d1 d2) / D50)^exponent; ground and tools count as of D50.",
      .source =
          "Estrada, Azema, Radjai & Taboada, Phys. Rev. E 84 (2011): rolling resistance stands for shape; "
          "Wensrich & Katterfeld, Powder Technology 217 (2012).",
      .parameters = {{.key = "exponent",
                      .unit = "",
                      .low = -3,
                      .high = 3,
                      .standard = 0.5,
                      .prior_low = -1,
                      .prior_high = 1,
                      .doc = "Of size in the rolling resistance; above 0 the coarse rolls less."}},
      .absent = 0,
      .experiments = {},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.contact.mu_r_exponent += v[0]; },
  };
}

}  // namespace scree
