#include "sim/effects/registry.h"

namespace scree {

Effect twisting() {
  return {
      .name = "twisting",
      .title = "resistance against twisting",
      .doc =
          "Rough or flat faces in contact resist turning about their common normal; spheres of the base "
          "model do not.",
      .equation = "A moment about the normal, Mt += kr times the relative turn, |Mt| <= mu_t Rbar Fn.",
      .source =
          "Jiang, Shen & Wang, Computers and Geotechnics 65 (2015); Marshall, J. Comput. Phys. 228 (2009).",
      .parameters = {{.key = "mu_t",
                      .unit = "",
                      .low = 0,
                      .high = 5,
                      .standard = 0.3,
                      .prior_low = 0,
                      .prior_high = 0.8,
                      .doc = "Twisting resistance coefficient."}},
      .absent = 0,
      .experiments = {},
      .apply = [](std::span<const double> v, const EffectContext&,
                  Modifications& model) { model.contact.mu_t += v[0]; },
  };
}

}  // namespace scree
