#include "cli/ensemble/tried_models.h"

#include <algorithm>
#include <utility>

namespace scree {
namespace {

constexpr double kMoved = 0.1;  // distance over which a fit has moved, and is simulated anew

}  // namespace

TriedModels::TriedModels(const ModelSpace& space, const Diagnosis& diagnosis, const LearntModel& model,
                         Simulate simulate)
    : space_(space), diagnosis_(diagnosis), model_(model), simulate_(std::move(simulate)) {}

bool TriedModels::simulate(const Judgement& j) {
  if (up_to_date(j)) return false;
  try {
    simulate_again(j);
  } catch (const TooFewRuns& error) {
    if (j.hypothesis.effects.empty()) throw;
    failures_.insert_or_assign(j.hypothesis.effects, Failure{j.best, error.what()});
  }
  return true;
}

void TriedModels::simulate_again(const Judgement& j) {
  SimulatedModel fresh = simulate_(j.best);  // an entry only if that did not throw
  models_[j.hypothesis.effects].push_back(std::move(fresh));
  failures_.erase(j.hypothesis.effects);
}

bool TriedModels::is_fit(const ModelPoint& at, const Judgement& j) const {
  return space_.distance(at, j.best) <= kMoved;
}

bool TriedModels::up_to_date(const Judgement& j) const {
  const SimulatedModel* there = last(j);
  return failed(j) || (there != nullptr && is_fit(there->at, j));
}

bool TriedModels::failed(const Judgement& j) const {
  const auto there = failures_.find(j.hypothesis.effects);
  return there != failures_.end() && is_fit(there->second.at, j);
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
  return there != nullptr && is_fit(there->at, j) && gap_of(*there).p <= kFitsAbove;
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
    if (!j.hypothesis.unknown && (failed(j) || contradicts(j)) && !may_be_said(j))
      all.insert(j.hypothesis.effects);
  return all;
}

bool TriedModels::more_than_calibration() const {
  return diagnosis_.calibration.gap.p <= kFitsAbove || contradicts(diagnosis_.calibration);
}

bool TriedModels::may_be_said(const Judgement& j) const {
  return j.hypothesis.effects.empty() ? !contradicts(j) : bears_out(j);
}

}  // namespace scree
