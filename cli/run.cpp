// scree run: a scenario, its seeds side by side, and what comes of it in a folder.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>

#include "analysis/report/conductivity_table.h"
#include "analysis/report/report.h"
#include "analysis/results/summary.h"
#include "cli/commands.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "cli/printed_values.h"
#include "cli/progress.h"
#include "cli/results_of.h"
#include "cli/run_folder.h"
#include "cli/seed_run.h"
#include "cli/table.h"
#include "sim/io/text_file.h"
#include "sim/io/trajectory.h"
#include "sim/material/in_parallel.h"
#include "sim/material/input_bytes.h"
#include "sim/scene/scenario_keys.h"

namespace fs = std::filesystem;

namespace {

// The seeds of a run: `count` of them, those of the scenario first; none if the integers end before.
std::vector<std::uint64_t> chosen_seeds(const scree::Scenario& scenario, int count) {
  std::vector<std::uint64_t> seeds = scenario.seeds;
  if (count == 0) return seeds;
  while (static_cast<int>(seeds.size()) < count) {
    const std::uint64_t last = *std::max_element(seeds.begin(), seeds.end());
    if (last == scree::kLargestSeed) return {};
    seeds.push_back(last + 1);
  }
  seeds.resize(static_cast<std::size_t>(count));
  return seeds;
}

constexpr double kDying = 10;  // s that a killed process may take to end

/// What is to be run, where.
struct Plan {
  scree::Scenario scenario;
  fs::path out;
  fs::path pile;  // run folder with the piles to be read; empty: simulate
  bool resume = false, summary_only = false;
  std::vector<std::string> warnings;  // of the scenario
  std::vector<scree::ReferenceValue> reference;
  RunRecord record;
  std::unique_ptr<FolderLock> lock;

  bool checkpoints() const { return record.checkpoint_minutes > 0; }
};

// These throw std::runtime_error with what to do about it.

// Every seed's pile is there and fits.
void check_piles(const Plan& plan) {
  std::error_code none;
  if (fs::equivalent(plan.pile, plan.out, none))
    throw std::runtime_error(
        fmt::format("--pile {}: is the folder of the new run, too; give another --out", plan.pile.string()));
  const std::string hash = pile_hash(plan.scenario);
  for (const std::uint64_t seed : plan.scenario.seeds)
    Checkpoints(scree::seed_folder(plan.pile, seed), {program_version(), {}, seed, 0}, 0).pile(hash);
}

std::optional<Plan> plan_new(const RunOptions& options) {
  if (!is_of_kind(options.file, scree::FileKind::scenario)) return std::nullopt;
  scree::ScenarioResult loaded = scree::load_scenario(options.file, options.overrides, asset_dir());
  if (!nothing_wrong(loaded.errors, loaded.warnings)) return std::nullopt;
  Plan plan;
  plan.scenario = std::move(loaded.scenario);
  plan.warnings = std::move(loaded.warnings);
  plan.scenario.seeds = chosen_seeds(plan.scenario, options.seeds);
  if (plan.scenario.seeds.empty())
    throw std::runtime_error(fmt::format(
        "--seeds {}: no integers follow the scenario's last seed; give them in its file", options.seeds));
  plan.out = options.out.empty() ? free_run_folder(plan.scenario.name) : options.out;
  plan.pile = options.pile;
  if (!plan.pile.empty()) {
    check_piles(plan);
    if (plan.scenario.output.trajectory)
      fmt::print(stderr, "warning: a pile that is read has no trajectory; none is written\n");
  }
  if (!prepare_folder(plan.out, options.force)) return std::nullopt;
  plan.lock = std::make_unique<FolderLock>(plan.out);
  plan.summary_only = options.summary_only;
  plan.record = {
      program_version(),  scenario_hash(plan.scenario),
      plan.scenario.name, plan.scenario.seeds,
      plan.summary_only,  options.checkpoint_minutes < 0 ? kCheckpointMinutes : options.checkpoint_minutes,
      options.keep_pile};
  if (!plan.pile.empty()) plan.record.checkpoint_minutes = 0;  // nothing that could be resumed
  return plan;
}

std::optional<Plan> plan_resumed(const RunOptions& options) {
  Plan plan;
  plan.resume = true;
  plan.out = options.resume;
  plan.lock = std::make_unique<FolderLock>(plan.out, kDying);
  plan.record = read_record(plan.out);  // as whoever held the folder has left it
  const fs::path file = plan.out / "scenario.yaml";
  scree::ScenarioResult loaded = scree::load_scenario(file, {}, asset_dir());
  if (!nothing_wrong(loaded.errors, loaded.warnings)) return std::nullopt;
  plan.scenario = std::move(loaded.scenario);
  plan.warnings = std::move(loaded.warnings);
  if (plan.record.program != program_version())
    throw std::runtime_error(
        fmt::format("{}: begun by {}, this is {}: the numbers may differ. Resume with that program, or start "
                    "anew: scree run {} --out NEW",
                    plan.out.string(), plan.record.program, program_version(), file.string()));
  if (plan.record.scenario != scenario_hash(plan.scenario))
    throw std::runtime_error(
        fmt::format("{}: this file, or a grading or mesh that it names, has changed since the run began. Put "
                    "it back, or start anew: scree run {} --out NEW",
                    file.string(), file.string()));
  plan.scenario.name = plan.record.name;
  plan.scenario.seeds = plan.record.seeds;
  plan.summary_only = plan.record.summary_only || options.summary_only;
  if (options.checkpoint_minutes >= 0) plan.record.checkpoint_minutes = options.checkpoint_minutes;
  return plan;
}

std::optional<Plan> make_plan(const RunOptions& options) {
  try {
    std::optional<std::vector<scree::ReferenceValue>> reference = printed_values();
    if (!reference) return std::nullopt;
    std::optional<Plan> plan = options.resume.empty() ? plan_new(options) : plan_resumed(options);
    if (plan) plan->reference = std::move(*reference);
    return plan;
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "scree: {}\n", scree::one_line(error.what()));
    return std::nullopt;
  }
}

