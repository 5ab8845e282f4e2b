#pragma once
// Results of finished simulations in one SQLite file, by the hash of what was run.
//
// A run is claimed before it is started, so that two programs on one store never do the same twice, and
// becomes `done` or `failed` in one transaction. A claim whose program has died (kill -9, power) is free
// again: on the same machine at once, on another after kLostAfter seconds without a sign of life.
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct sqlite3;

namespace scree {

/// What identifies a simulation and is kept with its result.
struct RunRequest {
  std::string key;       ///< hash of all that follows and of the files it reads, 32 hexadecimal digits
  std::string scenario;  ///< resolved, with one seed, as YAML
  std::uint64_t seed = 0;
  /// The same hash without effects on measurement: runs of the same pile are one simulation, read more than
  /// once. Empty: shared with none.
  std::string pile = {};
};

enum class RunState { running, done, failed };

/// A run as the store has it.
struct StoredResult {
  RunState state = RunState::running;
  std::string version;  ///< of the program that made it
  std::string message;  ///< why it failed
  double wall_seconds = 0;
  std::map<std::string, double> outputs;  ///< by name (analysis/results/outputs.h)
  bool at_rest() const {
    const auto found = outputs.find("at_rest");
    return found == outputs.end() || found->second != 0;
  }
};

enum class Claim {
  ours,    ///< to be run by the caller
  others,  ///< somebody else runs it
  done,
  failed
};

class ResultsStore {
 public:
  static constexpr double kLostAfter = 600;  ///< s without a sign of life of another machine's claim

  enum class Access { look, change };

  /// Opens the store; to change it, makes a new one if there is none, and to look at it needs no right to
  /// write. Throws std::runtime_error: not there, not writable, not a store, of a newer scree.
  explicit ResultsStore(const std::filesystem::path& file, Access access = Access::change);
  ~ResultsStore();
  ResultsStore(const ResultsStore&) = delete;
  ResultsStore& operator=(const ResultsStore&) = delete;

  /// Takes a run for this program, unless it is done, failed or taken. `again`: one that failed is taken,
  /// too.
  Claim claim(const RunRequest& run, const std::string& version, bool again);
  /// What came of a run that this program has claimed. False, and nothing happens, if the claim was lost
  /// meanwhile.
  bool finish(const std::string& key, const std::string& summary,
              const std::map<std::string, double>& outputs, double wall_seconds);
  bool fail(const std::string& key, const std::string& message, double wall_seconds);
  /// Gives a claim back.
  void release(const std::string& key);
  /// Says that this program's claims are alive; to be called every minute or so.
  void sign_of_life();

  std::optional<StoredResult> find(const std::string& key) const;
  /// summary.json of a run that is done; empty otherwise.
  std::string summary(const std::string& key) const;
  const std::filesystem::path& file() const { return file_; }

 private:
  void execute(const char* sql);
  std::filesystem::path file_;
  sqlite3* db_ = nullptr;
  std::string owner_;  // this program
};

}  // namespace scree
