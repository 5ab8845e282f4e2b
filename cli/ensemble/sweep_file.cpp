#include "cli/ensemble/sweep_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "analysis/results/results.h"
#include "cli/ensemble/design.h"
#include "cli/ensemble/file_reader.h"
#include "sim/scene/scenario_values.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostPoints = 100'000;

// These write the points of a design into the sweep.

void read_grid(const YamlNode& design, Sweep& sweep, FileReader& reader) {
  reader.allow(design, {"type", "parameters"}, " in a grid");
  const YamlNode* parameters =
      reader.map_at(design, "parameters", true, "a map from keys to lists of values");
  if (parameters == nullptr) return;
  std::vector<std::vector<std::string>> values;
  std::size_t count = 1;
  for (const YamlEntry& entry : parameters->entries) {
    sweep.parameters.push_back(entry.key);
    values.emplace_back();
    if (entry.value.kind != YamlKind::sequence || entry.value.items.empty()) {
      reader.fail(entry.value.place,
                  fmt::format("{}: a list of values is expected, found {}", entry.key, found(entry.value)));
      continue;
    }
    for (const YamlNode& item : entry.value.items) {
      const auto value = reader.scalar(item, entry.key);
      if (!value) continue;
      const auto is_same = [&](const std::string& other) { return same_value(other, *value); };
      if (std::any_of(values.back().begin(), values.back().end(), is_same))
        reader.fail(item.place, fmt::format("{}: {} stands twice", entry.key, *value));
      values.back().push_back(*value);
    }
    count *= std::max<std::size_t>(1, values.back().size());
    if (count > kMostPoints)
      return reader.fail(entry.key_place, fmt::format("more than {} points; that is no sweep", kMostPoints));
  }
  if (!reader.good()) return;
  std::vector<std::size_t> at(values.size(), 0);
  for (std::size_t n = 0; n < count; ++n) {
    SweepPoint point;
    for (std::size_t k = 0; k < values.size(); ++k) point.values.push_back(values[k][at[k]]);
    sweep.points.push_back(std::move(point));
    for (std::size_t k = values.size(); k-- > 0;) {  // the last parameter runs fastest
      if (++at[k] < values[k].size()) break;
      at[k] = 0;
    }
  }
}

void read_list(const YamlNode& design, Sweep& sweep, FileReader& reader) {
  reader.allow(design, {"type", "points"}, " in a list");
  const YamlNode* points = reader.list_at(design, "points", true, "a list of maps, - {material.mu: 0.2}");
  if (points == nullptr) return;
  for (const YamlNode& item : points->items) {
    if (item.kind != YamlKind::map || item.entries.empty()) {
      reader.fail(item.place, "points: a map of keys is expected, found " + found(item));
      continue;
    }
    if (sweep.parameters.empty())
      for (const YamlEntry& entry : item.entries) sweep.parameters.push_back(entry.key);
    SweepPoint point;
    for (const std::string& name : sweep.parameters) {
      const YamlEntry* entry = item.find(name);
      if (entry == nullptr)
        reader.fail(item.place, fmt::format("points: {} is missing; every point has the same keys", name));
      else if (const auto value = reader.scalar(entry->value, name))
        point.values.push_back(*value);
    }
    reader.allow(item, sweep.parameters, " in a point");
    const auto is_same = [&](const SweepPoint& other) {
      return std::equal(other.values.begin(), other.values.end(), point.values.begin(), point.values.end(),
                        same_value);
    };
    if (std::any_of(sweep.points.begin(), sweep.points.end(), is_same))
      reader.fail(item.place, "points: this one stands twice");
    sweep.points.push_back(std::move(point));
  }
}

void read_random(const YamlNode& design, bool is_sobol, Sweep& sweep, FileReader& reader) {
  if (is_sobol)  // whose sequence is always the same
    reader.allow(design, {"type", "parameters", "points"}, " in sobol");
  else
    reader.allow(design, {"type", "parameters", "points", "seed"}, " in latin_hypercube");
  const YamlNode* parameters =
      reader.map_at(design, "parameters", true, "a map from keys to {from: .., to: ..}");
  const YamlEntry *points = design.find("points"), *seed_entry = design.find("seed");
  if (points == nullptr) reader.fail(design.place, "'points' is missing: the number of points");
  if (parameters == nullptr || points == nullptr) return;
  const auto count = reader.whole(points->value, "points", 1, static_cast<double>(kMostPoints));
  std::uint64_t seed = 1;
  if (seed_entry != nullptr)
    seed = reader.whole(seed_entry->value, "seed", 0, FileReader::kLargestSeed).value_or(seed);
  const std::vector<FileReader::Span> spans = reader.spans(*parameters);
  for (const FileReader::Span& span : spans) sweep.parameters.push_back(span.key);
  if (!count || !reader.good()) return;
  const int n = static_cast<int>(*count), dimensions = static_cast<int>(spans.size());
  for (const auto& unit : is_sobol ? sobol(n, dimensions) : latin_hypercube(n, dimensions, seed)) {
    SweepPoint point;
    for (std::size_t k = 0; k < spans.size(); ++k)
      point.values.push_back(fmt::format("{:.6g}", spans[k].from + unit[k] * (spans[k].to - spans[k].from)));
    sweep.points.push_back(std::move(point));
  }
}

