#include "cli/ensemble_console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>

#include "cli/option_values.h"
#include "cli/progress.h"
#include "scree_version.h"
#include "sim/scene/scenario_values.h"

namespace fs = std::filesystem;

namespace {
constexpr double kTerminalInterval = 0.5, kPlainInterval = 30;  // s between lines of progress
}

fs::path store_file(const fs::path& named) {
  return named.empty() ? fs::path("runs") / "store.sqlite" : named;
}

std::unique_ptr<scree::ResultsStore> open_store(const fs::path& named, StoreUse use) {
  const fs::path file = store_file(named);
  if ((use == StoreUse::plan || (use == StoreUse::list && named.empty())) && !fs::exists(file)) {
    fmt::print(stderr, "note: {} is not there: nothing has been run yet\n", file.string());
    return std::make_unique<scree::ResultsStore>(":memory:");
  }
  const bool only_look = use != StoreUse::change;
  if (only_look && !fs::exists(file)) {
    fmt::print(stderr, "{}: no such store; nothing has been run yet, or another --store is meant\n",
               file.string());
    return nullptr;
  }
  std::error_code error;
  if (file.string() == ":memory:" || (fs::exists(file, error) && !fs::is_regular_file(file, error))) {
    fmt::print(stderr, "{}: is no file, and a store is one; take another --store\n", file.string());
    return nullptr;
  }
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  try {
    using Access = scree::ResultsStore::Access;
    return std::make_unique<scree::ResultsStore>(file, only_look ? Access::look : Access::change);
  } catch (const std::runtime_error& refused) {
    fmt::print(stderr, "{}\n", refused.what());
    return nullptr;
  }
}

scree::EnsembleProgress run_with_progress(const std::vector<scree::RunRequest>& runs,
                                          scree::ResultsStore& store, const EnsembleOptions& options,
                                          const std::string& what) {
  scree::LocalProcesses processes(cores_or(options.jobs), options.checkpoint_minutes);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const auto start = std::chrono::steady_clock::now();
  double shown = -1e9;
  bool line_open = false;
  bool said = what.empty();
  std::size_t anew = 0;
  const auto report = [&](const scree::EnsembleProgress& p) {
    if (!said && p.here + p.others + p.ended_here > 0) {
      fmt::print(stderr, "{}\n", what);
      said = true;
    }
    const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (p.begun_anew > anew) {
      fmt::print(stderr, "{}{} run(s) began anew, their checkpoints were refused: {}\n",
                 line_open ? "\n" : "", p.begun_anew, p.why_anew);
      anew = p.begun_anew;
      line_open = false;
    }
    if (elapsed - shown < (terminal ? kTerminalInterval : kPlainInterval)) return interrupted == 0;
    shown = elapsed;
    const double left = static_cast<double>(p.runs - p.done - p.failed) - p.share_under_way;
    std::string text = fmt::format("{} of {} runs", p.done + p.failed, p.runs);
    if (p.failed > 0) text += fmt::format(" ({} failed)", p.failed);
    text += fmt::format(", {} under way", p.here);
    if (p.others > 0) text += fmt::format(", {} by others", p.others);
    if (p.work_here > 0.05 && left > 0)
      text += fmt::format(", about {} left", scree::spell_duration(elapsed * left / p.work_here));
    fmt::print(stderr, "{}{}{}", terminal ? "\r\033[K" : "", text, terminal ? "" : "\n");
    std::fflush(stderr);
    line_open = terminal;
    return interrupted == 0;
  };
  const auto progress = scree::run_ensemble(
      runs, store, processes, {fmt::format("{} ({})", SCREE_VERSION, SCREE_REVISION), options.again}, report);
  if (line_open) fmt::print(stderr, "\n");
  return progress;
}

std::optional<std::vector<scree::StoredResult>> ended_runs(const std::vector<scree::RunRequest>& runs,
                                                           scree::ResultsStore& store,
                                                           EnsembleOptions options, std::string what) {
  while (true) {
    run_with_progress(runs, store, options, what);
    what.clear();
    if (interrupted) return std::nullopt;
    std::vector<scree::StoredResult> results;
    for (const scree::RunRequest& run : runs)
      if (auto found = store.find(run.key); found && found->state != scree::RunState::running)
        results.push_back(std::move(*found));
    if (results.size() == runs.size()) return results;
    // Another program tries one again that had failed, which is no failure yet: it is waited for.
    options.again = false;
  }
}

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  return scree::parse_number(text, value) == scree::Parsed::yes ? std::optional(value) : std::nullopt;
}
