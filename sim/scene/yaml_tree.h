#pragma once
// YAML text as a plain tree whose every node knows where it stands. yaml-cpp reads the text; the tree keeps
// what its own nodes lose: places after merging, quotes, duplicate keys.
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/scene/scenario.h"

namespace scree {

/// Where a node stands. line = 0: in the override named by `file` ("--set material.mu=0.5").
struct Place {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;  ///< from 1
};

enum class YamlKind { null, scalar, sequence, map };

struct YamlEntry;

struct YamlNode {
  YamlKind kind = YamlKind::null;
  Place place;
  std::string text;                ///< scalar only
  bool quoted = false;             ///< scalar written in quotes or as a block: text, never a number
  std::vector<YamlNode> items;     ///< sequence only
  std::vector<YamlEntry> entries;  ///< map only, in the order of the file, keys distinct

  const YamlEntry* find(std::string_view key) const;
};

struct YamlEntry {
  std::string key;
  Place key_place;
  YamlNode value;
};

/// Limits of a scenario file; beyond them it is refused.
inline constexpr std::size_t kMaxFileBytes = 1'000'000;
inline constexpr std::size_t kMaxNodes = 50'000;  ///< after aliases are expanded
inline constexpr std::size_t kMaxDepth = 32;

void report(std::vector<ScenarioError>& errors, const Place& place, std::string message);

/// Parses one document. Duplicate keys become errors and the first stays; bad YAML becomes one error and no
/// tree. An empty text is an empty map. `origin.line` = 0 gives every node the place `origin` itself.
std::optional<YamlNode> parse_yaml(const std::string& text, const Place& origin,
                                   std::vector<ScenarioError>& errors);

/// Reads and parses a file.
std::optional<YamlNode> read_yaml(const std::filesystem::path& file, std::vector<ScenarioError>& errors);

/// Lays `over` on `base`: maps are merged key by key, all else is replaced.
void merge_yaml(YamlNode& base, YamlNode over);

/// A text as YAML: plain when it can be nothing but text, in double quotes (JSON's are YAML's) otherwise.
std::string yaml_text(const std::string& text);

/// Text as quoted in a message: one line, at most 60 bytes, in single quotes.
std::string shown(std::string_view text);

}  // namespace scree