void forget_checkpoints(const Plan& plan) {
  remove_record(plan.out);
  for (const std::uint64_t seed : plan.scenario.seeds) {
    scree::TrajectoryWriter::forget_saved(scree::seed_folder(plan.out, seed) / "particles.h5");
    Checkpoints::remove_from(scree::seed_folder(plan.out, seed));
  }
}

// What a report of this folder consists of: of an older run it must not stand beside numbers of this one.
void forget_report(const Plan& plan) {
  std::error_code ignored;
  if (!fs::remove(plan.out / "report.html", ignored)) return;  // whose pictures these are is not known
  for (const auto& entry : fs::directory_iterator(plan.out / "pictures", ignored))
    if (entry.path().extension() == ".svg" || entry.path().extension() == ".png")
      fs::remove(entry.path(), ignored);
  fs::remove(plan.out / "pictures", ignored);  // if that was all
}

// What another run has left in the folder, with --force: all that a run writes, of whatever seeds.
void forget_run(const Plan& plan) {
  remove_record(plan.out);
  forget_report(plan);
  std::error_code ignored;
  for (const char* file : {"summary.json", "sections.csv", "ksat.csv"}) fs::remove(plan.out / file, ignored);
  for (const fs::path& folder : scree::seed_folders(plan.out)) {
    Checkpoints::remove_pile_from(folder);
    scree::TrajectoryWriter::forget_saved(folder / "particles.h5");
    for (const char* file : {"particles.h5", "particles.xdmf", "particles.xyz"})
      fs::remove(folder / file, ignored);
    Checkpoints::remove_from(folder);
  }
}

// The folder as it is before the first step.
void begin_folder(const Plan& plan) {
  forget_run(plan);
  scree::write_text_file(plan.out / "scenario.yaml", plan.scenario.resolved_yaml);
  if (plan.checkpoints()) write_record(plan.out, plan.record);
}

// Every seed, side by side on `threads` threads; when the user ends the run, no further one is begun.
std::vector<SeedRun> run_seeds(const Plan& plan, int threads) {
  const scree::Scenario& scenario = plan.scenario;
  std::vector<SeedRun> runs(scenario.seeds.size());
  for (std::size_t k = 0; k < runs.size(); ++k) runs[k].seed = scenario.seeds[k];
  const int side_by_side = std::min<int>(threads, static_cast<int>(runs.size()));
  SeedSettings settings;
  settings.threads = std::max(1, threads / side_by_side);
  settings.checkpoint.program = plan.record.program;
  settings.checkpoint.scenario = plan.record.scenario;
  settings.checkpoint_minutes = plan.record.checkpoint_minutes;
  settings.resume = plan.resume;
  settings.keep_finished = runs.size() > 1 || !plan.summary_only;  // a report may fail
  if (plan.record.keep_pile || !plan.pile.empty()) settings.pile = pile_hash(scenario);
  settings.keep_pile = plan.record.keep_pile;
  scree::ProgressDisplay display(scenario.seeds);
  scree::in_parallel(runs.size(), side_by_side, [&](std::size_t k) {
    if (interrupted) return;
    SeedSettings own = settings;
    own.folder = scree::seed_folder(plan.out, runs[k].seed);
    if (!plan.pile.empty()) own.read_pile = scree::seed_folder(plan.pile, runs[k].seed);
    run_seed(scenario, runs[k], own, display, k);
  });
  display.finish();
  return runs;
}

