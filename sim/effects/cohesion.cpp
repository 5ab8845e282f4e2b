#include "sim/effects/registry.h"

namespace scree {

Effect cohesion() {
  return {
      .name = "cohesion",
      .title = "cohesion between grains",
      .doc = "Moist rock, or rock with clay on it, holds together where it touches.",
      .equation =
          "A closed contact pulls with F = 2 pi gamma Rbar; gamma is such that two grains of D50 pull each "
          "other with bond_number times their weight. Friction limits stay those of the spring force, F + "
          "Fn.",
      .source =
          "Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53 (1975) for the pull-off force; "
          "Israelachvili, Intermolecular and Surface Forces (2011), ch. 17, for water bridges (gamma up to "
          "0.15 J/m2).",
      .parameters = {{.key = "bond_number",
                      .unit = "",
                      .low = 0,
                      .high = 100,
                      .standard = 1,
                      .prior_low = 0,
                      .prior_high = 2,
                      .doc = "Pull of a contact of two grains of D50 over their weight."}},
      .absent = 0,
      .experiments = {},
      .apply = [](std::span<const double> v, const EffectContext& context,
                  Modifications& model) { model.contact.surface_energy += context.surface_energy(v[0]); },
  };
}

}  // namespace scree
