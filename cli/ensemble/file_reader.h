#pragma once
// What the readers of files beside scenarios share (sweeps, calibrations, studies, models, datasets): values
// of a YAML tree, and what is wrong with them.
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sim/scene/yaml_tree.h"

namespace scree {

class FileReader {
 public:
  explicit FileReader(std::vector<ScenarioError>& errors) : errors_(errors) {}

  void fail(const Place& place, const std::string& message) { report(errors_, place, message); }
  bool good() const { return errors_.empty(); }
  /// Refuses keys that are not among these; `where`: " in a grid".
  void allow(const YamlNode& map, const std::vector<std::string>& allowed, const std::string& where);
  /// The map at a key; null when it is not there or no map. That is an error, and so is an empty one, where
  /// it is required; another may be empty or left out.
  const YamlNode* map_at(const YamlNode& parent, const char* key, bool required, const char* what);
  /// The list at a key, with an entry at least.
  const YamlNode* list_at(const YamlNode& parent, const char* key, bool required, const char* what);
  /// The text, or the number, of a node; nothing, with an error that names `key`, if it is none.
  std::optional<std::string> scalar(const YamlNode& node, const std::string& key);
  std::optional<double> number(const YamlNode& node, const std::string& key);
  /// An integer within bounds.
  std::optional<std::uint64_t> whole(const YamlNode& node, const std::string& key, double least, double most);
  /// Sets `value` where the map has the key.
  void integer(const YamlNode& map, const char* key, int least, int most, int& value);
  /// Of lists of seeds and of designs: 2^53 - 1, up to which a double is exact.
  static constexpr double kLargestSeed = 9007199254740991.0;
  /// Distinct integers from 0 to kLargestSeed.
  std::vector<std::uint64_t> seeds(const YamlNode& list);

  /// A key whose value lies between two numbers.
  struct Span {
    std::string key;
    double from, to;
  };
  /// {key: {from: .., to: ..}, ...}
  std::vector<Span> spans(const YamlNode& map);

 private:
  std::vector<ScenarioError>& errors_;
};

/// What a sweep and a calibration say of their scenario besides its parameters.
struct Variation {
  std::filesystem::path folder;                           ///< of the file that says it
  std::vector<std::string> fixed;                         ///< overrides "key=value"
  std::vector<std::pair<std::string, std::string>> ties;  ///< the first key takes the value of the second
};

/// A value for a key of a scenario, as YAML; of a file that is found from `folder`, its whole path: the
/// scenario may lie elsewhere. `quoted`: text, even where it looks like a number.
std::string value_text(const std::string& text, bool quoted, const std::filesystem::path& folder);

/// Reads `set` and `ties`; the keys followed must be among `parameters`, those that follow or are set must
/// not, and no key may do both.
Variation read_variation(const YamlNode& root, const std::vector<std::string>& parameters,
                         FileReader& reader);

/// The overrides of one point.
std::vector<std::string> overrides_of(const Variation& variation, const std::vector<std::string>& parameters,
                                      const std::vector<std::string>& values);

/// The scenario file named at `key`, relative to the file that names it.
std::optional<std::filesystem::path> scenario_at(const YamlNode& parent, const std::filesystem::path& file,
                                                 bool required, FileReader& reader);

}  // namespace scree
