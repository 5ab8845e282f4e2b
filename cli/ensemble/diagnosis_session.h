#pragma once
// The loop of a diagnosis: simulate a design, find, re-calibrate, name, simulate what was named, learn from
// that, and look again.
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/diagnose/outcome.h"
#include "cli/ensemble/model_file.h"
#include "sim/io/results_store.h"

namespace scree {

/// Does runs that are not in the store yet, and returns what the store has of each. The words say what they
/// are for, to a user who waits. Throws Stopped.
using RunThrough = std::function<std::vector<std::optional<StoredResult>>(const std::vector<RunRequest>&,
                                                                          const std::string& what)>;

/// A user has ended the work.
struct Stopped : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A simulation of every experiment in which the point differs from one without effects.
struct PlannedRun {
  ModelPoint at;
  std::uint64_t seed = 0;
  bool where_all_act = false;  ///< only in experiments in which every effect acts; else where one does
};

/// The simulations that a diagnosis needs whatever the data: nominal, over the base parameters, and of every
/// effect; those on measurement, and each two of them, read piles of those over the base parameters. They
/// depend on the model and the effects' names alone, so that all data of the same experiments share them, and
/// leaving an effect out changes nothing for the others.
std::vector<PlannedRun> design_of(const ModelSpace& space, const SimulationCounts& counts);

/// The runs of an experiment among these: those whose effects act in it, or that have none. Throws
/// std::runtime_error if a point is no valid scenario.
struct ExperimentRuns {
  std::vector<PlannedRun> runs;
  std::vector<RunRequest> requests;
};
ExperimentRuns runs_of(const DiagnosisModel& model, const ModelSpace& space,
                       const Dataset::Experiment& experiment, const std::vector<PlannedRun>& planned,
                       const std::filesystem::path& asset_dir);

/// What a run gave of the outputs; nothing if it failed, did not come to rest or misses one of them.
std::optional<Eigen::VectorXd> measured_in(const std::optional<StoredResult>& result,
                                           const std::vector<std::string>& outputs);

/// What such runs gave, by the names of outputs; runs that failed, did not come to rest or miss one of them
/// are left out.
struct GatheredRuns {
  std::vector<DesignRun> runs;
  std::vector<ModelPoint> left_out;  ///< where those were
};
GatheredRuns gather(const ExperimentRuns& planned, const std::vector<std::optional<StoredResult>>& results,
                    const std::vector<std::string>& outputs);

/// Datasets as one: their experiments and numbers. An experiment whose name stands in two of them gets the
/// dataset's name before it.
struct JoinedData {
  std::vector<Dataset::Experiment> experiments;
  Measurements measured;
  std::vector<std::string> notes;
};
JoinedData join_datasets(const std::vector<Dataset>& datasets);

class TriedModels;

class DiagnosisSession {
 public:
  /// `threads`: of surfaces and hypotheses; their number changes nothing.
  DiagnosisSession(const DiagnosisModel& model, JoinedData data, const std::vector<std::string>& without,
                   std::filesystem::path asset_dir, int threads = 1);

  const ModelSpace& space() const { return space_; }
  const JoinedData& data() const { return data_; }
  /// Simulations of the design, by experiment.
  const std::vector<ExperimentRuns>& design() const { return design_; }
  /// Rounds that may follow the design, and simulations in each.
  int most_rounds() const;
  int most_in_a_round() const;
  /// Simulations of one model, over all experiments.
  int of_a_model() const;
  /// Throws Stopped; std::runtime_error if too few simulations gave the numbers; what `run` throws.
  DiagnosisOutcome run(const RunThrough& run);

 private:
  std::vector<ExperimentRuns> in_every_experiment(const std::vector<PlannedRun>& planned) const;
  void learn_from(const std::vector<ExperimentRuns>& runs, const std::string& what, const RunThrough& run,
                  DiagnosisOutcome& outcome);
  SimulatedModel simulate(const ModelPoint& point, const RunThrough& run, DiagnosisOutcome& outcome);
  // Learns from simulations spread over what the data leave open of a hypothesis.
  void explore(const std::vector<ModelPoint>& points, const RunThrough& run, DiagnosisOutcome& outcome);
  // Simulates what leads, its rivals, and what the data leave open of them. Whether there was anything to do.
  bool one_round(const Diagnosis& d, const LearntModel& model, TriedModels& tried, const RunThrough& run,
                 DiagnosisOutcome& outcome);
  // What its own simulations contradict is not said: those of the last fit and fresh ones, and, of effects,
  // those of every fit before.
  void say_what_stands(Diagnosis& d, TriedModels& tried, DiagnosisOutcome& outcome);
  std::vector<SimulatedPoints> simulated() const;
  LearntModel learn() const;
  // How the model foretold the simulations after the first so many, by experiment.
  void compare(const LearntModel& model, const std::vector<std::size_t>& known);
  SimulatedModel nominal_of_design() const;
  std::vector<NextMeasurement> tell_apart(const DiagnosisOutcome& outcome) const;

  const DiagnosisModel& model_;
  JoinedData data_;
  std::filesystem::path asset_dir_;
  int threads_;
  ModelSpace space_;
  std::vector<ExperimentRuns> design_;
  DesignRuns learnt_;
  std::vector<std::vector<ModelPoint>> gave_nothing_;  // failed or lack a measured number; by experiment
  std::vector<std::vector<Forecast>> forecasts_;       // by experiment
  struct WholeRun {
    ModelPoint at;
    std::map<std::string, double> outputs;
    std::string pile;
  };
  std::vector<std::vector<WholeRun>> everything_;  // for what was not measured; by experiment
  std::vector<std::string> failure_;               // the last of each experiment, why; empty without one
  std::set<std::string> used_;                     // keys of the simulations that gave what was measured
  std::string stage_;                              // of the diagnosis, for a user who waits
  std::uint64_t checks_ = 0;                       // seeds used for fits and what is open of them
};

}  // namespace scree
