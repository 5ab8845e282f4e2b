#pragma once
// From a scenario and a seed to a pile.
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/io/snapshot_state.h"
#include "sim/scene/scenario.h"
#include "sim/world/rock_world.h"

namespace scree {

/// How far a run is.
struct RunProgress {
  double share = 0;  ///< of the whole run, 0 to 1, an estimate
  double time = 0;   ///< simulated, s
  int dump = 0, dumps = 0;
  double moving_share = 0;     ///< of the load's mass
  std::int64_t particles = 0;  ///< in the model now
  double particle_steps = 0;   ///< so far
  const char* stage = "";      ///< "settling", "dumping", "lifting"
};

/// What a run tells while it goes on.
struct RunHooks {
  /// Every grain that will be dumped, at its place in the container, and the fixed balls; before the first
  /// step.
  std::function<void(const std::vector<Grain>& grains, const std::vector<Grain>& fixed)> begin;
  /// A frame of the trajectory.
  std::function<void(const Snapshot&, std::int64_t step)> frame;
  /// The movable spheres, ten times a second of simulated time.
  std::function<void(const Snapshot&)> look;
  /// Some ten times a second of simulated time; returning false ends the run, keeping what is done.
  std::function<bool(const RunProgress&)> progress;

  /// Asked after `progress`, as often; true: `save` is called. Not asked of an engine that cannot be saved
  /// (RockWorld::keeps_state).
  std::function<bool()> save_due;
  /// Takes the state of the run: everything from which it goes on with the same bits.
  std::function<void(double time, const std::function<void(StateWriter&)>& state)> save;
  /// A state that `save` was given for the same scenario and seed; the run goes on from there. None of the
  /// others but `begin` is called for what was done before.
  StateReader* resume = nullptr;
  /// All of that state has been read, and the run is as it was.
  std::function<void()> resumed;
};

/// What a run ends with.
struct RunOutcome {
  Snapshot final_state;
  struct AfterDump {
    int dump;
    Snapshot pile;

    template <class Stream>
    void state(Stream& stream) {
      stream(dump, pile);
    }
  };
  std::vector<AfterDump> after_dumps;    ///< the piles asked for in output.after_dumps, but for the last
  std::vector<Grain> original;           ///< every grain as generated
  std::vector<Grain> fixed;              ///< balls of the base layer
  std::optional<double> rebound_height;  ///< drop test: highest rise of its lowest point after the fall, m
  double carried_back = 0;  ///< kg, that left with the bed or bucket; not in the pile
  WorldStatistics statistics;
  std::optional<EnergyBalance> energy;  ///< closed at the end; none with engine impulse
  double simulated_seconds = 0, wall_seconds = 0;
  bool at_rest = true;  ///< every load came to rest before stop.max_time
  bool interrupted = false;
  std::vector<std::string> notes;

  /// Every member, to keep a seed that has come to its end.
  template <class Stream>
  void state(Stream& stream) {
    stream(final_state, after_dumps, original, fixed, rebound_height, carried_back, statistics, energy,
           simulated_seconds, wall_seconds, at_rest, interrupted, notes);
  }
};

/// Runs one seed with `threads` worker threads. Throws BlowUp, std::runtime_error (meshes),
/// std::invalid_argument (rock that does not fit its container), StateError (`hooks.resume` does not fit).
RunOutcome run_scenario(const Scenario& scenario, std::uint64_t seed, int threads, const RunHooks& hooks);

}  // namespace scree
