#include "cli/ensemble/tried_models.h"

#include <algorithm>

namespace scree {
namespace {

constexpr double kMoved = 0.1;  // distance over which a fit has moved, and is simulated anew

}  // namespace

TriedModels::TriedModels(const ModelSpace& space, const Diagnosis& diagnosis, const LearntModel& model,
                         Simulate simulate)
    : space_(space), diagnosis_(diagnosis), model_(model), simulate_(std::move(simulate)) {}

bool TriedModels::show(const Judgement& j) {
  if (is_shown(j)) return false;
  try {
    show_again(j);
  } catch (const TooFewRuns& error) {
    if (j.hypothesis.effects.empty()) throw;
    failed_.emplace(j.hypothesis.effects, error.what());
  }
  return true;
}

void TriedModels::show_again(const Judgement& j) {
  SimulatedModel fresh = simulate_(j.best);  // an entry only if that did not throw
  models_[j.hypothesis.effects].push_back(std::move(fresh));
}

bool TriedModels::is_shown(const Judgement& j) const {
  const SimulatedModel* there = last(j);
  return failed(j) || (there != nullptr && space_.distance(there->at, j.best) <= kMoved);
}

const SimulatedModel* TriedModels::last(const Judgement& j) const {
  const auto there = models_.find(j.hypothesis.effects);
  return there == models_.end() ? nullptr : &there->second.back();
}

SimulatedModel TriedModels::best(const Judgement& j) const {
  std::vector<SimulatedModel> all = models_.at(j.hypothesis.effects);
  for (SimulatedModel& each : all) each.gap = gap_of(each);
  return *std::min_element(all.begin(), all.end(),
                           [](const auto& a, const auto& b) { return a.gap.chi2 < b.gap.chi2; });
}

Gap TriedModels::gap_of(const SimulatedModel& each) const {
  return simulated_gap(diagnosis_, model_, each.mean, each.runs);
}

bool TriedModels::contradicts(const Judgement& j) const {
  const SimulatedModel* there = last(j);
  return there != nullptr && space_.distance(there->at, j.best) <= kMoved && gap_of(*there).p <= kFitsAbove;
}

bool TriedModels::bears_out(const Judgement& j) const {
  const auto there = models_.find(j.hypothesis.effects);
  return there != models_.end() &&
         std::any_of(there->second.begin(), there->second.end(),
                     [&](const SimulatedModel& each) { return gap_of(each).p > kFitsAbove; });
}

Contradicted TriedModels::contradicted() const {
  Contradicted all;
  for (const Judgement& j : diagnosis_.judgements)
    if (!j.hypothesis.unknown && contradicts(j) && !may_be_said(j)) all.insert(j.hypothesis.effects);
  return all;
}

bool TriedModels::more_than_calibration() const {
  return diagnosis_.calibration.gap.p <= kFitsAbove || contradicts(diagnosis_.calibration);
}

bool TriedModels::may_be_said(const Judgement& j) const {
  return j.hypothesis.effects.empty() ? !contradicts(j) : bears_out(j);
}

}  // namespace scree
