#include "analysis/run_outputs.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

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

std::map<std::string, double> run_outputs(const std::string& summary) {
  std::map<std::string, double> outputs;
  try {
    const Json json = Json::parse(summary);
    if (json.at("seeds").size() != 1) throw std::runtime_error("a summary of one seed is expected");
    for (const char* name :
         {"particles", "simulated_seconds", "largest_overlap_ratio", "lost_mass_t", "at_rest"})
      add(outputs, name, json.at(name));
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
