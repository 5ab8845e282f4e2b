#include "cli/ensemble/file_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/scene/scenario_values.h"

namespace scree {

namespace fs = std::filesystem;

void FileReader::allow(const YamlNode& map, const std::vector<std::string>& allowed,
                       const std::string& where) {
  for (const YamlEntry& entry : map.entries)
    if (std::find(allowed.begin(), allowed.end(), entry.key) == allowed.end())
      fail(entry.key_place, fmt::format("unknown key {}{}{}; allowed: {}", shown(entry.key), where,
                                        suggestion(entry.key, allowed), join(allowed)));
}

const YamlNode* FileReader::map_at(const YamlNode& parent, const char* key, bool required, const char* what) {
  const YamlEntry* entry = parent.find(key);
  if (entry == nullptr) {
    if (required) fail(parent.place, fmt::format("'{}' is missing: {}", key, what));
    return nullptr;
  }
  const bool is_map = entry->value.kind == YamlKind::map, empty = is_map && entry->value.entries.empty();
  if (is_map && !(required && empty)) return &entry->value;
  fail(entry->value.place,
       fmt::format("{}: {} is expected, found {}", key, what, empty ? "an empty map" : found(entry->value)));
  return nullptr;
}

const YamlNode* FileReader::list_at(const YamlNode& parent, const char* key, bool required,
                                    const char* what) {
  const YamlEntry* entry = parent.find(key);
  if (entry == nullptr) {
    if (required) fail(parent.place, fmt::format("'{}' is missing: {}", key, what));
    return nullptr;
  }
  const bool is_list = entry->value.kind == YamlKind::sequence;
  if (is_list && !entry->value.items.empty()) return &entry->value;
  fail(entry->value.place, fmt::format("{}: {} is expected, found {}", key, what,
                                       is_list ? "an empty list" : found(entry->value)));
  return nullptr;
}

std::optional<std::string> FileReader::scalar(const YamlNode& node, const std::string& key) {
  if (node.kind == YamlKind::scalar) return node.text;
  fail(node.place, fmt::format("{}: one value is expected, found {}", key, found(node)));
  return std::nullopt;
}

std::optional<double> FileReader::number(const YamlNode& node, const std::string& key) {
  double value = 0;
  if (node.kind == YamlKind::scalar && !node.quoted && parse_number(node.text, value) == Parsed::yes)
    return value;
  fail(node.place, fmt::format("{}: a number is expected, found {}", key, found(node)));
  return std::nullopt;
}

std::optional<std::uint64_t> FileReader::whole(const YamlNode& node, const std::string& key, double least,
                                               double most) {
  const auto value = number(node, key);
  if (!value) return std::nullopt;
  if (*value >= least && *value <= most && *value == std::floor(*value))
    return static_cast<std::uint64_t>(*value);
  fail(node.place,
       fmt::format("{}: an integer from {} to {} is expected, found {}", key, least, most, found(node)));
  return std::nullopt;
}

void FileReader::integer(const YamlNode& map, const char* key, int least, int most, int& value) {
  if (const YamlEntry* entry = map.find(key))
    if (const auto found = whole(entry->value, key, least, most)) value = static_cast<int>(*found);
}

std::vector<std::uint64_t> FileReader::seeds(const YamlNode& list) {
  std::vector<std::uint64_t> seeds;
  for (const YamlNode& item : list.items) {
    const auto seed = whole(item, "seeds", 0, kLargestSeed);
    if (!seed) continue;
    if (std::find(seeds.begin(), seeds.end(), *seed) != seeds.end())
      fail(item.place, fmt::format("seeds: {} stands twice", *seed));
    seeds.push_back(*seed);
  }
  return seeds;
}

std::vector<FileReader::Span> FileReader::spans(const YamlNode& map) {
  std::vector<Span> spans;
  for (const YamlEntry& entry : map.entries) {
    const bool is_map = entry.value.kind == YamlKind::map;
    const YamlEntry* from = is_map ? entry.value.find("from") : nullptr;
    const YamlEntry* to = is_map ? entry.value.find("to") : nullptr;
    if (from == nullptr || to == nullptr) {
      fail(entry.value.place,
           fmt::format("{}: {{from: .., to: ..}} is expected, found {}", entry.key, found(entry.value)));
      continue;
    }
    allow(entry.value, {"from", "to"}, " in " + entry.key);
    const auto a = number(from->value, entry.key + ".from"), b = number(to->value, entry.key + ".to");
    if (!a || !b) continue;
    if (*a < *b)
      spans.push_back({entry.key, *a, *b});
    else
      fail(to->value.place, entry.key + ": 'to' must be above 'from'");
  }
  return spans;
}

std::string value_text(const std::string& text, bool quoted, const fs::path& folder) {
  std::error_code none;
  const fs::path path = fs::path(text).has_extension() ? folder / text : fs::path();
  if (!path.empty() && fs::is_regular_file(path, none))
    return yaml_text(fs::absolute(path).lexically_normal().string());
  return quoted ? yaml_text(text) : text;
}

Variation read_variation(const YamlNode& root, const std::vector<std::string>& parameters,
                         FileReader& reader) {
  Variation variation{fs::path(*root.place.file).parent_path(), {}, {}};
  const auto is_parameter = [&](const std::string& key) {
    return std::find(parameters.begin(), parameters.end(), key) != parameters.end();
  };
  const YamlNode* set = reader.map_at(root, "set", false, "a map of keys of the scenario");
  if (set != nullptr)
    for (const YamlEntry& entry : set->entries) {
      if (is_parameter(entry.key))
        reader.fail(entry.key_place, fmt::format("set.{}: is a parameter itself", entry.key));
      if (const auto value = reader.scalar(entry.value, "set." + entry.key))
        variation.fixed.push_back(entry.key + "=" + value_text(*value, entry.value.quoted, variation.folder));
    }
  const YamlNode* ties = reader.map_at(root, "ties", false, "a map from a key to the one it follows");
  if (ties == nullptr) return variation;
  for (const YamlEntry& entry : ties->entries) {
    const auto leader = reader.scalar(entry.value, "ties." + entry.key);
    if (!leader) continue;
    if (!parameters.empty() && !is_parameter(*leader))
      reader.fail(entry.value.place, fmt::format("ties.{}: {} is no parameter; there are {}", entry.key,
                                                 shown(*leader), join(parameters)));
    if (is_parameter(entry.key))
      reader.fail(entry.key_place, fmt::format("ties.{}: is a parameter itself", entry.key));
    if (const YamlEntry* fixed = set == nullptr ? nullptr : set->find(entry.key))
      reader.fail(fixed->key_place, fmt::format("set.{}: follows {} in ties", entry.key, *leader));
    variation.ties.push_back({entry.key, *leader});
  }
  return variation;
}

std::vector<std::string> overrides_of(const Variation& variation, const std::vector<std::string>& parameters,
                                      const std::vector<std::string>& values) {
  std::vector<std::string> overrides = variation.fixed;
  const auto set = [&](const std::string& key, std::size_t parameter) {
    overrides.push_back(key + "=" + value_text(values[parameter], false, variation.folder));
  };
  for (std::size_t k = 0; k < parameters.size(); ++k) set(parameters[k], k);
  for (const auto& [key, leader] : variation.ties) {
    const auto at = std::find(parameters.begin(), parameters.end(), leader) - parameters.begin();
    set(key, static_cast<std::size_t>(at));
  }
  return overrides;
}

std::optional<fs::path> scenario_at(const YamlNode& parent, const fs::path& file, bool required,
                                    FileReader& reader) {
  const YamlEntry* entry = parent.find("scenario");
  if (entry == nullptr) {
    if (required) reader.fail(parent.place, "'scenario' is missing: the scenario file that is run");
    return std::nullopt;
  }
  const auto name = reader.scalar(entry->value, "scenario");
  if (!name) return std::nullopt;
  const auto path = (file.parent_path() / *name).lexically_normal();
  std::error_code none;
  if (fs::is_regular_file(path, none)) return path;
  reader.fail(entry->value.place, fmt::format("scenario: no file {}", shown(path.string())));
  return std::nullopt;
}

}  // namespace scree
