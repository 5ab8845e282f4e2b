#include "cli/ensemble/dataset_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/ensemble/dataset_bounds.h"
#include "cli/ensemble/dataset_tables.h"
#include "cli/ensemble/file_reader.h"
#include "sim/scene/scenario_values.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

std::string text_at(const YamlNode& root, const char* key, FileReader& reader) {
  const YamlEntry* entry = root.find(key);
  return entry == nullptr ? std::string() : reader.scalar(entry->value, key).value_or("");
}

void read_experiments(const YamlNode& root, const fs::path& file, const fs::path& asset_dir, Dataset& dataset,
                      FileReader& reader) {
  const YamlNode* experiments =
      reader.map_at(root, "experiments", true, "a map from names to {scenario: FILE, set: {KEY: VALUE}}");
  if (experiments == nullptr) return;
  for (const YamlEntry& entry : experiments->entries)
    if (auto experiment = read_experiment(entry, file, asset_dir, {"scenario", "set"}, reader))
      dataset.experiments.push_back(std::move(*experiment));
}

// The table named at a key, relative to the file that names it.
std::optional<fs::path> table_at(const YamlNode& root, const char* key, bool required, const fs::path& file,
                                 FileReader& reader) {
  const YamlEntry* entry = root.find(key);
  if (entry == nullptr) {
    if (required)
      reader.fail(root.place, fmt::format("'{}' is missing: the table of what was measured", key));
    return std::nullopt;
  }
  const auto name = reader.scalar(entry->value, key);
  if (!name) return std::nullopt;
  const fs::path path = (file.parent_path() / *name).lexically_normal();
  std::error_code none;
  if (fs::is_regular_file(path, none)) return path;
  reader.fail(entry->value.place, fmt::format("{}: no file {}", key, shown(path.string())));
  return std::nullopt;
}

std::optional<double> default_uncertainty(const YamlNode& root, FileReader& reader) {
  const YamlEntry* entry = root.find("default_relative_uncertainty");
  if (entry == nullptr) return std::nullopt;
  const auto value = reader.number(entry->value, entry->key);
  if (value && !(*value > 0 && *value <= 1))
    reader.fail(entry->value.place,
                "default_relative_uncertainty: must be above 0 and at most 1 (10 % is 0.1)");
  return value;
}

}  // namespace

std::optional<Dataset::Experiment> read_experiment(const YamlEntry& entry, const fs::path& file,
                                                   const fs::path& asset_dir,
                                                   const std::vector<std::string>& allowed,
                                                   FileReader& reader) {
  if (entry.key.empty() || entry.key.find_first_of("/,;\"") != std::string::npos)
    reader.fail(entry.key_place,
                fmt::format("experiments: the name {} must be a word without / , ; \"", shown(entry.key)));
  if (entry.value.kind != YamlKind::map) {
    reader.fail(entry.value.place, fmt::format("experiments.{}: a map with a scenario is expected, found {}",
                                               entry.key, found(entry.value)));
    return std::nullopt;
  }
  reader.allow(entry.value, allowed, " in experiment " + entry.key);
  const auto scenario = scenario_at(entry.value, file, true, reader);
  const Variation variation = read_variation(entry.value, {}, reader);
  if (!scenario) return std::nullopt;
  ScenarioResult loaded = load_scenario(*scenario, variation.fixed, asset_dir, ReadFor::numbers);
  for (const ScenarioError& error : loaded.errors)
    reader.fail(entry.value.place, fmt::format("experiments.{} is no scenario: {}", entry.key, error.text()));
  if (!loaded.errors.empty()) return std::nullopt;
  return Dataset::Experiment{entry.key, *scenario, variation.fixed, std::move(loaded.scenario)};
}

DatasetResult load_dataset(const fs::path& file, const fs::path& asset_dir) {
  DatasetResult result;
  FileReader reader(result.errors);
  const auto root = read_yaml(file, result.errors);
  if (!root) return result;
  Dataset dataset;
  dataset.name = file.stem().string();
  if (const fs::path folder = fs::absolute(file).parent_path(); dataset.name == "dataset")
    dataset.name = folder.filename().string();
  reader.allow(
      *root, {"title", "source", "experiments", "observables", "covariance", "default_relative_uncertainty"},
      "");
  dataset.title = text_at(*root, "title", reader);
  if (dataset.title.empty()) dataset.title = dataset.name;
  dataset.source = text_at(*root, "source", reader);
  read_experiments(*root, file, asset_dir, dataset, reader);
  const auto table = table_at(*root, "observables", true, file, reader);
  const auto covariance = table_at(*root, "covariance", false, file, reader);
  const auto relative = default_uncertainty(*root, reader);
  if (!reader.good() || !table) return result;

  std::vector<double> factors;
  read_observables(*table, dataset, factors, result.errors);
  if (reader.good() && covariance) read_covariance(*covariance, factors, dataset, result.errors);
  if (reader.good()) complete_uncertainties(*table, relative, dataset, result.errors);
  if (reader.good()) check_bounds(*table, dataset, result.errors);
  if (reader.good()) result.dataset = std::move(dataset);
  return result;
}

}  // namespace scree