void read_design(const YamlNode& root, Sweep& sweep, FileReader& reader) {
  const YamlNode* design = reader.map_at(root, "design", true, "a map with a type");
  if (design == nullptr) return;
  const std::vector<std::string> types{"grid", "list", "latin_hypercube", "sobol"};
  const YamlEntry* type = design->find("type");
  const std::string name = type != nullptr && type->value.kind == YamlKind::scalar ? type->value.text : "";
  if (name == "grid") return read_grid(*design, sweep, reader);
  if (name == "list") return read_list(*design, sweep, reader);
  if (name == "latin_hypercube" || name == "sobol")
    return read_random(*design, name == "sobol", sweep, reader);
  reader.fail(type == nullptr ? design->place : type->value.place, "design.type: one of " + join(types));
}

// The case of printed values of every point: the text with its values for {key}.
void name_cases(const YamlEntry& entry, const fs::path& asset_dir, Sweep& sweep, FileReader& reader) {
  const auto pattern = reader.scalar(entry.value, "compare");
  if (!pattern) return;
  std::set<std::string> cases;
  for (const ReferenceValue& value : read_reference(asset_dir / "reference" / "results.csv"))
    cases.insert(value.case_name);
  for (SweepPoint& point : sweep.points) {
    point.compare = *pattern;
    for (std::size_t k = 0; k < sweep.parameters.size(); ++k) {
      const std::string key = "{" + sweep.parameters[k] + "}";
      for (std::size_t at = 0; (at = point.compare.find(key, at)) != std::string::npos;
           at += point.values[k].size())
        point.compare.replace(at, key.size(), point.values[k]);
    }
    if (!cases.contains(point.compare))
      return reader.fail(
          entry.value.place,
          fmt::format("compare: '{}' is no case in assets/reference/results.csv", point.compare));
  }
}

}  // namespace

bool same_value(const std::string& a, const std::string& b) {
  double x = 0, y = 0;
  return parse_number(a, x) == Parsed::yes && parse_number(b, y) == Parsed::yes ? x == y : a == b;
}

SweepResult load_sweep(const fs::path& file, const fs::path& asset_dir) {
  SweepResult result;
  Sweep& sweep = result.sweep;
  FileReader reader(result.errors);
  sweep.name = file.stem().string();
  const auto root = read_yaml(file, result.errors);
  if (!root) return result;
  reader.allow(*root, {"scenario", "seeds", "set", "ties", "compare", "design"}, "");
  read_design(*root, sweep, reader);
  const Variation variation = read_variation(*root, sweep.parameters, reader);
  const auto scenario = scenario_at(*root, file, true, reader);
  if (!reader.good()) return result;

  for (SweepPoint& point : sweep.points) {
    ScenarioResult loaded = load_scenario(*scenario, overrides_of(variation, sweep.parameters, point.values),
                                          asset_dir, ReadFor::numbers);
    point.scenario = std::move(loaded.scenario);
    for (std::string& warning : loaded.warnings)
      if (std::find(result.warnings.begin(), result.warnings.end(), warning) == result.warnings.end())
        result.warnings.push_back(std::move(warning));
    if (loaded.errors.empty()) continue;
    // Other points are wrong in the same way, most likely.
    for (const ScenarioError& error : loaded.errors)
      reader.fail(root->place, "a point is no scenario: " + error.text());
    return result;
  }
  if (const YamlEntry* compare = root->find("compare")) name_cases(*compare, asset_dir, sweep, reader);
  if (!reader.good()) return result;
  if (root->find("seeds") != nullptr)
    if (const YamlNode* list = reader.list_at(*root, "seeds", true, "a list of integers")) {
      const std::vector<std::uint64_t> seeds = reader.seeds(*list);
      for (SweepPoint& point : sweep.points) point.scenario.seeds = seeds;
    }
  return result;
}

SweepResult load_cases(const std::vector<fs::path>& files, int seeds, const fs::path& asset_dir) {
  SweepResult result;
  result.sweep.name = "cases";
  result.sweep.parameters = {"case"};
  for (const fs::path& file : files) {
    ScenarioResult loaded = load_scenario(file, {}, asset_dir, ReadFor::numbers);
    result.errors.insert(result.errors.end(), loaded.errors.begin(), loaded.errors.end());
    result.warnings.insert(result.warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
    auto& all = loaded.scenario.seeds;
    if (loaded.errors.empty() && seeds > 0 && static_cast<std::size_t>(seeds) > all.size())
      result.warnings.push_back(fmt::format("{}: {} seeds are asked for, its file has {}; those are taken",
                                            file.string(), seeds, all.size()));
    if (seeds > 0 && static_cast<std::size_t>(seeds) < all.size())
      all.resize(static_cast<std::size_t>(seeds));
    result.sweep.points.push_back({{file.stem().string()}, "", std::move(loaded.scenario)});
  }
  return result;
}

}  // namespace scree
