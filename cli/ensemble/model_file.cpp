#include "cli/ensemble/model_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/diagnose/response_surface.h"
#include "cli/ensemble/output_scope.h"
#include "sim/effects/effect.h"
#include "sim/scene/scenario_read.h"
#include "sim/scene/scenario_values.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostParameters = 6;
constexpr double kNoRoundNumber = 0.1234567;  // a coordinate at which no parameter is a whole number

void read_parameters(const YamlNode& root, DiagnosisModel& model, FileReader& reader) {
  const YamlNode* map =
      reader.map_at(root, "parameters", true, "a map from keys to {nominal: .., from: .., to: ..}");
  if (map == nullptr) return;
  for (const YamlEntry& entry : map->entries) {
    const YamlNode& node = entry.value;
    const bool is_map = node.kind == YamlKind::map;
    const YamlEntry* nominal = is_map ? node.find("nominal") : nullptr;
    const YamlEntry* from = is_map ? node.find("from") : nullptr;
    const YamlEntry* to = is_map ? node.find("to") : nullptr;
    if (nominal == nullptr || from == nullptr || to == nullptr) {
      reader.fail(node.place, fmt::format("{}: {{nominal: .., from: .., to: ..}} is expected, found {}",
                                          entry.key, found(node)));
      continue;
    }
    reader.allow(node, {"nominal", "from", "to"}, " in " + entry.key);
    const auto n = reader.number(nominal->value, entry.key + ".nominal");
    const auto a = reader.number(from->value, entry.key + ".from");
    const auto b = reader.number(to->value, entry.key + ".to");
    if (!n || !a || !b) continue;
    if (!(*a < *b)) reader.fail(to->value.place, entry.key + ": 'to' must be above 'from'");
    if (!(*a <= *n && *n <= *b))
      reader.fail(nominal->value.place, entry.key + ": 'nominal' must lie between 'from' and 'to'");
    model.base.push_back({entry.key, *n, *a, *b});
  }
  if (map->entries.empty() || map->entries.size() > kMostParameters)
    reader.fail(map->place, fmt::format("parameters: 1 to {} are allowed", kMostParameters));
}

// Whether a parameter of this effect stands in the parameters, ties or set of the model.
bool is_given(const std::string& effect, const DiagnosisModel& model) {
  return std::any_of(model.places.begin(), model.places.end(),
                     [&](const auto& key) { return key.first.starts_with("effects." + effect + "."); });
}

void read_effects(const YamlNode& root, DiagnosisModel& model, FileReader& reader) {
  std::vector<std::string> all;
  for (const Effect& effect : all_effects()) all.emplace_back(effect.name);
  if (root.find("effects") == nullptr) {
    model.effects = all;
    return;
  }
  const YamlNode* list = reader.list_at(root, "effects", true, "a list of names");
  if (list == nullptr) return;
  for (const YamlNode& item : list->items) {
    const std::string name = reader.scalar(item, "effects").value_or("");
    if (find_effect(name) == nullptr)
      reader.fail(item.place, fmt::format("effects: no effect {}{}; there are {}", shown(name),
                                          suggestion(name, all), join(all)));
    else if (std::find(model.effects.begin(), model.effects.end(), name) != model.effects.end())
      reader.fail(item.place, fmt::format("effects: {} stands twice", name));
    else
      model.effects.push_back(name);
  }
}

void read_experiments(const YamlNode& root, const fs::path& file, const fs::path& asset_dir,
                      DiagnosisModel& model, FileReader& reader) {
  const YamlNode* map =
      reader.map_at(root, "experiments", false, "a map from names to {scenario: FILE, observables: [NAME]}");
  if (map == nullptr) return;
  for (const YamlEntry& entry : map->entries) {
    auto experiment =
        read_experiment(entry, file, asset_dir, {"scenario", "set", "observables", "errors"}, reader);
    if (!experiment) continue;
    ModelExperiment here{std::move(*experiment), {}, {}};
    if (const YamlNode* list =
            reader.list_at(entry.value, "observables", true, "a list of numbers that a run gives"))
      for (const YamlNode& item : list->items) {
        const std::string output = reader.scalar(item, "observables").value_or("");
        if (const std::string why = why_not_measured(here.experiment.scenario, output); !why.empty())
          reader.fail(item.place, fmt::format("observables: {}: {}", shown(output), why));
        else if (std::find(here.observables.begin(), here.observables.end(), output) !=
                 here.observables.end())
          reader.fail(item.place, fmt::format("observables: {} stands twice", output));
        else
          here.observables.push_back(output);
      }
    if (const YamlNode* errors =
            reader.map_at(entry.value, "errors", false, "a map from observables to numbers"))
      for (const YamlEntry& each : errors->entries) {
        const double error = reader.number(each.value, "errors." + each.key).value_or(1);
        if (std::find(here.observables.begin(), here.observables.end(), each.key) == here.observables.end())
          reader.fail(each.key_place, fmt::format("errors: {} is none of the observables", shown(each.key)));
        if (!(error > 0)) reader.fail(each.value.place, "errors: must be above 0 (a standard deviation)");
        here.errors[each.key] = error;
      }
    model.experiments.push_back(std::move(here));
  }
}

