#pragma once
// Full simulations of hypotheses at their fitted parameters, and what they say of them.
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/diagnose/outcome.h"

namespace scree {

/// Too few simulations of a model gave what was measured.
struct TooFewRuns : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class TriedModels {
 public:
  /// Simulates a model; throws TooFewRuns.
  using Simulate = std::function<SimulatedModel(const ModelPoint&)>;
  /// Of a diagnosis that goes on, and the surfaces it is of: both are looked at as they are when something is
  /// asked, and must live as long as this.
  TriedModels(const ModelSpace& space, const Diagnosis& diagnosis, const LearntModel& model,
              Simulate simulate);

  /// Simulates a hypothesis at its fit unless it is up to date. Whether there was anything to do. Throws
  /// TooFewRuns of the base model.
  bool simulate(const Judgement& judgement);
  /// Simulates it there with fresh seeds, whatever there is. Throws TooFewRuns.
  void simulate_again(const Judgement& judgement);

  /// Its last model lies at its fit, or one there could not be simulated.
  bool up_to_date(const Judgement& judgement) const;
  /// Its fit could not be simulated.
  bool failed(const Judgement& judgement) const;
  /// The last model with these effects; none: nullptr.
  const SimulatedModel* last(const Judgement& judgement) const;
  /// Of all those with these effects, the one nearest to the data, with its gap; there is one.
  SimulatedModel best(const Judgement& judgement) const;
  Gap gap_of(const SimulatedModel& each) const;

  /// Simulations at the fitted values do not give the data, whatever surfaces say.
  bool contradicts(const Judgement& judgement) const;
  /// A model with these effects that was simulated gives the data.
  bool bears_out(const Judgement& judgement) const;
  /// Effects whose fit is contradicted or could not be simulated, and that no model has borne out; empty
  /// ones: the base model at its fit.
  Contradicted contradicted() const;
  /// Base parameters alone do not give the data.
  bool more_than_calibration() const;
  /// What may be said: of effects, that a model with them gives the data; of re-calibration, that its last
  /// fit does.
  bool may_be_said(const Judgement& judgement) const;

  /// Why the last fits of hypotheses could not be simulated, by their effects.
  struct Failure {
    ModelPoint at;
    std::string why;
  };
  const std::map<std::vector<std::size_t>, Failure>& failures() const { return failures_; }

 private:
  // The fit has not moved from there.
  bool is_fit(const ModelPoint& at, const Judgement& judgement) const;

  const ModelSpace& space_;
  const Diagnosis& diagnosis_;
  const LearntModel& model_;
  Simulate simulate_;
  std::map<std::vector<std::size_t>, std::vector<SimulatedModel>> models_;  // by effects; the last one last
  std::map<std::vector<std::size_t>, Failure> failures_;
};

}  // namespace scree
