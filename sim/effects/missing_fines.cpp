#include "sim/effects/registry.h"

namespace scree {

Effect missing_fines() {
  return {
      .name = "missing_fines",
      .title = "fines that the model leaves out",
      .doc = "The grading of a simulation is cut off below some size; the rock goes on below.",
      .equation =
          "share of the mass lies between the smallest diameter of the grading and that over ratio, evenly "
          "in log d; the rest keeps its curve.",
      .source = "Cut-offs of the thesis's models: 8 mm in the laboratory, 0.1 m in the field.",
      .parameters = {{.key = "share",
                      .unit = "",
                      .low = 0,
                      .high = 0.6,
                      .standard = 0.1,
                      .prior_low = 0,
                      .prior_high = 0.25,
                      .doc = "Share of the mass that is finer than the grading."},
                     {.key = "ratio",
                      .unit = "",
                      .low = 1.05,
                      .high = 10,
                      .standard = 2,
                      .prior_low = 2,
                      .prior_high = 2,
                      .doc = "Smallest diameter of the grading over that of the fines; the number of grains "
                             "grows with its cube."}},
      .absent = 0,
      .experiments = {"end_dump", "push_dump", "repose_lift", "bucket_dump"},
      .apply =
          [](std::span<const double> v, const EffectContext&, Modifications& model) {
            model.fines_share = v[0];
            model.fines_ratio = v[1];
          },
  };
}

}  // namespace scree