// Keys and values of parameters, ties and set that no scenario takes, and effects that are given and looked
// for. The maps themselves are read already.
class KeyCheck {
 public:
  KeyCheck(const YamlNode& root, const DiagnosisModel& model, const fs::path& asset_dir, FileReader& reader)
      : root_(root), model_(model), asset_dir_(asset_dir), reader_(reader) {}

  void run() {
    each_of("parameters", [&](const YamlEntry& entry) {
      bool good = true;
      for (const char* end : {"from", "to"})
        if (const YamlEntry* value = good ? entry.value.find(end) : nullptr)
          good = check("parameters", entry, entry.key + "=" + value->value.text, value->value.place);
      if (!good) bad_.push_back(entry.key);
    });
    each_of("ties", [&](const YamlEntry& entry) {
      if (std::find(bad_.begin(), bad_.end(), entry.value.text) != bad_.end()) return;
      for (const BaseAxis& leader : model_.base)
        if (leader.key == entry.value.text &&
            check("ties", entry, fmt::format("{}={}", entry.key, leader.from), entry.key_place))
          check("ties", entry, fmt::format("{}={}", entry.key, leader.to), entry.key_place);
    });
    each_of("set", [&](const YamlEntry& entry) {
      for (const std::string& fixed : model_.variation.fixed)
        if (fixed.starts_with(entry.key + "=")) check("set", entry, fixed, entry.value.place);
    });
  }

 private:
  template <class Check>
  void each_of(const char* map, Check check) {
    const YamlEntry* at = root_.find(map);
    if (at == nullptr) return;
    for (const YamlEntry& entry : at->value.entries) {
      check(entry);
      if (root_.find("effects") == nullptr) continue;  // those that are given are left out
      for (const std::string& effect : model_.effects)
        if (entry.key.starts_with("effects." + effect + "."))
          reader_.fail(entry.key_place, fmt::format("{}.{}: {} is looked for, too; leave it out of `effects`",
                                                    map, entry.key, effect));
    }
  }

  bool check(const char* map, const YamlEntry& entry, const std::string& set, const Place& place) {
    const std::string why = why_not_set(set, asset_dir_);
    if (!why.empty())
      reader_.fail(why.starts_with("unknown key") ? entry.key_place : place, fmt::format("{}: {}", map, why));
    return why.empty();
  }

  const YamlNode& root_;
  const DiagnosisModel& model_;
  const fs::path& asset_dir_;
  FileReader& reader_;
  std::vector<std::string> bad_;  // parameters
};

// Why the amplitudes of an effect would be wrong in these experiments: one of them has it already, or one
// that it does not go with. Empty: they would not.
std::string why_not_added(const Effect& effect, const std::vector<Dataset::Experiment>& experiments,
                          const std::vector<Scenario>& scenarios) {
  for (std::size_t e = 0; e < experiments.size(); ++e)
    for (const EffectUse& use : scenarios[e].effects) {
      if (use.values.front() == use.effect->absent) continue;
      if (use.effect == &effect) return fmt::format("experiment {} has it", experiments[e].name);
      if (use.effect->excludes == effect.name || effect.excludes == use.effect->name)
        return fmt::format("experiment {} has {}, with which it does not go", experiments[e].name,
                           use.effect->name);
    }
  return "";
}

}  // namespace

std::vector<ScenarioError> why_not_simulated(const DiagnosisModel& model,
                                             const Dataset::Experiment& experiment,
                                             const fs::path& asset_dir) {
  std::vector<ScenarioError> reasons;
  for (const double coordinate : {-1.0, 1.0, kNoRoundNumber}) {
    const ModelPoint point{
        Eigen::VectorXd::Constant(static_cast<Eigen::Index>(model.base.size()), coordinate), {}};
    const ScenarioResult loaded =
        load_scenario(experiment.file, overrides_at(model, {model.base, {}}, experiment, point), asset_dir,
                      ReadFor::numbers);
    for (const ScenarioError& error : loaded.errors) {
      std::string text = error.text();
      Place place = model.place;
      if (text.starts_with("--set ")) {  // a key of the model, or of the experiment
        text.erase(0, 6);
        if (const auto at = model.places.find(text.substr(0, text.find('='))); at != model.places.end())
          place = at->second;
      }
      report(reasons, place, fmt::format("experiment {}: {}", experiment.name, text));
    }
    if (!reasons.empty()) break;
  }
  return reasons;
}

