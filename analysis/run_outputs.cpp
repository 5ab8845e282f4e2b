#include "analysis/run_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "analysis/summary.h"

namespace scree {
namespace {

using Json = nlohmann::json;

void add(std::map<std::string, double>& outputs, const std::string& name, const Json& value) {
  if (value.is_number()) outputs[name] = value.get<double>();
  if (value.is_boolean()) outputs[name] = value.get<bool>() ? 1 : 0;
}

// {per_seed: [...]} of the one seed.
const Json& of_seed(const Json& spread) {
  return spread.at("per_seed").at(0);
}

}  // namespace

namespace {

const std::vector<std::string>& common_outputs() {
  static const std::vector<std::string> names{"particles", "simulated_seconds", "largest_overlap_ratio",
                                              "lost_mass_t", "at_rest"};
  return names;
}

bool has_sections(const std::string& experiment) {
  return experiment == "end_dump" || experiment == "push_dump" || experiment == "bucket_dump";
}

std::vector<std::string> outputs_of(const std::string& experiment) {
  if (experiment == "repose_lift")
    return {"angle_deg", "height_over_radius_deg", "half_coverage_deg", "height_m", "radius_m", "runaways"};
  if (experiment == "drop_test") return {"rebound_height_m"};
  std::vector<std::string> names{"slope_angle_deg"};
  for (const SectionField& field : section_fields())
    names.push_back(fmt::format("{}_{}", field.name, experiment == "bucket_dump" ? "top" : "S1"));
  return names;
}

bool may_give(const std::string& experiment, const std::string& output) {
  const std::vector<std::string> names = outputs_of(experiment);
  const auto& common = common_outputs();
  if (std::find(names.begin(), names.end(), output) != names.end()) return true;
  if (std::find(common.begin(), common.end(), output) != common.end()) return true;
  if (!has_sections(experiment)) return false;
  const auto under = output.rfind('_');  // chi_S6, d50_m_S1, chi_bottom
  if (under == std::string::npos) return false;
  const std::string section = output.substr(under + 1);
  const bool cell = experiment == "bucket_dump";
  const bool named = cell ? section == "middle" || section == "bottom"
                          : section.size() > 1 && section[0] == 'S' &&
                                section.find_first_not_of("0123456789", 1) == std::string::npos;
  return named && std::find(names.begin(), names.end(), output.substr(0, under) + (cell ? "_top" : "_S1")) !=
                      names.end();
}

}  // namespace

std::string why_not_given(const std::string& experiment, const std::string& output) {
  if (may_give(experiment, output)) return {};
  return fmt::format("a scenario of type {} does not give it; it gives {}, {}{}", experiment,
                     fmt::join(outputs_of(experiment), ", "), fmt::join(common_outputs(), ", "),
                     experiment == "bucket_dump" ? "; middle and bottom alike"
                     : has_sections(experiment)  ? "; S2, S3 and so on alike"
                                                 : "");
}

std::map<std::string, double> run_outputs(const std::string& summary) {
  std::map<std::string, double> outputs;
  try {
    const Json json = Json::parse(summary);
    if (json.at("seeds").size() != 1) throw std::runtime_error("a summary of one seed is expected");
    for (const std::string& name : common_outputs()) add(outputs, name, json.at(name));
    if (json.contains("repose"))
      for (const auto& [name, spread] : json.at("repose").items()) add(outputs, name, of_seed(spread));
    if (json.contains("slope_angle")) add(outputs, "slope_angle_deg", of_seed(json.at("slope_angle")));
    if (json.contains("rebound_height_m"))
      add(outputs, "rebound_height_m", of_seed(json.at("rebound_height_m")));
    for (const Json& section : json.at("sections"))
      for (const auto& [name, spread] : section.items())
        if (spread.is_object())
          add(outputs, fmt::format("{}_{}", name, section.at("name").get<std::string>()), of_seed(spread));
  } catch (const Json::exception& error) {
    throw std::runtime_error(fmt::format("not a summary of scree: {}", error.what()));
  }
  return outputs;
}

}  // namespace scree