/// What the seeds came to.
struct EndedSeeds {
  std::vector<scree::SeedResult> results;
  std::vector<std::string> notes, failures;
  int code = kOk;
  bool worth_resuming = false, keep_checkpoints = false;
};

// Takes the results out of `runs`, and says what failed.
EndedSeeds take_results(const Plan& plan, std::vector<SeedRun>& runs) {
  EndedSeeds ended;
  const auto any = [&](bool SeedRun::*what) {
    return std::any_of(runs.begin(), runs.end(), [&](const SeedRun& run) { return run.*what; });
  };
  ended.worth_resuming =
      (plan.checkpoints() || plan.resume) && (interrupted || any(&SeedRun::worth_resuming));
  ended.keep_checkpoints = ended.worth_resuming || any(&SeedRun::does_not_fit);
  for (SeedRun& run : runs) {
    if (!run.failure.empty()) {
      ended.code = std::max<int>(ended.code, run.blew_up        ? kWatchFailed
                                             : run.does_not_fit ? kBadInput
                                                                : kFailed);
      ended.failures.push_back(fmt::format("seed {}: {}", run.seed, run.failure));
      fmt::print(stderr, "{}\n", ended.failures.back());
    }
    ended.notes.insert(ended.notes.end(), run.notes.begin(), run.notes.end());
    if (run.result) ended.results.push_back(std::move(*run.result));
    if (!run.result && run.failure.empty())
      ended.notes.push_back(fmt::format("seed {} was not run: the user ended the run", run.seed));
  }
  // An unfinished pile must not be averaged with finished ones.
  const auto unfinished = [](const scree::SeedResult& r) { return r.interrupted; };
  if (!std::all_of(ended.results.begin(), ended.results.end(), unfinished)) {
    for (const scree::SeedResult& r : ended.results)
      if (unfinished(r))
        ended.notes.push_back(fmt::format(
            "seed {} was ended by the user and is left out; its frames are in seed_{}", r.seed, r.seed));
    std::erase_if(ended.results, unfinished);
  }
  return ended;
}

/// Gives why the report lacks pictures.
std::vector<std::string> write_results(const Plan& plan, const scree::RunResult& result) {
  scree::write_summary(result, plan.out / "summary.json");
  scree::write_sections_csv(result, plan.out / "sections.csv");
  scree::write_conductivity_csv(result, plan.out / "ksat.csv");
  if (plan.summary_only) {
    forget_report(plan);  // of the part before, where it was resumed
    return {};
  }
  scree::SceneFacts scene;
  if (const scree::BenchSpec* bench = bench_of(plan.scenario)) scene.bench_slope = bench->slope_deg;
  return scree::write_report(result, plan.out, scene);
}

}  // namespace

int run_run(const RunOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const std::optional<Plan> made = make_plan(options);
  if (!made) return kBadInput;
  const Plan& plan = *made;
  if (!plan.resume) begin_folder(plan);
  std::vector<SeedRun> runs = run_seeds(plan, cores_or(options.threads));
  EndedSeeds ended = take_results(plan, runs);
  ended.notes.insert(ended.notes.begin(), plan.warnings.begin(), plan.warnings.end());
  const auto end = [&](int code) {
    if (ended.worth_resuming) fmt::print(stderr, "to go on: scree run --resume {}\n", plan.out.string());
    if (!ended.keep_checkpoints) forget_checkpoints(plan);
    return interrupted ? kInterrupted : code;
  };
  if (ended.results.empty()) {
    fmt::print(stderr, "no seed came to a result; what was written is in {}\n", plan.out.string());
    return end(std::max<int>(ended.code, kFailed));
  }
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  scree::RunResult result = scree::put_together(plan.scenario, std::move(ended.results),
                                                std::move(ended.notes), plan.reference, wall);
  // To stderr as well: a sweep quotes it.
  for (const std::string& failure : result.failures) fmt::print(stderr, "{}\n", failure);
  const int code = result.failures.empty() ? ended.code : static_cast<int>(kWatchFailed);
  result.failures.insert(result.failures.begin(), ended.failures.begin(), ended.failures.end());
  std::vector<std::string> missing;
  try {
    missing = write_results(plan, result);
  } catch (const std::exception& error) {  // no gnuplot, a full disk
    fmt::print(stderr, "scree: {}\n", scree::one_line(error.what()));
    if (fs::exists(plan.out / "summary.json"))
      fmt::print(stderr, "the numbers are in {}\n", (plan.out / "summary.json").string());
    ended.worth_resuming = ended.keep_checkpoints = plan.checkpoints() || plan.resume;
    return end(std::max<int>(code, kFailed));
  }
  scree::print_result(result);
  fmt::print("\n");
  if (!plan.summary_only) return end(std::max(code, tell_report(plan.out, missing)));
  fmt::print("summary: {}\n", (plan.out / "summary.json").string());
  return end(code);
}
