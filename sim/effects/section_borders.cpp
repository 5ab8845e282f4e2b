#include "sim/effects/registry.h"

namespace scree {

Effect section_borders() {
  return {
      .name = "section_borders",
      .title = "sections cut at other places",
      .doc = "Borders between sections are drawn on photographs or dug by hand, not where they should be.",
      .equation =
          "All borders between sections of a slope, cells of a half cone and rings of a heap lie shift times "
          "a section's length further down the slope; crest and toe stay. Of a slope with the same mass "
          "everywhere the first of n sections gets (1 + shift) / n, the last (1 - shift) / n.",
      .source = "Sections of the thesis are drawn on photographs of slopes (chapters 3 and 5).",
      .parameters = {{.key = "shift",
                      .unit = "",
                      .low = -0.9,
                      .high = 0.9,
                      .standard = 0.2,
                      .prior_low = -0.4,
                      .prior_high = 0.4,
                      .doc = "Down the slope, over the length of a section; negative: up."}},
      .absent = 0,
      .experiments = {"end_dump", "push_dump", "repose_lift", "bucket_dump"},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.measurement.border_shift = v[0]; },
      .measures = true,
  };
}

}  // namespace scree
