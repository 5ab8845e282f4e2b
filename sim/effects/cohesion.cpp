#include <fmt/format.h>

#include "sim/effects/registry.h"

namespace scree {

Effect cohesion() {
  return {
      .name = "cohesion",
      .title = "cohesion between grains",
      .doc =
          "Moist rock, or rock with clay on it, holds together where it touches. A bond number says how "
          "strong that is beside weight, not what holds: `scree validate` and `scree run` print gamma and "
          "the pull in newtons.",
      .equation =
          "A closed contact pulls with F = 2 pi gamma Rbar. gamma is the work of adhesion per area, twice "
          "the "
          "surface energy of each face; it is such that two grains of D50 pull each "
          "other with bond_number times their weight. Friction limits stay those of the spring force, F + "
          "Fn. With Rbar = D50 / 4 that is gamma = bond_number rho g D50^2 / 3: bond number 1 of rock of "
          "2760 kg/m3 is gamma = 0.009 J/m2 at D50 = 1 mm, 0.9 J/m2 at 10 mm, 23 J/m2 at 50 mm and 1750 "
          "J/m2 at 0.44 m. A bridge of water between two equal spheres that it wets pulls with 2 pi R sigma "
          "= 4 pi "
          "Rbar sigma, so that gamma is at most twice its surface tension, 0.15 J/m2: it gives bond number 1 "
          "up to 4 mm, 0.16 at 10 mm, 0.0065 at 50 mm and 0.00008 at 0.44 m. At the sizes of mine rock a "
          "bond number near 1 thus is no water bridge; it stands for a bond over an area, by clay or by "
          "suction in moist fines between the blocks. Its strength over the whole section of a grain would "
          "be 2/3 "
          "bond_number rho g D50: 8 kPa at 0.44 m, and 80 kPa if a tenth of the section is bonded.",
      .source =
          "Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53 (1975) for the pull-off force; "
          "Israelachvili, Intermolecular and Surface Forces (2011), ch. 17, for water bridges (gamma up to "
          "0.15 J/m2). "
          "The figures for sizes follow from the formulas, with sigma = 0.073 N/m and g = 9.81 m/s2.",
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
      .in_units =
          [](std::span<const double> v, const EffectContext& context) {
            return fmt::format(
                "gamma {:.4g} J/m2, two grains of {:.3g} m pull each other with {} their section",
                context.surface_energy(v[0]), context.d50, context.pull_in_words(v[0]));
          },
  };
}

}  // namespace scree
