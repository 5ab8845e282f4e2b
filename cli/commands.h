#pragma once
// The subcommands; each returns the exit code of the program.
#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/ensemble/exit_code.h"

/// Wall time between checkpoints of a run, where nothing else is said.
inline constexpr double kCheckpointMinutes = 5;

struct RunOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides;
  int seeds = 0;                 ///< 0: those of the scenario
  int threads = 0;               ///< 0: as many as cores
  std::filesystem::path out;     ///< empty: a free runs/NAME
  bool force = false;            ///< write into a folder that is not empty
  bool summary_only = false;     ///< no report, no pictures
  std::filesystem::path resume;  ///< run folder to go on with; the others but threads are those it began with
  double checkpoint_minutes =
      -1;                      ///< wall time between checkpoints; 0: none; below: as it began, or the default
  bool keep_pile = false;      ///< leave the finished pile of every seed for others
  std::filesystem::path pile;  ///< run folder whose piles are read instead of simulated; empty: none
};

/// How the runs of an ensemble are done and kept.
struct EnsembleOptions {
  std::filesystem::path store;  ///< empty: runs/store.sqlite
  int jobs = 0;                 ///< runs side by side, threads of fewer; 0: as many as cores
  bool again = false;           ///< try runs that failed before again
  double checkpoint_minutes = kCheckpointMinutes;  ///< of each run; 0: none
};

struct SweepOptions {
  std::filesystem::path file;
  EnsembleOptions ensemble;
  bool list = false;           ///< show what is there, run nothing
  bool failed = false;         ///< show what failed, run nothing
  std::filesystem::path from;  ///< take the runs from this exported table, not from a store; run nothing
  std::filesystem::path csv;   ///< export to this file
  std::filesystem::path plot;  ///< draw into this file (SVG)
  std::string output;          ///< what is shown and drawn; empty: the repose angle, or chi
};

struct CalibrateOptions {
  std::filesystem::path file;
  EnsembleOptions ensemble;
  std::filesystem::path out;  ///< empty: a free runs/NAME
  bool force = false;         ///< write into a folder that is not empty
};

struct PredictOptions {
  std::filesystem::path file;       ///< a sweep
  std::filesystem::path store;      ///< empty: runs/store.sqlite
  std::vector<std::string> values;  ///< "material.mu=0.25"
  std::string output;               ///< empty: the repose angle
  std::filesystem::path from;       ///< take the runs from this exported table, not from a store
};

struct ReproduceOptions {
  std::vector<std::string> cases;  ///< names of files in scenarios/thesis; empty: all
  int seeds = 0;                   ///< of each, at most; 0: all that the case has
  EnsembleOptions ensemble;
  std::filesystem::path out;   ///< empty: runs/reproduction
  bool list = false;           ///< report what is there, run nothing
  bool force = false;          ///< write into a folder that is not empty
  std::filesystem::path from;  ///< take the runs from this exported table; run nothing
  std::filesystem::path csv;   ///< export to this file
};

struct StudyOptions {
  std::filesystem::path file;
  std::string rank_by;  ///< a criterion; empty: that of the file
  EnsembleOptions ensemble;
  std::filesystem::path out;  ///< empty: a free runs/NAME
  bool list = false;          ///< report what is there, run nothing
  bool force = false;         ///< write into a folder that is not empty
};

struct AnalyseOptions {
  std::vector<std::filesystem::path> files;  ///< snapshots, one a repeat
  std::filesystem::path scenario;            ///< this, or `experiment`
  std::string experiment;                    ///< a type that needs no scenario
  std::vector<std::string> overrides;
  std::optional<int> frame;                    ///< from 1; none: the last
  std::string length_unit;                     ///< of files that state none; empty: m
  std::string up = "z";                        ///< axis that points up, z or y
  std::string shift;                           ///< "x,y,z", m; empty: none
  std::filesystem::path out;                   ///< folder for a dataset; empty: none
  bool force = false;                          ///< write into a folder that is not empty
  std::vector<std::string> observables;        ///< that go into the dataset; empty: those of the core
  std::optional<double> relative_uncertainty;  ///< of values with one repeat
};

struct DiagnoseOptions {
  std::vector<std::filesystem::path> datasets;
  std::filesystem::path model;
  std::vector<std::string> without;  ///< effects that are not considered
  EnsembleOptions ensemble;
  std::filesystem::path out;  ///< empty: a free runs/NAME
  bool plan = false;          ///< say what it will cost, run nothing
  bool force = false;         ///< write into a folder that is not empty
};

struct TwinOptions {
  std::filesystem::path model;
  std::vector<std::string> effects;   ///< names, or none, or random
  std::string strength = "random";    ///< weak, medium, strong, random, or a number
  int repeats = 5;                    ///< of every experiment
  double noise = 0.5;                 ///< of a measurement, over the scatter between seeds
  std::optional<std::uint64_t> seed;  ///< none: of the clock
  std::string engine;                 ///< that makes the data; empty: that of the scenarios
  EnsembleOptions ensemble;
  std::filesystem::path out;     ///< empty: a free runs/twin
  std::filesystem::path answer;  ///< empty: OUT.answer.json
  bool force = false;            ///< write into a folder that is not empty
};

struct EffectsOptions {
  std::string name;       ///< empty: all, a line each
  bool document = false;  ///< docs/effects.md
};

int run_analyse(const AnalyseOptions& options);
int run_diagnose(const DiagnoseOptions& options);
int run_twin(const TwinOptions& options);
int run_run(const RunOptions& options);
int run_compare(const std::filesystem::path& dir, const std::vector<std::string>& cases);
int run_validate(const std::filesystem::path& file, const std::vector<std::string>& overrides);
int run_schema(bool document);
int run_effects(const EffectsOptions& options);
int run_calibrate(const CalibrateOptions& options);
int run_predict(const PredictOptions& options);
int run_sweep(const SweepOptions& options);
int run_reproduce(const ReproduceOptions& options);
int run_study(const StudyOptions& options);

/// The project's assets folder.
std::filesystem::path asset_dir();

/// The command as it was given, as a shell takes it.
std::string command_line();

/// Set by Ctrl-C; a run looks at it and ends cleanly.
/// Its value is the signal; 0: none.
extern std::atomic<int> interrupted;
