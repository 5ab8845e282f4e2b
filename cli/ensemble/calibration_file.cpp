#include "cli/ensemble/calibration_file.h"

#include <fmt/format.h>

#include <cmath>

#include "analysis/emulator.h"
#include "sim/scene/scenario_values.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostParameters = 3;  // the posterior is a grid

void read_targets(const YamlNode& root, const fs::path& file, const std::optional<fs::path>& scenario,
                  CalibrationSpec& spec, FileReader& reader) {
  const YamlNode* list =
      reader.list_at(root, "targets", true, "a list, - {output: angle_deg, value: 25.4, uncertainty: 1.5}");
  if (list == nullptr) return;
  for (const YamlNode& item : list->items) {
    if (item.kind != YamlKind::map) {
      reader.fail(item.place, "targets: a map is expected, found " + found(item));
      continue;
    }
    reader.allow(item, {"output", "value", "uncertainty", "scenario"}, " in a target");
    CalibrationSpec::Target target;
    const YamlEntry *output = item.find("output"), *value = item.find("value"),
                    *uncertainty = item.find("uncertainty");
    if (output == nullptr || value == nullptr || uncertainty == nullptr) {
      reader.fail(item.place, "targets: output, value and uncertainty are needed");
      continue;
    }
    target.output = reader.scalar(output->value, "output").value_or("");
    target.value = reader.number(value->value, "value").value_or(0);
    target.uncertainty = reader.number(uncertainty->value, "uncertainty").value_or(1);
    if (!(target.uncertainty > 0))
      reader.fail(uncertainty->value.place, "uncertainty: must be above 0 (a standard deviation)");
    if (item.find("scenario") != nullptr)
      target.scenario = scenario_at(item, file, true, reader).value_or("");
    else if (scenario)
      target.scenario = *scenario;
    else
      reader.fail(item.place, "targets: a scenario is needed, here or for all at the top");
    spec.targets.push_back(std::move(target));
  }
}

void read_method(const YamlNode& root, CalibrationSpec& spec, FileReader& reader) {
  const YamlNode* method = reader.map_at(root, "method", false, "a map with a type");
  if (method == nullptr) return;
  const YamlEntry* type = method->find("type");
  const std::string name = type != nullptr && type->value.kind == YamlKind::scalar ? type->value.text : "";
  const auto integer = [&](const char* key, int& value, int least, int most) {
    if (const YamlEntry* entry = method->find(key))
      value = static_cast<int>(
          reader.whole(entry->value, key, least, most).value_or(static_cast<std::uint64_t>(value)));
  };
  if (name == "grid") {
    spec.method = CalibrationSpec::Method::grid;
    reader.allow(*method, {"type", "points"}, " in method grid");
    integer("points", spec.grid_points, 2, 50);
  } else if (name == "bayes") {
    reader.allow(*method, {"type", "first", "most", "together", "enough"}, " in method bayes");
    integer("first", spec.first_points, static_cast<int>(Emulator::kLeastPoints), 500);
    integer("most", spec.most_simulations, 4, static_cast<int>(Emulator::kMostPoints));
    integer("together", spec.together, 1, 100);
    if (const YamlEntry* entry = method->find("enough"))
      spec.enough = reader.number(entry->value, "enough").value_or(spec.enough);
    if (spec.most_simulations < spec.first_points)
      reader.fail(method->place, "method: 'most' must not be below 'first'");
  } else {
    reader.fail(type == nullptr ? method->place : type->value.place, "method.type: one of grid, bayes");
  }
}

}  // namespace

CalibrationSpecResult load_calibration(const fs::path& file) {
  CalibrationSpecResult result;
  CalibrationSpec& spec = result.spec;
  FileReader reader(result.errors);
  spec.name = file.stem().string();
  const auto root = read_yaml(file, result.errors);
  if (!root) return result;
  reader.allow(*root, {"scenario", "seeds", "set", "ties", "parameters", "targets", "method"}, "");
  const auto scenario = scenario_at(*root, file, false, reader);
  std::vector<std::string> names;
  if (const YamlNode* parameters =
          reader.map_at(*root, "parameters", true, "a map from keys to {from: .., to: ..}")) {
    spec.parameters = reader.spans(*parameters);
    if (parameters->entries.size() > kMostParameters)
      reader.fail(parameters->place, fmt::format("parameters: {} are the most", kMostParameters));
  }
  for (const FileReader::Span& span : spec.parameters) names.push_back(span.key);
  spec.variation = read_variation(*root, names, reader);
  if (const YamlNode* list = reader.list_at(*root, "seeds", true, "a list of integers"))
    spec.seeds = reader.seeds(*list);
  read_targets(*root, file, scenario, spec, reader);
  read_method(*root, spec, reader);
  const double nodes = std::pow(spec.grid_points, static_cast<double>(spec.parameters.size()));
  const double runs = nodes * static_cast<double>(spec.seeds.size());
  constexpr double kLeast = Emulator::kLeastPoints, kMost = Emulator::kMostPoints;
  if (reader.good() && spec.method == CalibrationSpec::Method::grid && (runs < kLeast || runs > kMost))
    reader.fail(root->place,
                fmt::format("{} simulations (points, seeds); allowed {} to {}", runs, kLeast, kMost));
  return result;
}

}  // namespace scree
