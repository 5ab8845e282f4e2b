// scree run: a scenario, its seeds side by side, and what comes of it in a folder.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <fstream>
#include <limits>
#include <memory>
#include <mutex>
#include <thread>

#include "analysis/conductivity_table.h"
#include "analysis/report.h"
#include "analysis/summary.h"
#include "cli/commands.h"
#include "cli/output_folder.h"
#include "cli/progress.h"
#include "cli/results_of.h"
#include "cli/table.h"
#include "scree_version.h"
#include "sim/io/trajectory.h"

namespace fs = std::filesystem;

namespace {

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.close();
  if (!out)
    throw std::runtime_error(
        fmt::format("{}: cannot be written (disk full, or no permission?)", file.string()));
}

constexpr std::uint64_t kLargestSeed = std::numeric_limits<std::int64_t>::max();

// The seeds of a run: `count` of them, those of the scenario first; none if the integers end before.
std::vector<std::uint64_t> chosen_seeds(const scree::Scenario& scenario, int count) {
  std::vector<std::uint64_t> seeds = scenario.seeds;
  if (count == 0) return seeds;
  while (static_cast<int>(seeds.size()) < count) {
    const std::uint64_t last = *std::max_element(seeds.begin(), seeds.end());
    if (last == kLargestSeed) return {};
    seeds.push_back(last + 1);
  }
  seeds.resize(static_cast<std::size_t>(count));
  return seeds;
}

// HDF5 as packaged is not safe for several threads; frames are rare.
std::mutex trajectory_mutex;

struct SeedRun {
  std::uint64_t seed = 0;
  std::unique_ptr<scree::SeedResult> result;
  std::vector<std::string> notes;
  std::string failure;
  bool blew_up = false;  // the failure is one of the watch
};

void run_seed(const scree::Scenario& scenario, SeedRun& run, int threads, const fs::path& folder,
              scree::ProgressDisplay& display, std::size_t index) {
  std::unique_ptr<scree::TrajectoryWriter> trajectory;
  scree::RunHooks hooks;
  if (scenario.output.trajectory) {
    hooks.begin = [&](const std::vector<scree::Grain>& grains, const std::vector<scree::Grain>& fixed) {
      const std::lock_guard lock(trajectory_mutex);
      fs::create_directories(folder);
      trajectory = std::make_unique<scree::TrajectoryWriter>(
          folder / "particles.h5", grains, fixed,
          scree::TrajectoryInfo{"scree user", SCREE_VERSION, scenario.resolved_yaml, run.seed});
    };
    hooks.frame = [&](const scree::Snapshot& snapshot, std::int64_t step) {
      const std::lock_guard lock(trajectory_mutex);
      trajectory->write(snapshot, step);
    };
  }
  std::optional<scree::FlowRecorder> flow = scree::make_flow_recorder(scenario);
  if (flow) hooks.look = [&](const scree::Snapshot& snapshot) { flow->add(snapshot); };
  hooks.progress = [&](const scree::RunProgress& p) {
    display.update(index, p);
    return interrupted == 0;
  };
  try {
    scree::RunOutcome outcome = scree::run_scenario(scenario, run.seed, threads, hooks);
    run.notes = outcome.notes;
    run.result = std::make_unique<scree::SeedResult>(
        scree::analyse(scenario, run.seed, std::move(outcome), std::move(flow)));
  } catch (const scree::BlowUp& error) {
    run.failure = error.what();
    run.blew_up = true;
  } catch (const std::exception& error) {
    run.failure = error.what();
  }
  try {
    const std::lock_guard lock(trajectory_mutex);
    if (trajectory) trajectory->close();
    trajectory.reset();
  } catch (const std::exception& error) {
    if (run.failure.empty()) run.failure = error.what();
  }
}

}  // namespace

