#include "sim/effects/registry.h"

namespace scree {

Effect detection_limit() {
  return {
      .name = "detection_limit",
      .title = "small grains that images miss",
      .doc = "Image analysis does not see grains of a few pixels, or those behind others.",
      .equation =
          "Of the mass of grains of diameter d the share 1 / (1 + (ratio D50 / d)^steepness) is counted: "
          "half "
          "at the limit, a smooth step. It acts on the gradings of sections, rings and cells and on the rock "
          "as dumped, which is measured likewise; masses and angles stay true.",
      .source =
          "Sanchidrián, Segarra, Ouchterlony & López, Rock Mech. Rock Eng. 42 (2009): image analysis of rock "
          "fragmentation fails in the fines.",
      .parameters = {{.key = "ratio",
                      .unit = "",
                      .low = 0,
                      .high = 2,
                      .standard = 0.3,
                      .prior_low = 0,
                      .prior_high = 0.6,
                      .doc = "Diameter of which half is counted, over D50 of the grading."},
                     {.key = "steepness",
                      .unit = "",
                      .low = 1,
                      .high = 50,
                      .standard = 6,
                      .prior_low = 6,
                      .prior_high = 6,
                      .doc = "Of the step; at 6 a grain of half the limit is counted to 1.5 %, at 50 the "
                             "limit is sharp."}},
      .absent = 0,
      .experiments = {"end_dump", "push_dump", "repose_lift", "bucket_dump"},
      .apply =
          [](std::span<const double> v, const EffectContext& context, Modifications& model) {
            model.measurement.detection_limit = v[0] * context.d50;
            model.measurement.detection_steepness = v[1];
          },
      .measures = true,
  };
}

}  // namespace scree
