#include "cli/ensemble/study_file.h"

#include <fmt/format.h>

#include "analysis/cases/study.h"
#include "cli/ensemble/file_reader.h"
#include "sim/scene/scenario_read.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr double kHour = 3600;  // s

// What an option costs a tonne; none without any rate.
std::optional<double> cost(const Scenario& scenario, std::optional<double> per_load,
                           std::optional<double> per_hour) {
  if (!per_load && !per_hour) return std::nullopt;
  double tonnes = 0, hours = 0;
  if (const auto* dump = std::get_if<EndDump>(&scenario.experiment)) tonnes = dump->payload / 1000;
  if (const auto* push = std::get_if<PushDump>(&scenario.experiment)) {
    tonnes = push->payload / 1000;
    hours = (push->load_box.x() + push->distance + push->blade.overshoot) / push->blade.velocity / kHour;
  }
  return (per_load.value_or(0) + per_hour.value_or(0) * hours) / tonnes;
}

double tonnes_per_load(const Scenario& scenario) {
  if (const auto* dump = std::get_if<EndDump>(&scenario.experiment)) return dump->payload / 1000;
  if (const auto* push = std::get_if<PushDump>(&scenario.experiment)) return push->payload / 1000;
  return 0;
}

std::optional<double> rate(const YamlNode& option, const char* key, FileReader& reader) {
  const YamlEntry* entry = option.find(key);
  if (entry == nullptr) return std::nullopt;
  const auto value = reader.number(entry->value, key);
  if (value && *value < 0) reader.fail(entry->value.place, fmt::format("{}: must not be below 0", key));
  return value;
}

void read_option(const YamlNode& option, const fs::path& file, const fs::path& asset_dir,
                 const std::vector<std::uint64_t>& seeds, Study& study, FileReader& reader) {
  reader.allow(option, {"name", "scenario", "set", "cost_per_load", "blade_per_hour"}, " in an option");
  const YamlEntry* name = option.find("name");
  if (name == nullptr) return reader.fail(option.place, "options: name is missing");
  const std::string text = reader.scalar(name->value, "name").value_or("");
  for (const SweepPoint& point : study.sweep.points)
    if (point.values.front() == text)
      reader.fail(name->value.place, fmt::format("name: '{}' is there twice", text));
  const auto scenario = scenario_at(option, file, true, reader);
  const Variation variation = read_variation(option, {}, reader);
  const auto per_load = rate(option, "cost_per_load", reader),
             per_hour = rate(option, "blade_per_hour", reader);
  if (!scenario || !reader.good()) return;
  ScenarioResult loaded = load_scenario(*scenario, variation.fixed, asset_dir, ReadFor::numbers);
  for (const ScenarioError& error : loaded.errors)
    reader.fail(option.place, "an option is no scenario: " + error.text());
  if (!loaded.errors.empty()) return;
  if (bench_of(loaded.scenario) == nullptr)
    return reader.fail(option.place, "options: dumps over a bench are compared; this scenario has none");
  if (per_hour && !std::holds_alternative<PushDump>(loaded.scenario.experiment))
    return reader.fail(option.place, "blade_per_hour: this scenario pushes nothing");
  if (!seeds.empty()) loaded.scenario.seeds = seeds;
  study.options.push_back({tonnes_per_load(loaded.scenario), cost(loaded.scenario, per_load, per_hour)});
  study.sweep.points.push_back({{text}, "", std::move(loaded.scenario)});
}

// "end dumping 10, push dumping 20" of a number, if options differ in it.
template <class Number>
std::string differences(const Study& study, const Number& number) {
  std::string text;
  bool differ = false;
  for (const SweepPoint& point : study.sweep.points) {
    differ = differ || number(point.scenario) != number(study.sweep.points.front().scenario);
    text += fmt::format("{}{} {:g}", text.empty() ? "" : ", ", point.values.front(), number(point.scenario));
  }
  return differ ? text : "";
}

std::vector<std::string> warnings_of(const Study& study) {
  std::vector<std::string> warnings;
  for (const SweepPoint& point : study.sweep.points)
    if (point.scenario.seeds.size() < 2)
      warnings.push_back(
          fmt::format("option '{}': not ranked: of one seed the scatter is not known; give seeds: [1, 2, 3]",
                      point.values.front()));
  if (const std::string each =
          differences(study, [](const Scenario& s) { return static_cast<double>(s.output.sections); });
      !each.empty())
    warnings.push_back("options differ in output.sections, and their numbers are not alike: " + each);
  if (const std::string each = differences(study, [](const Scenario& s) { return bench_of(s)->height; });
      !each.empty())
    warnings.push_back("options differ in the height of the bench (m), and their numbers are not alike: " +
                       each);
  return warnings;
}

}  // namespace

StudyResult load_study(const fs::path& file, const fs::path& asset_dir) {
  StudyResult result;
  Study& study = result.study;
  FileReader reader(result.errors);
  study.sweep.name = file.stem().string();
  study.sweep.parameters = {"option"};
  const auto root = read_yaml(file, result.errors);
  if (!root) return result;
  reader.allow(*root, {"seeds", "rank_by", "currency", "options"}, "");
  std::vector<std::uint64_t> seeds;
  if (root->find("seeds") != nullptr)
    if (const YamlNode* list = reader.list_at(*root, "seeds", true, "a list of integers"))
      seeds = reader.seeds(*list);
  if (const YamlEntry* entry = root->find("currency"))
    study.currency = reader.scalar(entry->value, "currency").value_or("");
  if (const YamlEntry* entry = root->find("rank_by")) {
    study.rank_by = reader.scalar(entry->value, "rank_by").value_or("");
    if (study_criterion(study.rank_by) == nullptr) {
      std::string names;
      for (const StudyCriterion& each : study_criteria())
        names += fmt::format("{}{}", names.empty() ? "" : ", ", each.name);
      reader.fail(entry->value.place, fmt::format("rank_by: '{}' is none of {}", study.rank_by, names));
    }
  }
  if (const YamlNode* options = reader.list_at(*root, "options", true, "a list of maps"))
    for (const YamlNode& option : options->items) {
      if (option.kind != YamlKind::map)
        reader.fail(option.place, "options: a map with name and scenario is expected");
      else
        read_option(option, file, asset_dir, seeds, study, reader);
    }
  if (reader.good() && study.options.size() < 2) reader.fail(root->place, "options: at least two are needed");
  if (reader.good()) result.warnings = warnings_of(study);
  return result;
}

}  // namespace scree
