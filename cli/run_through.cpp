#include "cli/run_through.h"

#include "cli/commands.h"
#include "cli/ensemble_console.h"

scree::RunThrough run_through(scree::ResultsStore& store, int jobs, bool again) {
  return [&store, jobs, again](const std::vector<scree::RunRequest>& runs) {
    run_with_progress(runs, store, jobs, again);
    if (interrupted) throw scree::Stopped("interrupted; the same command goes on from here");
    std::vector<std::optional<scree::StoredResult>> results;
    for (const scree::RunRequest& run : runs) results.push_back(store.find(run.key));
    return results;
  };
}
