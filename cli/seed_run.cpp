#include "cli/seed_run.h"

#include <fmt/format.h>

#include <mutex>
#include <new>
#include <optional>
#include <system_error>

#include "cli/commands.h"
#include "cli/results_of.h"
#include "scree_version.h"
#include "sim/io/trajectory.h"

namespace fs = std::filesystem;

namespace {

// HDF5 as packaged is not safe for several threads; frames are rare.
std::mutex trajectory_mutex;

/// The trajectory of a seed; none when the scenario wants none.
class Trajectory {
 public:
  Trajectory(const scree::Scenario& scenario, std::uint64_t seed, const fs::path& folder)
      : scenario_(scenario), seed_(seed), folder_(folder) {}
  ~Trajectory() {
    const std::lock_guard lock(trajectory_mutex);
    writer_.reset();
  }

  bool wanted() const { return scenario_.output.trajectory; }
  void begin(const std::vector<scree::Grain>& grains, const std::vector<scree::Grain>& fixed) {
    const std::lock_guard lock(trajectory_mutex);
    fs::create_directories(folder_);
    writer_ = std::make_unique<scree::TrajectoryWriter>(
        file(), grains, fixed,
        scree::TrajectoryInfo{"scree user", SCREE_VERSION, scenario_.resolved_yaml, seed_});
  }
  void go_on(const std::vector<scree::Grain>& grains, scree::StateReader& saved) {
    const std::lock_guard lock(trajectory_mutex);
    writer_ = std::make_unique<scree::TrajectoryWriter>(file(), grains, saved);
  }
  void write(const scree::Snapshot& snapshot, std::int64_t step) {
    const std::lock_guard lock(trajectory_mutex);
    writer_->write(snapshot, step);
  }
  void save(scree::StateWriter& state) {
    const std::lock_guard lock(trajectory_mutex);
    writer_->save(state);
  }
  void close() {
    const std::lock_guard lock(trajectory_mutex);
    if (writer_) writer_->close();
    writer_.reset();
  }

 private:
  fs::path file() const { return folder_ / "particles.h5"; }

  const scree::Scenario& scenario_;
  std::uint64_t seed_;
  fs::path folder_;
  std::unique_ptr<scree::TrajectoryWriter> writer_;
};

void simulate(const scree::Scenario& scenario, SeedRun& run, const SeedSettings& settings,
              scree::ProgressDisplay& display, std::size_t index) {
  scree::CheckpointHeader header = settings.checkpoint;
  header.seed = run.seed;
  Checkpoints checkpoints(settings.folder, header, settings.checkpoint_minutes);
  const auto warn = [&](const std::string& words) {
    display.say(fmt::format("seed {}: {}; it is passed over", run.seed, words));
  };
  std::optional<scree::FlowRecorder> flow = scree::make_flow_recorder(scenario);
  scree::RunOutcome outcome;
  const auto put_away = [&] {
    run.notes = outcome.notes;
    run.result = std::make_unique<scree::SeedResult>(
        scree::analyse(scenario, run.seed, std::move(outcome), std::move(flow)));
  };

  const auto read = [&](scree::CheckpointReader& finished) {
    finished.state()(outcome);
    if (flow) finished.state()(*flow);
    put_away();
  };
  if (!settings.read_pile.empty())
    return read(*Checkpoints(settings.read_pile, header, 0).pile(settings.pile));
  std::unique_ptr<scree::CheckpointReader> saved;
  if (settings.resume) {
    if (const auto finished = checkpoints.finished(warn)) return read(*finished);
    saved = checkpoints.newest(warn);
    display.say(saved ? fmt::format("seed {} goes on from t = {:.1f} s", run.seed, saved->header().time)
                      : fmt::format("seed {} begins at its beginning: it has no checkpoint", run.seed));
  }

  Trajectory trajectory(scenario, run.seed, settings.folder);
  std::vector<scree::Grain> grains;
  scree::RunHooks hooks;
  if (trajectory.wanted()) {
    hooks.begin = [&](const std::vector<scree::Grain>& all, const std::vector<scree::Grain>& fixed) {
      if (saved)
        grains = all;
      else
        trajectory.begin(all, fixed);
    };
    hooks.frame = [&](const scree::Snapshot& snapshot, std::int64_t step) {
      trajectory.write(snapshot, step);
    };
  }
  if (flow) hooks.look = [&](const scree::Snapshot& snapshot) { flow->add(snapshot); };
  hooks.progress = [&](const scree::RunProgress& p) {
    display.update(index, p);
    return interrupted == 0;
  };
  if (checkpoints.on()) {
    hooks.save_due = [&] { return checkpoints.due() || interrupted != 0; };
    hooks.save = [&](double time, const std::function<void(scree::StateWriter&)>& state) {
      try {
        checkpoints.save(time, [&](scree::StateWriter& writer) {
          state(writer);
          if (flow) writer(*flow);
          if (trajectory.wanted()) trajectory.save(writer);
        });
      } catch (const std::exception& error) {
        // The run itself is well: it goes on, and the next checkpoint may succeed.
        display.say(fmt::format("seed {}: no checkpoint at t = {:.1f} s: {}", run.seed, time, error.what()));
      }
    };
  }
  if (saved) {
    hooks.resume = &saved->state();
    hooks.resumed = [&] {
      if (flow) saved->state()(*flow);
      if (trajectory.wanted()) trajectory.go_on(grains, saved->state());
      saved.reset();
      grains = {};
    };
  }
  outcome = scree::run_scenario(scenario, run.seed, settings.threads, hooks);
  try {
    trajectory.close();
    const auto write = [&](scree::StateWriter& writer) {
      writer(outcome);
      if (flow) writer(*flow);
    };
    if (settings.keep_pile && !outcome.interrupted)
      checkpoints.keep_pile(settings.pile, outcome.simulated_seconds, write);
    try {
      if (checkpoints.on() && settings.keep_finished && !outcome.interrupted)
        checkpoints.finish(outcome.simulated_seconds, write);
    } catch (const std::exception& error) {  // what was to save time, should the rest fail
      display.say(fmt::format("seed {}: {}", run.seed, error.what()));
    }
  } catch (const std::exception& error) {
    run.failure = error.what();  // of a file; the pile itself is good
    run.worth_resuming = true;   // from its last checkpoint, when there is room
  }
  put_away();
}

// With what a user can do about it, where the error does not say so itself.
std::string words_of(const std::exception& error) {
  constexpr const char* kCure =
      "run fewer seeds side by side (--threads 1), or a scenario with fewer spheres";
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr)
    return fmt::format("not enough memory; {}", kCure);
  const auto* of_system = dynamic_cast<const std::system_error*>(&error);
  if (of_system != nullptr && of_system->code() == std::errc::resource_unavailable_try_again)
    return fmt::format("not enough memory, or processes, for another thread; {}", kCure);
  return error.what();
}

}  // namespace

void run_seed(const scree::Scenario& scenario, SeedRun& run, const SeedSettings& settings,
              scree::ProgressDisplay& display, std::size_t index) {
  try {
    simulate(scenario, run, settings, display, index);
  } catch (const scree::BlowUp& error) {
    run.failure = error.what();
    run.blew_up = true;
  } catch (const scree::StateError& error) {
    run.failure = error.what();
    run.does_not_fit = true;
  } catch (const std::invalid_argument& error) {
    run.failure = error.what();
  } catch (const std::exception& error) {
    run.failure = words_of(error);
    run.worth_resuming = true;
  }
}
