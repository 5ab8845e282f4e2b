#pragma once
// Parameters of a fitted model: what the data say of each, and the value that was simulated.
#include <optional>
#include <string>
#include <vector>

#include "analysis/diagnose/outcome.h"

namespace scree {

/// One parameter of a fitted model, in its unit.
struct FittedParameter {
  std::string label;                ///< material.mu; cohesion.bond_number
  double nominal = 0;               ///< of an effect's amplitude: where it does nothing
  bool has_nominal = true;          ///< an effect's other parameters have none
  double low = 0, high = 0;         ///< ends of its range
  Judgement::Interval within;       ///< 90 % of the probability, and the median
  double fit = 0;                   ///< most likely, by the fitted surfaces
  std::optional<double> simulated;  ///< by the full simulations that are shown
  bool of_effect = false;
  /// The fit, the median or what was simulated, the first of them that lies within kAtEnd of the range's
  /// width from an end of it, that at which an effect does nothing left out.
  std::optional<double> at_end;
};

inline constexpr double kAtEnd = 0.02;

/// Base parameters first. `simulated`: a model with the same effects; may be null.
std::vector<FittedParameter> fitted_parameters(const ModelSpace& space, const Judgement& judgement,
                                               const SimulatedModel* simulated);

/// A model whose parameters are shown.
struct FittedModel {
  const char* name;
  std::vector<FittedParameter> parameters;
};
/// The re-calibrated one, and the one with what was named. Where nothing is missing nothing needs to be
/// re-calibrated, and no parameter is marked as at its end.
std::vector<FittedModel> fitted_models(const DiagnosisOutcome& outcome);

/// The model that an outcome's scenarios hold: what was named, else the re-calibrated one; null without any.
const SimulatedModel* handed_over(const DiagnosisOutcome& outcome);
/// Its parameters; empty without any.
std::vector<FittedParameter> handed_over_parameters(const DiagnosisOutcome& outcome);

}  // namespace scree
