#include "cli/run_through.h"

#include "cli/ensemble_console.h"

scree::RunThrough run_through(scree::ResultsStore& store, const EnsembleOptions& options) {
  return [&store, options](const std::vector<scree::RunRequest>& runs) {
    run_with_progress(runs, store, options);
    if (interrupted) throw scree::Stopped("interrupted; the same command goes on from here");
    std::vector<std::optional<scree::StoredResult>> results;
    for (const scree::RunRequest& run : runs) results.push_back(store.find(run.key));
    return results;
  };
}
