#include "cli/run_through.h"

#include "cli/ensemble_console.h"

scree::RunThrough run_through(scree::ResultsStore& store, const EnsembleOptions& options) {
  return [&store, options](const std::vector<scree::RunRequest>& runs, const std::string& what) {
    const auto ended = ended_runs(runs, store, options, what);
    if (!ended) throw scree::Stopped("interrupted; the same command goes on from here");
    return std::vector<std::optional<scree::StoredResult>>(ended->begin(), ended->end());
  };
}
