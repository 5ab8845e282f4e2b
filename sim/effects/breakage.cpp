#include "sim/effects/registry.h"

namespace scree {

Effect breakage() {
  return {
      .name = "breakage",
      .title = "grains that break on impact",
      .doc = "Blocks that fall far or hit each other hard break, large ones sooner than small ones.",
      .equation =
          "A grain breaks when the energy that one of its contacts stores in it passes m (d / D50)^-exponent "
          "/ fragility: kn u^2 / 2 on a plane, half of that in a contact of two spheres, because the other, "
          "a "
          "fixed ball of a base layer too, is as soft. So a grain that hits a plane floor at v breaks from "
          "v^2 / 2 > (1 + alpha) (d / D50)^-exponent / fragility on, alpha the "
          "local damping (0.4), which takes its share on the way in. In its place stand four equal "
          "fragments, a quarter of its mass each, at the corners of a tetrahedron inside it, with its "
          "velocity and angular momentum; each grows by 1 % of its radius in 3 sqrt(m / kn), 3 to 4 cm/s at "
          "1 MPa, "
          "until their volumes add up to that of the grain. Fragments do not break while they "
          "grow, and grains whose fragments would be finer than the grading do not break. A load at rest "
          "counts like an impact; soft spheres (1 MPa) store more of it than rock does. The scatter of "
          "strength is left out. A trajectory has no rows for fragments: output.trajectory must be false.",
      .source =
          "Vogel & Peukert, Powder Technol. 129 (2003): breakage by energy per mass, of a strength that "
          "rises as size falls; Tavares & King, Int. J. Miner. Process. 54 (1998): fracture energies of "
          "single ore particles, some 10 to 1000 J/kg.",
      .parameters = {{.key = "fragility_kg_per_j",
                      .unit = "kg/J",
                      .low = 0,
                      .high = 10,
                      .standard = 0.02,
                      .prior_low = 0,
                      .prior_high = 0.1,
                      .doc = "One over the energy per mass that breaks a grain of D50."},
                     {.key = "exponent",
                      .unit = "",
                      .low = 0,
                      .high = 3,
                      .standard = 0.5,
                      .prior_low = 0.5,
                      .prior_high = 0.5,
                      .doc = "Of size in the strength."}},
      .absent = 0,
      .experiments = {},
      .apply =
          [](std::span<const double> v, const EffectContext& context, Modifications& model) {
            model.breakage = {v[0], v[1], context.d50, context.smallest};
          },
  };
}

}  // namespace scree
