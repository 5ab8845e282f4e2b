#include "sim/effects/registry.h"

namespace scree {

Effect own_reference() {
  return {
      .name = "own_reference",
      .title = "measured against the pile itself",
      .doc =
          "Where the rock as dumped was not measured, sections are compared with the whole of what was "
          "measured of the pile.",
      .equation =
          "chi, relative diameters and relative conductivities refer to a grading that is (1 - share) times "
          "that of the rock as dumped and share times that of all sections, cells or rings, measured as if "
          "they were one.",
      .source = "chi of the thesis's photographs refers to the grading of each whole slope (table C.7).",
      .parameters = {{.key = "share",
                      .unit = "",
                      .low = 0,
                      .high = 1,
                      .standard = 1,
                      .prior_low = 0,
                      .prior_high = 1,
                      .doc = "Of the pile in the reference; 0: the rock as dumped, 1: the pile alone."}},
      .absent = 0,
      .experiments = {"end_dump", "push_dump", "repose_lift", "bucket_dump"},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.measurement.own_reference = v[0]; },
      .measures = true,
  };
}

}  // namespace scree
