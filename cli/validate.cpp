#include <fmt/format.h>

#include "cli/commands.h"
#include "sim/scene/estimate.h"
#include "sim/scene/scenario.h"

int run_validate(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  const scree::ScenarioResult result = scree::load_scenario(file, overrides, asset_dir());
  for (const std::string& warning : result.warnings) fmt::print(stderr, "warning: {}\n", warning);
  for (const scree::ScenarioError& error : result.errors) fmt::print(stderr, "{}\n", error.text());
  if (!result.errors.empty()) return kBadInput;

  const scree::Scenario& scenario = result.scenario;
  const scree::Grading grading = scree::effective_model(scenario).grading;
  const double mass = scree::total_mass(scenario);
  const bool one_rock = std::holds_alternative<scree::DropTest>(scenario.experiment);
  std::string seeds;
  for (const auto seed : scenario.seeds) seeds += (seeds.empty() ? "" : ", ") + std::to_string(seed);
  std::string effects;
  for (const scree::EffectUse& use : scenario.effects)
    effects += fmt::format("{}{}", effects.empty() ? ", effects " : ", ", use.effect->name);
  fmt::print("{}: ok: {}, engine {}, grading {}, {:g} t, about {:.0f} spheres, seeds {}{}\n", file.string(),
             scree::experiment_type(scenario),
             scenario.engine == scree::EngineKind::rrlinear ? "rrlinear" : "impulse", grading.name(),
             mass / 1000, one_rock ? 1.0 : scree::estimated_spheres(grading, mass, scenario.material.density),
             seeds, effects);
  return 0;
}
