#include "sim/effects/registry.h"

namespace scree {

Effect image_shape_bias() {
  return {
      .name = "image_shape_bias",
      .title = "diameters from images that are off with size",
      .doc = "An image shows a grain's outline, not its sieve size, and how they differ changes with size.",
      .equation =
          "A grain is counted with d (d / D50)^exponent, in the rock as dumped likewise: diameters over "
          "those "
          "of the rock as dumped are raised to the power 1 + exponent. Chi, a ratio of differences of log d, "
          "does not notice it, and neither notices a factor that is the same for all sizes.",
      .source =
          "Maerz & Zhou, Fragblast 2 (1998): errors of unfolding two dimensions into three; Latham et al., "
          "Fragblast 7 (2003), of four image systems on the same piles.",
      .parameters = {{.key = "exponent",
                      .unit = "",
                      .low = -0.9,
                      .high = 2,
                      .standard = 0.2,
                      .prior_low = -0.4,
                      .prior_high = 0.4,
                      .doc = "Of size in the ratio of measured to true diameter."}},
      .absent = 0,
      .experiments = {"end_dump", "push_dump", "repose_lift", "bucket_dump"},
      .apply =
          [](std::span<const double> v, const EffectContext& context, Modifications& model) {
            model.measurement.bias_exponent = v[0];
            model.measurement.reference_diameter = context.d50;
          },
      .measures = true,
  };
}

}  // namespace scree
