#pragma once
// What a run leaves in its folder to be resumed: resume.json, there from its beginning until all seeds have
// come to their results.
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/scene/scenario.h"

/// What a command line said that scenario.yaml does not say.
struct RunRecord {
  std::string program;   ///< version of the program
  std::string scenario;  ///< hash of the scenario and of the files that it names
  std::string name;      ///< of the scenario
  std::vector<std::uint64_t> seeds;
  bool summary_only = false;
  double checkpoint_minutes = 0;
  bool keep_pile = false;
};

/// Version of this program as checkpoints name it: no other build goes on from them.
std::string program_version();

/// Hash of a scenario as it is in a run folder, with the grading and the meshes themselves. Throws
/// std::runtime_error if a file cannot be read.
std::string scenario_hash(const scree::Scenario& scenario);

/// The same without effects on measurement, of any seeds: runs of the same can read each other's piles.
std::string pile_hash(const scree::Scenario& scenario);

/// Writes resume.json. Throws std::runtime_error.
void write_record(const std::filesystem::path& folder, const RunRecord& record);

/// Reads it. Throws std::runtime_error with what to do if the folder holds no run that can be resumed.
RunRecord read_record(const std::filesystem::path& folder);

/// The run has come to its end.
void remove_record(const std::filesystem::path& folder);

/// Holds a run folder for this process while it lives; none other works in it. Throws std::runtime_error if
/// another still does after `patience` seconds: one that was just killed may be ending.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder, double patience = 0);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};
