#include "sim/effects/registry.h"

#include <fmt/format.h>

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
  return bond_number * weight() / (2 * std::numbers::pi * 0.25 * d50);
}

double EffectContext::weight() const {
  return density * std::numbers::pi / 6 * d50 * d50 * d50 * gravity;
}

std::string EffectContext::pull_in_words(double bond_number) const {
  const double force = bond_number * weight();
  return fmt::format("{:.4g} N, or {:.3g} kPa over", force,
                     force / (std::numbers::pi / 4 * d50 * d50) / 1000);
}

std::string why_inert(const Effect& effect, const EffectScene& scene) {
  const auto& types = effect.experiments;
  if (!types.empty() && std::find(types.begin(), types.end(), scene.experiment) == types.end())
    return fmt::format("in an experiment of type {}", scene.experiment);
  if (effect.needs && !(scene.*effect.needs->given)) return fmt::format("without {}", effect.needs->words);
  return "";
}

std::string effect_in_words(const EffectUse& use, const EffectContext& context) {
  std::string text;
  for (std::size_t k = 0; k < use.values.size(); ++k)
    text += fmt::format("{}{} {:g}", k == 0 ? fmt::format("{}: ", use.effect->name) : ", ",
                        use.effect->parameters[k].key, use.values[k]);
  if (use.effect->in_units != nullptr && use.values.front() != use.effect->absent)
    text += "; " + use.effect->in_units(use.values, context);
  return text;
}

Modifications modifications(std::span<const EffectUse> uses, const EffectContext& context) {
  Modifications model;
  model.contact.reference_diameter = context.d50;
  for (const EffectUse& use : uses)
    if (use.values.front() != use.effect->absent) use.effect->apply(use.values, context, model);
  return model;
}

}  // namespace scree
