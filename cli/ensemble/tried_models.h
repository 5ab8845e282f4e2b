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

  /// Simulates a hypothesis at its fit unless its last model lies there, or none could be simulated. Whether
  /// there was anything to do. Throws TooFewRuns of the base model.
  bool show(const Judgement& judgement);
  /// Simulates it there with fresh seeds, whatever there is. Throws TooFewRuns.
  void show_again(const Judgement& judgement);

  bool is_shown(const Judgement& judgement) const;
  /// Some fit of it could not be simulated.
  bool failed(const Judgement& judgement) const { return failed_.contains(judgement.hypothesis.effects); }
  /// The last model with these effects; none: nullptr.
  const SimulatedModel* last(const Judgement& judgement) const;
  /// Of all those with these effects, the one nearest to the data, with its gap; there is one.
  SimulatedModel best(const Judgement& judgement) const;
  Gap gap_of(const SimulatedModel& each) const;

  /// Simulations at the fitted values do not give the data, whatever surfaces say.
  bool contradicts(const Judgement& judgement) const;
  /// Any model with these effects that was simulated gives the data.
  bool bears_out(const Judgement& judgement) const;
  /// Effects whose fit is contradicted and that no model has borne out; empty ones: the base model at its
  /// fit.
  Contradicted contradicted() const;
  /// Base parameters alone do not give the data.
  bool more_than_calibration() const;
  /// What may be said: of effects, that one model with them gives the data; of re-calibration, that its last
  /// fit does.
  bool may_be_said(const Judgement& judgement) const;

  /// Why hypotheses could not be simulated, by their effects.
  const std::map<std::vector<std::size_t>, std::string>& failures() const { return failed_; }

 private:
  const ModelSpace& space_;
  const Diagnosis& diagnosis_;
  const LearntModel& model_;
  Simulate simulate_;
  std::map<std::vector<std::size_t>, std::vector<SimulatedModel>> models_;  // by effects; the last one last
  std::map<std::vector<std::size_t>, std::string> failed_;
};

}  // namespace scree
