#include "sim/effects/registry.h"

namespace scree {

Effect image_blur() {
  return {
      .name = "image_blur",
      .title = "diameters smeared by image analysis",
      .doc = "Image analysis splits large grains, merges small ones, and sees each from one side.",
      .equation =
          "The mass of a grain is spread over diameters with a normal distribution of ln d about its own, "
          "standard deviation width. Mean log d stays; curves, and the diameters read from them, become "
          "wider, and with the spread of the rock "
          "as dumped, which is measured likewise, chi becomes smaller.",
      .source =
          "Maerz & Zhou, Fragblast 2 (1998): fusion and disintegration of grains in images; Sanchidrián et "
          "al., Rock Mech. Rock Eng. 42 (2009): errors of some 30 % in the coarse part.",
      .parameters = {{.key = "width",
                      .unit = "",
                      .low = 0,
                      .high = 2,
                      .standard = 0.3,
                      .prior_low = 0,
                      .prior_high = 0.8,
                      .doc = "Standard deviation of ln d."}},
      .absent = 0,
      .experiments = {"end_dump", "push_dump", "repose_lift", "bucket_dump"},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.measurement.blur = v[0]; },
      .measures = true,
  };
}

}  // namespace scree