DiagnosisModelResult load_model(const fs::path& file, const fs::path& asset_dir) {
  DiagnosisModelResult result;
  DiagnosisModel& model = result.model;
  FileReader reader(result.errors);
  model.name = file.stem().string();
  const auto root = read_yaml(file, result.errors);
  if (!root) return result;
  reader.allow(*root, {"title", "parameters", "ties", "set", "effects", "simulations", "experiments"}, "");
  if (const YamlEntry* title = root->find("title"))
    model.title = reader.scalar(title->value, "title").value_or("");
  if (model.title.empty()) model.title = model.name;
  read_parameters(*root, model, reader);
  std::vector<std::string> names;
  for (const BaseAxis& axis : model.base) names.push_back(axis.key);
  model.variation = read_variation(*root, names, reader);
  model.place = root->place;
  for (const char* map : {"parameters", "ties", "set"})
    if (const YamlEntry* at = root->find(map))
      for (const YamlEntry& entry : at->value.entries) model.places[entry.key] = entry.key_place;
  read_effects(*root, model, reader);
  if (reader.good()) KeyCheck(*root, model, asset_dir, reader).run();
  if (const YamlNode* counts = reader.map_at(*root, "simulations", false, "a map of numbers")) {
    SimulationCounts& n = model.simulations;
    reader.allow(*counts, {"nominal", "base", "effect", "check", "rounds"}, " in simulations");
    reader.integer(*counts, "nominal", 2, 1000, n.nominal);
    reader.integer(*counts, "base", ResponseSurface::least_base_runs(model.base.size()), 1000, n.base);
    reader.integer(*counts, "effect", 4, 1000, n.effect);
    reader.integer(*counts, "check", 2, 1000, n.check);
    reader.integer(*counts, "rounds", 1, 20, n.rounds);
  }
  model.simulations.base =
      std::max(model.simulations.base, ResponseSurface::least_base_runs(model.base.size()));
  read_experiments(*root, file, asset_dir, model, reader);
  if (!reader.good()) return result;
  for (const ModelExperiment& each : model.experiments)
    for (ScenarioError& reason : why_not_simulated(model, each.experiment, asset_dir))
      result.errors.push_back(std::move(reason));
  return result;
}

ModelSpace space_of(const DiagnosisModel& model, const std::vector<Dataset::Experiment>& experiments,
                    const std::vector<std::string>& without, const fs::path& asset_dir) {
  ModelSpace space{model.base, {}};
  const ModelPoint middle{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.base.size())), {}};
  std::vector<Scenario> scenarios;
  for (const Dataset::Experiment& experiment : experiments)
    scenarios.push_back(load_scenario(experiment.file, overrides_at(model, space, experiment, middle),
                                      asset_dir, ReadFor::numbers)
                            .scenario);
  for (const std::string& name : model.effects) {
    if (std::find(without.begin(), without.end(), name) != without.end()) continue;
    const Effect& effect = *find_effect(name);
    std::string why =
        is_given(name, model) ? "the model gives it" : why_not_added(effect, experiments, scenarios);
    std::vector<std::string> acts;
    for (std::size_t e = 0; e < experiments.size() && why.empty(); ++e)
      if (why_inert(effect, effect_scene(scenarios[e])).empty()) acts.push_back(experiments[e].name);
    if (why.empty() && acts.empty() && !experiments.empty())
      why = "changes nothing " + why_inert(effect, effect_scene(scenarios.front()));
    if (!why.empty()) space.left_out.push_back({name, std::move(why)});
    if (acts.empty()) continue;
    CandidateEffect candidate{name,
                              std::string(effect.title),
                              effect.absent,
                              {},
                              std::move(acts),
                              effect.measures,
                              std::string(effect.excludes)};
    for (const EffectParameter& p : effect.parameters)
      if (candidate.axes.empty() || p.prior_low < p.prior_high)
        candidate.axes.push_back(
            {fmt::format("effects.{}.{}", name, p.key), std::string(p.unit), p.prior_low, p.prior_high});
    space.effects.push_back(std::move(candidate));
  }
  return space;
}

std::vector<std::string> overrides_at(const DiagnosisModel& model, const ModelSpace& space,
                                      const Dataset::Experiment& experiment, const ModelPoint& point) {
  std::vector<std::string> overrides = experiment.overrides, names, values;
  for (std::size_t k = 0; k < model.base.size(); ++k) {
    names.push_back(model.base[k].key);
    values.push_back(fmt::format("{:.6g}", model.base[k].value(point.base[static_cast<Eigen::Index>(k)])));
  }
  for (std::string& each : overrides_of(model.variation, names, values)) overrides.push_back(std::move(each));
  for (const EffectAt& there : point.effects) {
    const CandidateEffect& effect = space.effects[there.effect];
    if (!effect.acts_in(experiment.name)) continue;
    for (std::size_t k = 0; k < effect.axes.size(); ++k)
      overrides.push_back(fmt::format("{}={:.6g}", effect.axes[k].key,
                                      effect.value(k, there.at[static_cast<Eigen::Index>(k)])));
  }
  return overrides;
}

}  // namespace scree
