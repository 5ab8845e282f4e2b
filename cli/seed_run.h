#pragma once
// One seed of a run: simulation with its trajectory, its flow and its checkpoints, and what analysis makes of
// it.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "analysis/results/results.h"
#include "cli/checkpoints.h"
#include "cli/progress.h"
#include "sim/scene/scenario.h"

struct SeedRun {
  std::uint64_t seed = 0;
  std::unique_ptr<scree::SeedResult> result;
  std::vector<std::string> notes;
  std::string failure;
  bool does_not_fit = false;  ///< the failure is one of the checkpoint, of another run: it stays
  bool blew_up = false;       ///< the failure is one of the watch (sim/scene/watch.h)
  /// It failed for want of memory, disk or permission: resumed later it may come to its end.
  bool worth_resuming = false;
};

struct SeedSettings {
  int threads = 1;
  std::filesystem::path folder;        ///< of this seed
  scree::CheckpointHeader checkpoint;  ///< but for the seed and the time
  double checkpoint_minutes = 0;
  bool resume = false;              ///< go on with what is in the folder
  bool keep_finished = false;       ///< other seeds may still be running when the program is killed
  std::string pile;                 ///< hash of the pile (RunRequest), but for the seed
  bool keep_pile = false;           ///< in the folder
  std::filesystem::path read_pile;  ///< folder of this seed with its pile, to be read; empty: simulate
};

/// Fills in `run`; what goes wrong is told there.
void run_seed(const scree::Scenario& scenario, SeedRun& run, const SeedSettings& settings,
              scree::ProgressDisplay& display, std::size_t index);
