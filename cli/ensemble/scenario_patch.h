#pragma once
// A fitted model as scenario files.
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// Dotted keys and their values, "material.mu=0.3", as YAML.
std::string nested_yaml(const std::vector<std::string>& overrides);

/// A path as it is written in a YAML file of the folder `from`: relative to it, quoted.
std::string relative_yaml_text(const std::filesystem::path& path, const std::filesystem::path& from);

/// A scenario file that extends another by values of dotted keys: "material.mu=0.3". `scenario` is written
/// relative to the folder `from`. `comment`: lines, without #.
std::string scenario_patch(const std::filesystem::path& scenario, const std::filesystem::path& from,
                           const std::vector<std::string>& overrides,
                           const std::vector<std::string>& comment);

}  // namespace scree
