#include "sim/effects/registry.h"

namespace scree {

Effect surface_only() {
  return {
      .name = "surface_only",
      .title = "only the surface of a slope is seen",
      .doc = "A photograph of a slope shows its outermost grains, a cut or a sample its whole thickness.",
      .equation =
          "Seen along the normal of the slope (of the profile about y = 0; 37 degrees where that is too "
          "short "
          "to tell), a grain shows the part v of its outline that no other covers. The grading of a section "
          "is "
          "(1 - share) times that by mass of all its grains and share times that of mass times v; masses "
          "stay "
          "true. The rock as dumped is measured through and through.",
      .source =
          "Gradings of the thesis's slopes are those of photographs (chapter 3); Sanchidrián, Segarra, "
          "Ouchterlony & López, Rock Mech. Rock Eng. 42 (2009): images sample surfaces.",
      .parameters = {{.key = "share",
                      .unit = "",
                      .low = 0,
                      .high = 1,
                      .standard = 1,
                      .prior_low = 0,
                      .prior_high = 1,
                      .doc = "Of the surface in what is measured; 0: through and through, 1: nothing else."}},
      .absent = 0,
      .experiments = {"end_dump", "push_dump"},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.measurement.surface_share = v[0]; },
      .measures = true,
  };
}

}  // namespace scree
