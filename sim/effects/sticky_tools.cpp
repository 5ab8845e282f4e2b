#include <fmt/format.h>

#include "sim/effects/registry.h"

namespace scree {

Effect sticky_tools() {
  return {
      .name = "sticky_tools",
      .title = "rock that sticks to bed, blade or bucket",
      .doc =
          "Wet fines make a truck bed, blade or bucket sticky: the load leaves late, and what is still in a "
          "bed or bucket when it has moved off is carried back; it is not in the pile "
          "(carried_back_t).",
      .equation =
          "Contacts with beds, blades, buckets and other tools pull with F = 2 pi gamma R; gamma is such "
          "that a grain of D50 is pulled with bond_number times its weight: gamma = bond_number rho "
          "g D50^2 / 6. For the size of rock at which that may be water, and what it stands for above, see "
          "cohesion.",
      .source = "Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53 (1975) for the pull-off force.",
      .parameters = {{.key = "bond_number",
                      .unit = "",
                      .low = 0,
                      .high = 100,
                      .standard = 1,
                      .prior_low = 0,
                      .prior_high = 3,
                      .doc = "Pull of a tool on a grain of D50 over its weight."}},
      .absent = 0,
      .experiments = {"end_dump", "push_dump", "repose_lift", "bucket_dump"},
      .apply =
          [](std::span<const double> v, const EffectContext& context, Modifications& model) {
            // A grain on a plane has Rbar = R = D50 / 2, twice that of a pair.
            model.tool_surface_energy += 0.5 * context.surface_energy(v[0]);
          },
      .in_units =
          [](std::span<const double> v, const EffectContext& context) {
            return fmt::format("gamma {:.4g} J/m2, a tool pulls a grain of {:.3g} m with {} its section",
                               0.5 * context.surface_energy(v[0]), context.d50, context.pull_in_words(v[0]));
          },
  };
}

}  // namespace scree
