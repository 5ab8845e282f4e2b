#include "cli/run_through.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/ensemble_console.h"

scree::RunThrough run_through(scree::ResultsStore& store, const EnsembleOptions& options) {
  return [&store, options](const std::vector<scree::RunRequest>& runs, const std::string& what) {
    const bool all_there = std::all_of(runs.begin(), runs.end(), [&](const scree::RunRequest& run) {
      const auto found = store.find(run.key);
      return found && (found->state == scree::RunState::done ||
                       (found->state == scree::RunState::failed && !options.again));
    });
    if (!all_there) fmt::print(stderr, "{}\n", what);
    const auto ended = ended_runs(runs, store, options);
    if (!ended) throw scree::Stopped("interrupted; the same command goes on from here");
    return std::vector<std::optional<scree::StoredResult>>(ended->begin(), ended->end());
  };
}
