#pragma once
// What is known of the runs of a sweep: from a store, or from a table that was exported before.
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analysis/results/finished_runs.h"
#include "cli/ensemble/sweep_file.h"
#include "sim/io/results_store.h"

namespace scree {

/// The runs of every point, in order, as requests to a store. Throws as run_request.
std::vector<RunRequest> requests_of(const Sweep& sweep, const std::filesystem::path& asset_dir);

/// A point of the sweep and its runs, in the order of the seeds; none where a run has not been made.
struct PointResults {
  const SweepPoint* point;
  std::vector<std::uint64_t> seeds;
  std::vector<std::optional<StoredResult>> runs;

  /// Over the seeds whose piles came to rest.
  MeanStd of(const std::string& output) const;
  int count(RunState state) const;
};

FinishedRuns finished(const PointResults& point);

/// What a store has of the runs; `requests` as requests_of gives them.
std::vector<PointResults> look_up(const Sweep& sweep, const std::vector<RunRequest>& requests,
                                  const ResultsStore& store);

/// Names of all numbers that the runs have.
std::set<std::string> output_names(const std::vector<PointResults>& points);

/// A line that names the sweep, then one row a run: the parameters, seed, state, version, wall_seconds, every
/// output, message. Throws std::runtime_error if it cannot be written.
void write_sweep_csv(const Sweep& sweep, const std::vector<PointResults>& points,
                     const std::filesystem::path& file);

/// The runs of this sweep in such a table; rows of other seeds are passed over, those of other points if they
/// are not refused. Throws std::runtime_error, one line `file:line: what is wrong`, if it is not a table of
/// this sweep.
std::vector<PointResults> read_sweep_csv(const Sweep& sweep, const std::filesystem::path& file,
                                         bool refuse_others = true);

/// How an output of a sweep differs from the values printed for the cases that its points name.
struct SweepComparison {
  std::vector<double> printed;     ///< one a point; NaN where nothing is printed
  std::vector<double> difference;  ///< mean over seeds - printed; NaN where there is no run, too
  int compared = 0;                ///< points that have a difference
  double rms = 0, mean = 0;        ///< of the differences
  int worst = -1;                  ///< point with the largest one
};

/// Holds an output (chi_S6, slope_angle_deg, angle_deg and the other readings of the repose angle, ...)
/// against the printed values, PFC3D's before measured ones.
SweepComparison compare_sweep(const std::vector<PointResults>& points, const std::string& output,
                              const std::vector<ReferenceValue>& reference);

}  // namespace scree
