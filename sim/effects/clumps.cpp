#include "sim/effects/registry.h"

namespace scree {

Effect clumps() {
  return {
      .name = "clumps",
      .title = "grains longer than thick",
      .doc =
          "Broken rock is longer in one direction than in the others: its grains interlock, and lie on a "
          "face "
          "where a ball would roll.",
      .equation =
          "A grain of diameter d is a rigid clump of two equal spheres whose middles lie elongation of their "
          "diameter apart; the two together fill the grain's volume: their diameter is d (1 + 1.5 e - 0.5 "
          "e^3)^(-1/3). It is of one density: its moments of inertia are those of the two spheres' union. "
          "Contacts are those of the spheres, with their radius in "
          "stiffness and rolling limit; a grain that another touches with both of its spheres has two "
          "contacts "
          "for one. The middle moves by the sum of the forces, the grain turns by the moment about its "
          "middle "
          "(angular momentum in world axes), and local damping acts on both. Loads begin with axes in all "
          "directions. A pile is analysed as spheres of the grains' volumes at their middles. mu_r, which "
          "stands "
          "for the shape of grains, acts as well: lower it.",
      .source =
          "Favier et al., Eng. Comput. 16 (1999): grains of overlapping spheres; Wensrich & Katterfeld, "
          "Powder "
          "Technol. 217 (2012): clumps beside rolling friction.",
      .parameters = {{.key = "elongation",
                      .unit = "",
                      .low = 0,
                      .high = 1,
                      .standard = 0.5,
                      .prior_low = 0,
                      .prior_high = 0.8,
                      .doc = "Length of a grain over its thickness, less 1."}},
      .absent = 0,
      .experiments = {"end_dump", "push_dump", "repose_lift", "bucket_dump"},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.clumps.elongation = v[0]; },
      .excludes = "breakage",
  };
}

}  // namespace scree
