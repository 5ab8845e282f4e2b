#pragma once
// What all experiments share: a world, time that goes on with frames and progress, rest, and being saved.
#include <chrono>
#include <functional>
#include <memory>

#include "sim/scene/run.h"

namespace scree {

/// How a truck or a bucket leaves.
struct Departure {
  int mesh;
  Pose pose;                                      ///< where it stands
  Vec3 way;                                       ///< m
  double acceleration;                            ///< m/s2
  double speed;                                   ///< m/s, at most
  std::function<bool(const Vec3& place)> inside;  ///< whether rock is in it while it stands
};

class Stage {
 public:
  Stage(const Scenario& scenario, std::uint64_t seed, int threads, const RunHooks& hooks,
        const Vec3& domain_low, const Vec3& domain_high);

  RockWorld& world() { return *world_; }
  /// What the scenario's effects change.
  const Modifications& changes() const { return model_.changes; }

  /// Surface of a tool or of the ground: its own friction where given, the rock's otherwise, with what
  /// effects make of it.
  Surface tool_surface(const std::optional<double>& mu, const std::optional<double>& mu_r) const;
  Surface ground_surface(const std::optional<double>& mu = {}, const std::optional<double>& mu_r = {}) const;
  /// Reads a mesh that the scenario check has passed already; throws std::runtime_error if it is bad now.
  TriangleMesh read(const std::filesystem::path& mesh, double scale) const;
  /// Puts the user's own tools into the scene.
  void add_tools();

  /// Tells the hooks what will come. `loads` holds every grain in order of dumping; ids follow the fixed
  /// balls.
  void begin(const std::vector<NewSphere>& fixed, const std::vector<std::vector<NewSphere>>& loads);
  /// Adds the next load, `lift` (m) above its place.
  void add_load(double lift = 0);
  /// Gives the load added last a velocity (m/s).
  void push_load(const Vec3& velocity);
  /// Something a reader of the result should know.
  void note(std::string text) { outcome_.notes.push_back(std::move(text)); }

  /// Something that the experiment learns from the world and acts on: look(), a number. When a run is taken
  /// up again it is what was learnt then; nothing else may be read of the world but its time.
  template <class Look>
  double observe(const Look& look) {
    if (replaying()) return recall();
    observed_.push_back(look());
    return observed_.back();
  }

  /// Advances by `seconds`; false when the user ended the run. `share_now`, `share_then`: of the whole run,
  /// for progress.
  bool advance(double seconds, const char* stage, double share_now, double share_then);
  /// Advances until the load has come to rest (stop rule) or max_time has passed, which is noted.
  bool advance_to_rest(const char* stage, double share_now, double share_then);

  void set_dump(int dump, int dumps) { progress_.dump = dump, progress_.dumps = dumps; }
  /// A tool that held a load leaves. Where there is rock in it still, it moves off, so that what the heap
  /// before it held back runs out, and what is in it at the end is taken along (carried_back). False
  /// when the user ended the run.
  bool leave_with_tool(const Departure& departure, double share_now, double share_then);
  /// The load of this number is at rest and its truck gone: keeps the pile if it was asked for.
  void dump_done(int dump, int dumps);
  /// The outcome. Unless the user ended the run, the user's own tools go to the end of their way before, and
  /// what they moved comes to rest.
  RunOutcome finish();

 private:
  // A run that is taken up again begins at its beginning: the experiment loads the trucks and moves the tools
  // as before, but its ticks only pass the time, and what it observes comes from the saved record. The tick
  // in which the state was saved brings that state back, and from there on the world steps again.
  bool replaying() const { return ticks_ < saved_ticks_; }
  double recall();
  void save();
  void take_up();
  template <class Stream>
  void state(Stream& stream);

  bool tick(double until, const char* stage, double share);
  Surface surface(const std::optional<double>& mu, const std::optional<double>& mu_r) const;

  const Scenario& scenario_;
  const EffectiveModel model_;
  std::uint64_t seed_;
  const RunHooks& hooks_;
  std::unique_ptr<RockWorld> world_;
  RunOutcome outcome_;
  RunProgress progress_;
  std::vector<std::vector<NewSphere>> loads_;
  std::size_t next_load_ = 0;
  double load_mass_ = 0;
  double tools_end_ = 0;  // s, when the last of the user's own tools stands still
  double next_frame_ = 0;
  std::int64_t ticks_ = 0, saved_ticks_ = 0;
  std::vector<double> observed_;  // everything that was, in order
  std::size_t recalled_ = 0;
  double wall_before_ = 0;  // s, of what was done before the run was taken up
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The experiments; each runs a stage from its beginning to its end.
RunOutcome run_end_dump(const Scenario& scenario, const EndDump& experiment, std::uint64_t seed, int threads,
                        const RunHooks& hooks);
RunOutcome run_repose_lift(const Scenario& scenario, const ReposeLift& experiment, std::uint64_t seed,
                           int threads, const RunHooks& hooks);
RunOutcome run_push_dump(const Scenario& scenario, const PushDump& experiment, std::uint64_t seed,
                         int threads, const RunHooks& hooks);
RunOutcome run_bucket_dump(const Scenario& scenario, const BucketDump& experiment, std::uint64_t seed,
                           int threads, const RunHooks& hooks);
RunOutcome run_drop_test(const Scenario& scenario, const DropTest& experiment, std::uint64_t seed,
                         int threads, const RunHooks& hooks);

}  // namespace scree
