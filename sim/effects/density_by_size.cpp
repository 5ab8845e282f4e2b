#include "sim/effects/registry.h"

namespace scree {

Effect density_by_size() {
  return {
      .name = "density_by_size",
      .title = "density that changes with size",
      .doc = "Ore minerals and pores break away: coarse and fine rock differ in density.",
      .equation =
          "Density of a grain is times (d / D50)^exponent. Payload and grading, both by mass, stay what they "
          "are: "
          "there are fewer of the denser sizes.",
      .source =
          "Small in the rock of the thesis (Qiu, Polytechnique Montreal, tables A.1 and A.2): specific "
          "gravity 2.732 of oven-dry rock of 5 to 50 mm (ASTM C127, pores counted), 2.756 below 5 mm (ASTM "
          "D854), 0.9 % more. The prior is for rock of several minerals.",
      .parameters = {{.key = "exponent",
                      .unit = "",
                      .low = -0.5,
                      .high = 0.5,
                      .standard = 0.1,
                      .prior_low = -0.2,
                      .prior_high = 0.2,
                      .doc = "Of size in the density."}},
      .absent = 0,
      .experiments = {},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.density_exponent += v[0]; },
  };
}

}  // namespace scree
