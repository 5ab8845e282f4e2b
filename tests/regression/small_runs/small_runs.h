#pragma once
// Small runs of every experiment, and what they were when they were last stored (small_runs.csv).
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "analysis/outputs.h"

namespace scree {

/// Seeds 1 to 40 are stored; the test runs the 8 after them: another draw, as a change of roundings is one.
inline constexpr int kStoredSeeds = 40, kTestedSeeds = 8;
/// Probability that chance alone makes one scene of the whole suite fail.
inline constexpr double kByChance = 0.01;

/// Files in tests/regression/small_runs/scenes, by name.
std::vector<std::string> scene_names();

/// The outputs of runs of a scene with the seeds `first`, `first` + 1, ..., two at a time. Throws
/// std::invalid_argument for a scene that does not load, std::runtime_error for a run that broke its watch.
std::vector<Outputs> run_scene(const std::string& scene, std::uint64_t first, int count,
                               const std::vector<std::string>& overrides = {});

/// Numbers of a scene by their names, a value a seed.
using SceneNumbers = std::map<std::string, std::vector<double>>;

/// The outputs that all of the runs have, to 7 digits; left out are those that say the same in other units or
/// nearly the same as their neighbours, and the extremes of a run (overlap, lost mass, runaways).
SceneNumbers numbers_of(const std::vector<Outputs>& runs);

/// small_runs.csv: scene,output, and a column a seed. Reading throws std::runtime_error
/// `file:line: what is wrong`.
std::filesystem::path stored_numbers_file();
std::map<std::string, SceneNumbers> read_numbers(const std::filesystem::path& file);
void write_numbers(const std::map<std::string, SceneNumbers>& scenes, const std::filesystem::path& file);

/// How far runs of a scene lie from the stored ones.
struct SceneShift {
  struct Number {
    std::string name;
    MeanStd stored, now;
    double z = 0;  ///< of the mean of ranks (Wilcoxon's sum), over its deviation
  };
  std::vector<Number> numbers;  ///< the one that moved most first
  /// Probability that 8 of all the runs, drawn by chance, lie as far from the others: sum of z^2 over all
  /// numbers, which takes account of how they hang together; 9,999 draws.
  double p = 1;
  /// Numbers that no stored seed changes and that are another in all runs now, or that all runs lack: a line
  /// each.
  std::vector<std::string> broken;
};
SceneShift shift_of(const SceneNumbers& stored, const std::vector<Outputs>& runs);

/// Probability of scenes together: Fisher's sum of -2 ln p over them, chi-square of twice as many degrees of
/// freedom. Small changes that no scene shows alone add up.
double together(const std::vector<double>& p);

}  // namespace scree
