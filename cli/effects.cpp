// scree effects: what effects there are, or everything about one.
#include <fmt/format.h>

#include "cli/commands.h"
#include "sim/effects/describe.h"

int run_effects(const EffectsOptions& options) {
  if (options.document) {
    fmt::print("{}", scree::effects_document());
    return kOk;
  }
  if (options.name.empty()) {
    fmt::print("{}", scree::effect_list());
    return kOk;
  }
  const scree::Effect* effect = scree::find_effect(options.name);
  if (effect == nullptr) {
    std::string names;
    for (const scree::Effect& known : scree::all_effects())
      names += fmt::format("{}{}", names.empty() ? "" : ", ", known.name);
    fmt::print(stderr, "scree: effects {}: no such effect; there are {}\n", options.name, names);
    return kBadInput;
  }
  fmt::print("{}", scree::effect_page(*effect));
  return kOk;
}
