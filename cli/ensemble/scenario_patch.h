#pragma once
// A fitted model as scenario files.
#include <filesystem>
#include <string>
#include <vector>

namespace scree {

/// A scenario file that extends another by values of dotted keys: "material.mu=0.3". `scenario` is written
/// relative to the folder `from`. `comment`: lines, without #.
std::string scenario_patch(const std::filesystem::path& scenario, const std::filesystem::path& from,
                           const std::vector<std::string>& overrides,
                           const std::vector<std::string>& comment);

}  // namespace scree
