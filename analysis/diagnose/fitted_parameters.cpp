#include "analysis/diagnose/fitted_parameters.h"

#include <cmath>

#include "analysis/diagnose/words.h"

namespace scree {
namespace {

// `absent`: the value at which an effect does nothing; an end of the range there is none to look beyond.
std::optional<double> at_an_end(const FittedParameter& p, std::optional<double> absent) {
  const double near = kAtEnd * std::abs(p.high - p.low);
  for (const double value : {p.fit, p.within.middle, p.simulated.value_or(p.fit)})
    for (const double end : {p.low, p.high})
      if (!(absent && std::abs(*absent - end) <= near) && std::abs(value - end) <= near) return value;
  return std::nullopt;
}

}  // namespace

std::vector<FittedParameter> fitted_parameters(const ModelSpace& space, const Judgement& judgement,
                                               const SimulatedModel* simulated) {
  std::vector<FittedParameter> all;
  for (std::size_t k = 0; k < space.base.size(); ++k) {
    const BaseAxis& axis = space.base[k];
    const auto at = static_cast<Eigen::Index>(k);
    FittedParameter p;
    p.label = axis.key;
    p.nominal = axis.nominal;
    p.low = axis.from, p.high = axis.to;
    p.within = judgement.base[k];
    p.fit = axis.value(judgement.best.base[at]);
    if (simulated != nullptr) p.simulated = axis.value(simulated->at.base[at]);
    p.at_end = at_an_end(p, std::nullopt);
    all.push_back(std::move(p));
  }
  for (std::size_t e = 0; e < judgement.hypothesis.effects.size(); ++e) {
    const CandidateEffect& effect = space.effects[judgement.hypothesis.effects[e]];
    for (std::size_t a = 0; a < effect.axes.size(); ++a) {
      const auto at = static_cast<Eigen::Index>(a);
      FittedParameter p;
      p.label = label_of(effect, a);
      p.of_effect = true;
      p.nominal = effect.absent;
      p.has_nominal = a == 0;
      p.low = effect.axes[a].low, p.high = effect.axes[a].high;
      p.within = judgement.effects[e][a];
      p.fit = effect.value(a, judgement.best.effects[e].at[at]);
      if (simulated != nullptr) p.simulated = effect.value(a, simulated->at.effects[e].at[at]);
      p.at_end = at_an_end(p, a == 0 ? std::optional(effect.absent) : std::nullopt);
      all.push_back(std::move(p));
    }
  }
  return all;
}

std::vector<FittedModel> fitted_models(const DiagnosisOutcome& o) {
  const Diagnosis& d = o.diagnosis;
  std::vector<FittedModel> all{
      {"re-calibrated", fitted_parameters(o.space, d.calibration, o.calibrated ? &*o.calibrated : nullptr)}};
  if (!d.verdict.named.empty())
    all.push_back({"with what was found", fitted_parameters(o.space, d.judgements[d.verdict.named.front()],
                                                            o.augmented ? &*o.augmented : nullptr)});
  if (d.verdict.kind == DiagnosisVerdict::Kind::nothing)
    for (FittedParameter& p : all.front().parameters) p.at_end.reset();
  return all;
}

const SimulatedModel* handed_over(const DiagnosisOutcome& o) {
  return o.augmented ? &*o.augmented : o.calibrated ? &*o.calibrated : nullptr;
}

std::vector<FittedParameter> handed_over_parameters(const DiagnosisOutcome& o) {
  const SimulatedModel* model = handed_over(o);
  if (model == nullptr) return {};
  const Diagnosis& d = o.diagnosis;
  return fitted_parameters(o.space, o.augmented ? d.judgements[d.verdict.named.front()] : d.calibration,
                           model);
}

}  // namespace scree
