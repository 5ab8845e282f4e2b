#include "sim/effects/describe.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace scree {
namespace {

constexpr const char* kHead = R"(# Effects

Named pieces of physics, or of the measurement, that the base model lacks. A scenario switches one on under `effects:`,

    effects:
      cohesion: {bond_number: 0.5}

or a run with `--set effects.cohesion.bond_number=0.5`. Parameters that are left out have their standard value. At the amplitude that
means absent (the first parameter; 0, or 1 for a factor) a run gives the same numbers as without the effect, bit by bit.

Each is a file in `sim/effects/` and a line in its registry; tests hold each against a formula where there is one (`tests/verification/`,
`tests/scene/`). Effects on the motion need the engine rrlinear.
D50 is that of the scenario's grading, or the size that `effects.reference.diameter_m` gives, so that an effect means the same in rock of
several gradings. The prior is the range in which a diagnosis looks. The pictures show real runs of three seeds, made by
`docs/pictures/effects/make.sh`: heaps of 15 kg of laboratory rock, or a load of 20 t over a bench of 4 m in three sections. They show what
those piles show, no law; what restitution, twisting, weakening, vibration and undamped_flight do there is not beyond the scatter of seeds.
Clumps are drawn at mu_r 0.05, restitution at local damping 0.2.

This page is what `scree effects --document` prints.
)";

std::string with_unit(std::string text, std::string_view unit) {
  return unit.empty() ? text : fmt::format("{} {}", text, unit);
}

std::string range(double low, double high, std::string_view unit) {
  if (low == high) return with_unit(fmt::format("{:g}, fixed", low), unit);
  return with_unit(fmt::format("{:g} to {:g}", low, high), unit);
}

}  // namespace

std::string effect_list() {
  std::string text = fmt::format("{:<18} {:<20} {:>13}  {}\n", "effect", "amplitude", "prior", "what it is");
  for (const Effect& effect : all_effects()) {
    const EffectParameter& amplitude = effect.parameters.front();
    text += fmt::format("{:<18} {:<20} {:>13}  {}{}\n", effect.name, amplitude.key,
                        fmt::format("{:g} to {:g}", amplitude.prior_low, amplitude.prior_high), effect.title,
                        effect.measures ? " (measurement)" : "");
  }
  return text;
}

std::string effect_page(const Effect& effect) {
  std::string text =
      fmt::format("## {}: {}\n\n{}\n\n{}\n\n", effect.name, effect.title, effect.doc, effect.equation);
  text += "| parameter | what it is | allowed | standard | prior |\n|---|---|---|---|---|\n";
  for (const EffectParameter& p : effect.parameters)
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", p.key, p.doc, range(p.low, p.high, p.unit),
                        with_unit(fmt::format("{:g}", p.standard), p.unit),
                        range(p.prior_low, p.prior_high, p.unit));
  text += fmt::format(
      "\nAbsent at `{}: {:g}`. Acts on {}, in {}{}.\n\nSource: {}\n", effect.parameters.front().key,
      effect.absent, effect.measures ? "what is analysed, not on the motion" : "the motion",
      effect.experiments.empty() ? std::string("all experiments")
                                 : fmt::format("experiments of type {}", fmt::join(effect.experiments, ", ")),
      effect.needs ? fmt::format(" with {}", effect.needs->words) : "", effect.source);
  return text;
}

std::string effects_document() {
  std::string text = kHead;
  for (const Effect& effect : all_effects())
    text += fmt::format("\n{0}\n![What {1} changes](pictures/effects/{1}.svg)\n", effect_page(effect),
                        effect.name);
  return text;
}

}  // namespace scree
