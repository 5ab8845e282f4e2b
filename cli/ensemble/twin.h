#pragma once
// Twins: data of which the truth is known, because a simulation made them, with an effect in it or none.
#include <filesystem>
#include <string>
#include <vector>

#include "cli/ensemble/dataset_write.h"
#include "cli/ensemble/diagnosis_session.h"

namespace scree {

struct TwinSpec {
  std::vector<std::string> effects;  ///< hidden ones, of twin_space; none: base parameters alone are off
  double strength = 4;               ///< what detectability() each effect has on its own
  int repeats = 5;                   ///< of every experiment
  double noise =
      0.5;  ///< standard deviation of a measurement's error over that between seeds, of every repeat
  std::uint64_t seed = 1;
  std::string engine;  ///< that makes the data; empty: that of the scenarios
};

/// What was hidden.
struct TwinTruth {
  ModelPoint at;
  std::vector<double> detectability;  ///< of each effect
};

struct Twin {
  TwinTruth truth;
  DatasetDraft data;
};

/// A strength that an effect does not reach within its prior range.
struct TooWeak : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a twin is drawn from: the model's parameters, and those of its effects that act in its experiments.
ModelSpace twin_space(const DiagnosisModel& model, const std::filesystem::path& asset_dir);

/// Draws base parameters from the inner part of their ranges and a direction for every effect, looks for the
/// amplitude at which the effect shifts the model's observables by `strength` standard uncertainties (root
/// mean square, after the base parameters have made up for what they can; by simulations with and without the
/// effect, within some tenth of it), simulates the model's experiments
/// with seeds that no diagnosis uses (again with another where one gives no measurement, up to twice as many
/// as repeats), and adds errors of measurement. `design` does simulations of the base model, `hidden` those
/// about the truth. Throws TooWeak; std::runtime_error; what these
/// throw.
Twin make_twin(const DiagnosisModel& model, const TwinSpec& spec, const std::filesystem::path& asset_dir,
               const RunThrough& design, const RunThrough& hidden);

/// The sealed answer: JSON with effects, values and base parameters.
std::string twin_answer(const DiagnosisModel& model, const TwinSpec& spec, const TwinTruth& truth,
                        const std::filesystem::path& asset_dir);

}  // namespace scree
