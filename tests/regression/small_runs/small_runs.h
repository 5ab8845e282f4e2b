#pragma once
// Small runs of every experiment, and what they were when they were last stored (small_runs.csv).
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "analysis/results/outputs.h"

namespace scree {

/// Seeds 1 to 40 are stored; the test runs the 8 after them: their piles differ from the stored ones as those
/// of a program with other roundings would.
inline constexpr int kStoredSeeds = 40, kTestedSeeds = 8;
/// Draws behind every p: it is a multiple of 1 / (1 + kDraws).
inline constexpr int kDraws = 19999;

/// Files in tests/regression/small_runs/scenes, by name.
std::vector<std::string> scene_names();

/// The outputs of runs of a scene with the seeds `first`, `first` + 1, ..., two at a time. Throws
/// std::invalid_argument for a scene that does not load, std::runtime_error for a run that broke its watch.
std::vector<Outputs> run_scene(const std::string& scene, std::uint64_t first, int count,
                               const std::vector<std::string>& overrides = {});

/// Numbers of a scene by their names, a value a seed; NaN where a run has none.
using SceneNumbers = std::map<std::string, std::vector<double>>;

/// The outputs that at least a share of the runs have (stored is what half of them have), to 7 digits. Left
/// out are those that the load decides alone (particles, share above 1 m), and those that say the same in
/// other units or nearly the same as others.
SceneNumbers numbers_of(const std::vector<Outputs>& runs, double least_share = 0);

/// small_runs.csv: scene,output, and a column a seed; empty where a run has no such number. Reading throws
/// FileError.
std::filesystem::path stored_numbers_file();
std::map<std::string, SceneNumbers> read_numbers(const std::filesystem::path& file);
void write_numbers(const std::map<std::string, SceneNumbers>& scenes, const std::filesystem::path& file);

/// How far runs of a scene lie from the stored ones.
struct SceneShift {
  struct Number {
    std::string name;
    MeanStd stored, now;
    double z =
        0;  ///< of the mean of ranks (Wilcoxon's sum), over its deviation; a missing value ranks lowest
  };
  std::vector<Number> numbers;  ///< the one that moved most first
  /// Probability that as many of all the runs, drawn by chance, lie as far from the others: by the sum of
  /// z^2, which sees many numbers that moved a little, and by the largest |z|, which sees one that moved
  /// much. Twice the smaller of the two. The draws take account of how numbers hang together.
  double p = 1;
  /// A line for each number that is equal in all stored runs and differs from that in all of these, and for
  /// each that all stored runs have and none of these.
  std::vector<std::string> broken;
};
SceneShift shift_of(const SceneNumbers& stored, const SceneNumbers& now);

/// The same of the tested seeds of a scene, simulated now. Throws as run_scene, and std::invalid_argument for
/// a scene that is not stored.
SceneShift shift_of_tested(const std::map<std::string, SceneNumbers>& stored, const std::string& scene,
                           const std::vector<std::string>& overrides = {});

/// Probability of scenes together: Fisher's sum of -2 ln p over them, chi-square of twice as many degrees of
/// freedom. Small changes that no scene shows alone add up.
double together(const std::vector<double>& p);

}  // namespace scree
