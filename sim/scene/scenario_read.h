#pragma once
// Fills a Scenario from a tree by the table of keys, and remembers where each value stands.
#include <map>
#include <set>

#include "sim/scene/scenario_keys.h"
#include "sim/scene/yaml_tree.h"

namespace scree {

/// A mesh key that was read; the file exists.
struct MeshUse {
  const std::filesystem::path* file;
  const double* scale;
  std::string key;  ///< "experiment.truck.bed_mesh"
  Place place;
};

/// What the reading leaves for the checks that need more than one key.
struct ReadNotes {
  std::vector<ScenarioError> errors;
  std::map<const void*, Place> places;  ///< by address of the value; a default has its map's place
  std::set<const void*> bad;            ///< values that could not be read
  std::vector<MeshUse> meshes;

  /// All of these values were reached and read.
  bool good(std::initializer_list<const void*> values) const {
    for (const void* value : values)
      if (bad.contains(value) || !places.contains(value)) return false;
    return true;
  }
};

/// `incomplete`: the parent of `extends` could not be read, so that nothing is called missing.
void read_keys(const YamlNode& root, Scenario& scenario, const std::filesystem::path& asset_dir,
               bool incomplete, ReadNotes& notes);

/// Checks that span keys or need other files: meshes, grading, reference cases, sizes (scenario_checks.cpp).
void check_scenario(const Scenario& scenario, const std::filesystem::path& asset_dir, ReadFor use,
                    ReadNotes& notes, std::vector<std::string>& warnings);

/// Sets `bullet` of a scenario with engine impulse: the settings given, else the equivalent ones.
void find_bullet_settings(Scenario& scenario, const std::filesystem::path& asset_dir, ReadNotes& notes);

/// The whole scenario as YAML (scenario_write.cpp).
std::string write_scenario(Scenario scenario, const std::filesystem::path& asset_dir);

/// What is wrong with "key=value" in every type of experiment; empty if some type has the key and takes the
/// value.
std::string why_not_set(const std::string& text, const std::filesystem::path& asset_dir);

}  // namespace scree
