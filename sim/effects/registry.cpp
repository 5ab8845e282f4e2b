#include "sim/effects/registry.h"

#include <algorithm>
#include <numbers>

namespace scree {

const std::vector<Effect>& all_effects() {
  static const std::vector<Effect> effects{
      cohesion(),        restitution(),     rolling_by_size(),  friction_by_size(), twisting(),
      weakening(),       ground_friction(), sticky_tools(),     undamped_flight(),  density_by_size(),
      missing_fines(),   release_speed(),   breakage(),         clumps(),           vibration(),
      detection_limit(), image_blur(),      image_shape_bias(), section_borders(),  surface_only(),
      own_reference(),
  };
  return effects;
}

const Effect* find_effect(std::string_view name) {
  const auto& all = all_effects();
  const auto at = std::find_if(all.begin(), all.end(), [&](const Effect& e) { return e.name == name; });
  return at == all.end() ? nullptr : &*at;
}

double EffectContext::surface_energy(double bond_number) const {
  // 2 pi gamma Rbar = Bo m g with Rbar = D50 / 4.
  const double weight = density * std::numbers::pi / 6 * d50 * d50 * d50 * gravity;
  return bond_number * weight / (2 * std::numbers::pi * 0.25 * d50);
}

Modifications modifications(std::span<const EffectUse> uses, const EffectContext& context) {
  Modifications model;
  model.contact.reference_diameter = context.d50;
  for (const EffectUse& use : uses)
    if (use.values.front() != use.effect->absent) use.effect->apply(use.values, context, model);
  return model;
}

}  // namespace scree
