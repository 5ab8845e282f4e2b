#pragma once
// The effects in words: `scree effects` prints them, docs/effects.md is made of them.
#include <string>

#include "sim/effects/effect.h"

namespace scree {

/// Names, amplitudes with their priors, and titles; a line each.
std::string effect_list();
/// Everything about one effect, as Markdown.
std::string effect_page(const Effect& effect);
/// docs/effects.md: all of them.
std::string effects_document();

}  // namespace scree
