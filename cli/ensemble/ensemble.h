#pragma once
// The loop that brings many runs into a store.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cli/ensemble/executor.h"
#include "sim/io/results_store.h"

namespace scree {

struct EnsembleSettings {
  std::string version;  ///< of the program
  bool again = false;   ///< runs that failed before are tried again
};

/// How far an ensemble is.
struct EnsembleProgress {
  std::size_t runs = 0;        ///< in all
  std::size_t done = 0;        ///< in the store, of them
  std::size_t failed = 0;      ///< in the store, of them
  std::size_t here = 0;        ///< under way in this program
  std::size_t others = 0;      ///< under way in others
  std::size_t ended_here = 0;  ///< ended in this program, well or badly
  std::size_t begun_anew = 0;  ///< whose checkpoint was refused
  std::string why_anew;        ///< the last of them
  double share_under_way = 0;  ///< sum of the shares done of the runs under way in this program
  double work_here = 0;        ///< runs' worth of work that this program has done
};

/// Brings every run into the store: does those that are not there, leaves those that others do to them (and
/// takes them over if they die). A run that fails is recorded and does not stop the rest. `report` is called
/// some times a second; returning false ends the work: runs under way are given back. Returns the last
/// progress. Throws std::runtime_error if the store or the work folder cannot be written.
EnsembleProgress run_ensemble(const std::vector<RunRequest>& runs, ResultsStore& store, Executor& executor,
                              const EnsembleSettings& settings,
                              const std::function<bool(const EnsembleProgress&)>& report);

}  // namespace scree
