#include "cli/ensemble/calibration_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <set>
#include <stdexcept>

#include "analysis/statistics/emulator.h"
#include "sim/material/grading.h"
#include "sim/scene/scenario_values.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostParameters = 3;  // the posterior is a grid

constexpr std::array<int, 4> kCurveDiameters{10, 50, 80, 90};  // D_x that stand for a passing curve

/// A measured passing curve of a section as targets for some of its diameters: a passing share that is
/// uncertain by u makes D_x uncertain by half of D_(x+u) - D_(x-u).
void read_passing_curve(const YamlNode& item, const fs::path& file, const fs::path& scenario,
                        CalibrationSpec& spec, FileReader& reader) {
  const YamlEntry *curve = item.find("passing_curve"), *section = item.find("section"),
                  *uncertainty = item.find("uncertainty");
  reader.allow(item, {"passing_curve", "section", "uncertainty", "scenario"},
               " in a target with a passing curve");
  if (section == nullptr || uncertainty == nullptr)
    return reader.fail(item.place, "targets: passing_curve, section and uncertainty are needed");
  const std::string path = reader.scalar(curve->value, "passing_curve").value_or("");
  const std::string name = reader.scalar(section->value, "section").value_or("");
  const double u = reader.number(uncertainty->value, "uncertainty").value_or(0.03);
  if (!(u > 0 && u < 0.1))
    return reader.fail(uncertainty->value.place,
                       "uncertainty: of a passing share; more than 0, below 0.1 (3 points are 0.03)");
  try {
    const Grading grading = read_grading((file.parent_path() / path).lexically_normal());
    for (const int percent : kCurveDiameters) {
      const double x = percent / 100.0;
      const double spread = 0.5 * (grading.diameter(x + u) - grading.diameter(x - u));
      spec.targets.push_back({fmt::format("d{}_m_{}", percent, name), grading.diameter(x), spread, scenario});
    }
  } catch (const std::runtime_error& error) {
    reader.fail(curve->value.place, std::string("passing_curve: ") + error.what());
  }
}

void read_targets(const YamlNode& root, const fs::path& file, const std::optional<fs::path>& scenario,
                  CalibrationSpec& spec, FileReader& reader) {
  const YamlNode* list =
      reader.list_at(root, "targets", true,
                     "a list that is not empty, - {output: angle_deg, value: 25.4, uncertainty: 1.5}");
  if (list == nullptr) return;
  for (const YamlNode& item : list->items) {
    if (item.kind != YamlKind::map) {
      reader.fail(item.place, "targets: a map is expected, found " + found(item));
      continue;
    }
    CalibrationSpec::Target target;
    if (item.find("scenario") != nullptr)
      target.scenario = scenario_at(item, file, true, reader).value_or("");
    else if (scenario)
      target.scenario = *scenario;
    else if (root.find("scenario") == nullptr)
      reader.fail(item.place, "targets: a scenario is needed, here or for all at the top");
    if (item.find("passing_curve") != nullptr) {
      read_passing_curve(item, file, target.scenario, spec, reader);
      continue;
    }
    reader.allow(item, {"output", "value", "uncertainty", "scenario"}, " in a target");
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
    spec.targets.push_back(std::move(target));
  }
}

void read_method(const YamlNode& root, CalibrationSpec& spec, FileReader& reader) {
  const YamlNode* method = reader.map_at(root, "method", false, "a map with a type");
  if (method == nullptr) return;
  const YamlEntry* type = method->find("type");
  const std::string name = type != nullptr && type->value.kind == YamlKind::scalar ? type->value.text : "";
  if (name == "grid") {
    spec.method = CalibrationSpec::Method::grid;
    reader.allow(*method, {"type", "points"}, " in method grid");
    reader.integer(*method, "points", 2, 50, spec.grid_points);
  } else if (name == "bayes") {
    reader.allow(*method, {"type", "first", "most", "together", "enough"}, " in method bayes");
    reader.integer(*method, "first", static_cast<int>(Emulator::kLeastPoints), 500, spec.first_points);
    reader.integer(*method, "most", 4, static_cast<int>(Emulator::kMostPoints), spec.most_simulations);
    reader.integer(*method, "together", 1, 100, spec.together);
    if (const YamlEntry* entry = method->find("enough")) {
      spec.enough = reader.number(entry->value, "enough").value_or(spec.enough);
      if (!(spec.enough > 0))
        reader.fail(entry->value.place, "enough: must be above 0 (a share of the uncertainty, 0.05)");
    }
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
  std::set<fs::path> scenarios;
  for (const auto& target : spec.targets) scenarios.insert(target.scenario);
  const double each = static_cast<double>(scenarios.size());
  const double runs = nodes * static_cast<double>(spec.seeds.size()) * each;
  if (reader.good() && spec.method == CalibrationSpec::Method::bayes &&
      spec.first_points * each > spec.most_simulations)
    reader.fail(root->place, fmt::format("method: {} first points in {} scenarios are more than 'most'",
                                         spec.first_points, scenarios.size()));
  constexpr double kLeast = Emulator::kLeastPoints, kMost = Emulator::kMostPoints;
  if (reader.good() && spec.method == CalibrationSpec::Method::grid && (runs < kLeast || runs > kMost))
    reader.fail(root->place,
                fmt::format("{} simulations (points, seeds); allowed {} to {}", runs, kLeast, kMost));
  return result;
}

}  // namespace scree