int run_run(const RunOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  scree::ScenarioResult loaded = scree::load_scenario(options.file, options.overrides, asset_dir());
  for (const std::string& warning : loaded.warnings) fmt::print(stderr, "warning: {}\n", warning);
  for (const scree::ScenarioError& error : loaded.errors) fmt::print(stderr, "{}\n", error.text());
  if (!loaded.errors.empty()) return kBadInput;
  scree::Scenario& scenario = loaded.scenario;

  if (scenario.output.trajectory && !scenario.effects.empty() &&
      scree::effective_model(scenario).changes.breakage.on()) {
    fmt::print(stderr,
               "scree: effects.breakage: a trajectory has a row for each grain put in and none for "
               "fragments; add --set output.trajectory=false\n");
    return kBadInput;
  }
  scenario.seeds = chosen_seeds(scenario, options.seeds);
  if (scenario.seeds.empty()) {
    fmt::print(stderr, "--seeds {}: no integers follow the scenario's last seed; give them in its file\n",
               options.seeds);
    return kBadInput;
  }
  const fs::path out = options.out.empty() ? free_run_folder(scenario.name) : options.out;
  if (!prepare_folder(out, options.force)) return kBadInput;
  write_text(out / "scenario.yaml", scenario.resolved_yaml);

  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int threads = options.threads > 0 ? options.threads : cores;
  const int side_by_side = std::min<int>(threads, static_cast<int>(scenario.seeds.size()));
  std::vector<SeedRun> runs(scenario.seeds.size());
  for (std::size_t k = 0; k < runs.size(); ++k) runs[k].seed = scenario.seeds[k];
  {
    scree::ProgressDisplay display(scenario.seeds);
    std::atomic<std::size_t> next{0};
    std::vector<std::jthread> workers;
    for (int w = 0; w < side_by_side; ++w)
      workers.emplace_back([&] {
        for (std::size_t k = next++; k < runs.size() && !interrupted; k = next++)
          run_seed(scenario, runs[k], std::max(1, threads / side_by_side),
                   out / fmt::format("seed_{}", runs[k].seed), display, k);
      });
    workers.clear();
    display.finish();
  }

  std::vector<scree::SeedResult> results;
  std::vector<std::string> notes, failures;
  int code = kOk;
  for (SeedRun& run : runs) {
    if (!run.failure.empty()) {
      code = std::max<int>(code, run.blew_up ? kWatchFailed : kFailed);
      fmt::print(stderr, "seed {}: {}\n", run.seed, run.failure);
      failures.push_back(fmt::format("seed {}: {}", run.seed, run.failure));
    }
    notes.insert(notes.end(), run.notes.begin(), run.notes.end());
    if (run.result) results.push_back(std::move(*run.result));
    if (!run.result && run.failure.empty())
      notes.push_back(fmt::format("seed {} was not run: the user ended the run", run.seed));
  }
  // An unfinished pile must not be averaged with finished ones.
  const auto unfinished = [](const scree::SeedResult& r) { return r.interrupted; };
  if (!std::all_of(results.begin(), results.end(), unfinished)) {
    for (const scree::SeedResult& r : results)
      if (unfinished(r))
        notes.push_back(fmt::format(
            "seed {} was ended by the user and is left out; its frames are in seed_{}", r.seed, r.seed));
    std::erase_if(results, unfinished);
  }
  if (results.empty()) {
    fmt::print(stderr, "no seed came to a result; what was written is in {}\n", out.string());
    return interrupted ? kInterrupted : std::max<int>(code, kFailed);
  }
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  scree::RunResult result =
      scree::put_together(scenario, std::move(results), std::move(notes),
                          scree::read_reference(asset_dir() / "reference" / "results.csv"), wall);
  // To stderr as well: a sweep quotes it.
  for (const std::string& failure : result.failures) fmt::print(stderr, "{}\n", failure);
  if (!result.failures.empty()) code = kWatchFailed;
  result.failures.insert(result.failures.begin(), failures.begin(), failures.end());
  scree::write_summary(result, out / "summary.json");
  scree::write_sections_csv(result, out / "sections.csv");
  scree::write_conductivity_csv(result, out / "ksat.csv");
  if (!options.summary_only) {
    scree::SceneFacts scene;
    if (const scree::BenchSpec* bench = scree::bench_of(scenario)) scene.bench_slope = bench->slope_deg;
    scree::write_report(result, out, scene);
  }

  scree::print_result(result);
  fmt::print("\n{}: {}\n", options.summary_only ? "summary" : "report",
             (out / (options.summary_only ? "summary.json" : "report.html")).string());
  return interrupted ? kInterrupted : code;
}
