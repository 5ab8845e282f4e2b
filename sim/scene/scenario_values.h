#pragma once
// Scalars of a scenario file and the words of its messages.
#include "sim/scene/scenario_keys.h"
#include "sim/scene/yaml_tree.h"

namespace scree {

enum class Parsed { yes, no, not_finite };

/// A decimal number and nothing else.
Parsed parse_number(std::string_view text, double& value);

/// Whether a node is text; a plain scalar that YAML reads as a number, a truth value or nothing is not.
bool is_plain_text(const YamlNode& node);

/// What a node is, for "found ...": "a list", "'10 ft'".
std::string found(const YamlNode& node);

/// " (did you mean 'height_m'?)" or nothing.
std::string suggestion(std::string_view word, const std::vector<std::string>& allowed);

/// "0.1 to 200 m", "more than 0 to 1", "0 to less than 1".
std::string range_text(const Range& range, std::string_view unit);

std::string join(const std::vector<std::string>& words);

/// Absolute path without `.` and `..`.
std::filesystem::path clean_path(const std::filesystem::path& path);

}  // namespace scree
