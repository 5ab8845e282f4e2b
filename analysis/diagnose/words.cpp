#include "analysis/diagnose/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/diagnose/fitted_parameters.h"
#include "analysis/report/report_text.h"

namespace scree {
namespace {

constexpr double kOutsideTwo = 0.0455;  // share of a normal distribution beyond two standard deviations

// "p = 0.013", "p < 0.001", "no test"
std::string p_in_words(const Gap& gap) {
  if (!gap.is_test) return "no test";
  const std::string text = p_text(gap.p);
  return text.starts_with('<') ? "p " + text : "p = " + text;
}

// Of what full simulations refuted the gap is theirs.
std::string gap_of_judgement(const Judgement& j) {
  return gap_in_words(j.gap) +
         (j.simulated == Judgement::Simulated::refuted ? " (by full simulations, which refute it)" : "");
}

std::string base_in_words(const ModelSpace& space, const Judgement& judgement) {
  std::string text;
  for (std::size_t k = 0; k < space.base.size(); ++k) {
    const Judgement::Interval& i = judgement.base[k];
    text += fmt::format("{}{} {} ({} to {})", k == 0 ? "" : ", ", space.base[k].key, number_text(i.middle),
                        number_text(i.low), number_text(i.high));
  }
  return text;
}

// The three numbers that the model misses most, of those beyond two standard deviations.
std::string largest_differences(const DiagnosisOutcome& o) {
  std::vector<std::pair<double, std::string>> all;
  for (std::size_t k = 0; k < o.diagnosis.measured.values.size(); ++k)
    all.emplace_back(standard_residual(o.diagnosis, o.nominal, static_cast<Eigen::Index>(k)),
                     o.diagnosis.measured.values[k].label);
  std::sort(all.begin(), all.end(),
            [](const auto& x, const auto& y) { return std::abs(x.first) > std::abs(y.first); });
  std::string text;
  for (std::size_t k = 0; k < std::min<std::size_t>(all.size(), 3) && std::abs(all[k].first) > 2; ++k)
    text += fmt::format("{}{} ({:+.1f})", k == 0 ? "" : ", ", all[k].second, all[k].first);
  return text;
}

int outside(const DiagnosisOutcome& o, const SimulatedModel& model) {
  int count = 0;
  for (Eigen::Index k = 0; k < model.mean.size(); ++k)
    count += std::abs(standard_residual(o.diagnosis, model, k)) > 2 ? 1 : 0;
  return count;
}

// "cohesion between grains (cohesion)"
std::string title_of(const ModelSpace& space, const Hypothesis& hypothesis) {
  std::string text;
  for (const std::size_t e : hypothesis.effects)
    text +=
        fmt::format("{}{} ({})", text.empty() ? "" : " and ", space.effects[e].title, space.effects[e].name);
  return text;
}

// What is unknown, and the effects whose fits would explain the data but are less probable.
std::string unknown_in_words(const ModelSpace& space, const Diagnosis& d) {
  const auto& all = d.judgements;
  if (space.effects.empty()) return "Something is missing, and no effect was looked for.";
  const std::string missing = fmt::format("Something is missing that is not among the {} looked for",
                                          counted_text(space.effects.size(), "effect"));
  std::string rivals;
  double unknown = 0, most = 0;  // probabilities; judgements stand by falling ones
  for (const Judgement& j : all) {
    if (j.hypothesis.unknown) unknown = j.probability;
    if (!j.hypothesis.is_effect() || !j.explains()) continue;
    if (rivals.empty()) most = j.probability;
    if (j.probability * kApartBy <= most) break;
    rivals += fmt::format("{}{} ({}, probability {})", rivals.empty() ? "" : "; ",
                          name_of(space, j.hypothesis), p_in_words(j.gap), number_text(j.probability, 2));
  }
  if (!rivals.empty())
    return fmt::format(
        "{} (probability {}). By their fits alone these would explain the data, but are less probable: {}.",
        missing, decimals_text(unknown, 2), rivals);
  const bool pairs =
      std::any_of(all.begin(), all.end(), [](const Judgement& j) { return j.hypothesis.effects.size() > 1; });
  return fmt::format("{}: none of them explains the data{}.", missing,
                     pairs ? ", alone or with a second one" : " alone; pairs were not tried");
}

// What is said first: the answer.
std::string answer(const DiagnosisOutcome& o) {
  const Diagnosis& d = o.diagnosis;
  using Kind = DiagnosisVerdict::Kind;
  switch (d.verdict.kind) {
    case Kind::nothing:
      return fmt::format(
          "Nothing is missing that {} could show: the model as it is agrees with what was measured.",
          counted_text(d.measured.values.size(), "number"));
    case Kind::calibration:
      if (d.calibration.gap.p <= kFitsAbove)
        return fmt::format(
            "No effect can be named: other parameters leave more than chance often does ({}), but "
            "nothing else is {:g} times as probable as they are. More repeats would tell. {}.",
            p_in_words(d.calibration.gap), kApartBy, base_in_words(o.space, d.calibration));
      return fmt::format("No effect needs to be added: other parameters explain the {}. {}.",
                         counted_text(d.measured.values.size(), "number"),
                         base_in_words(o.space, d.calibration));
    case Kind::unknown:
      return unknown_in_words(o.space, d);
    case Kind::effect: {
      const Judgement& first = d.judgements[d.verdict.named.front()];
      return fmt::format("What is missing is {}{}, with probability {}: {}.",
                         first.probability >= kSureAbove ? "" : "most probably ",
                         title_of(o.space, first.hypothesis), decimals_text(first.probability, 2),
                         values_in_words(o.space, first));
    }
    case Kind::group: {
      std::string names;
      for (const std::size_t k : d.verdict.named)
        names +=
            fmt::format("{}{} ({})", names.empty() ? "" : ", ", name_of(o.space, d.judgements[k].hypothesis),
                        decimals_text(d.judgements[k].probability, 2));
      return fmt::format(
          "Something is missing, and these data cannot tell which of the following (probability): {}. With "
          "the "
          "first: {}.",
          names, values_in_words(o.space, d.judgements[d.verdict.named.front()]));
    }
  }
  return "";
}

// What the values said are, and what was simulated instead of them.
std::string handed_over_in_words(const DiagnosisOutcome& o) {
  std::string values;
  for (const FittedParameter& p : handed_over_parameters(o))
    values += fmt::format("{}{} {}", values.empty() ? "" : ", ", p.label, number_text(*p.simulated));
  return fmt::format("{}Simulated in full, and written to the scenarios, is {}: {}.",
                     o.diagnosis.verdict.kind == DiagnosisVerdict::Kind::unknown
                         ? ""
                         : "Values with an interval are its middle, in brackets 90 % of the probability. ",
                     o.augmented ? "of the models tried the nearest to the data" : "the re-calibrated model",
                     values);
}

// Base parameters that lie at an end of their range; empty without any.
std::string at_ends_in_words(const DiagnosisOutcome& o) {
  std::string text;
  for (const FittedModel& model : fitted_models(o))
    for (const FittedParameter& p : model.parameters)
      if (p.at_end && !p.of_effect)
        text += fmt::format("{}{} {} {} of a range from {} to {}", text.empty() ? "" : "; ", model.name,
                            p.label, number_text(*p.at_end), number_text(p.low), number_text(p.high));
  return text.empty()
             ? text
             : fmt::format("At the end of its range: {}. Widen it in the model file if rock may be so.",
                           text);
}

// How far the numbers are off, counted.
std::string counted(const DiagnosisOutcome& o) {
  const Diagnosis& d = o.diagnosis;
  const std::size_t n = d.measured.values.size();
  std::string text =
      fmt::format("As it is, the model misses {} of the {} by more than two standard deviations",
                  outside(o, o.nominal), counted_text(n, "measured number"));
  if (const std::string where = largest_differences(o); !where.empty()) text += "; most of all " + where;
  if (o.calibrated) text += fmt::format(". Its best parameters leave {}", outside(o, *o.calibrated));
  if (o.augmented) text += fmt::format("; with what was found {}", outside(o, *o.augmented));
  const double by_chance = std::round(kOutsideTwo * static_cast<double>(n));
  return text + (by_chance > 0 ? fmt::format(". Chance alone leaves about {:.0f}.", by_chance)
                               : ". Chance alone leaves none.");
}

// The tests behind it, by the surfaces.
std::string tested(const DiagnosisOutcome& o) {
  const Diagnosis& d = o.diagnosis;
  using Kind = DiagnosisVerdict::Kind;
  std::string text = "Gap by the fitted surfaces: as it is " + gap_in_words(d.nominal);
  if (d.verdict.kind == Kind::nothing) return text + ".";
  text += "; best parameters " + gap_of_judgement(d.calibration);
  if (d.verdict.kind == Kind::unknown) {
    for (const Judgement& j : d.judgements)
      if (j.hypothesis.is_effect())
        return text + fmt::format("; with the most probable of the effects, {}, {}.",
                                  name_of(o.space, j.hypothesis), gap_of_judgement(j));
    return text + ".";
  }
  if (d.verdict.kind == Kind::calibration) return text + ".";
  const Judgement& first = d.judgements[d.verdict.named.front()];
  return text + fmt::format("; with {} {}.", name_of(o.space, first.hypothesis), gap_of_judgement(first));
}

// The same by simulations; empty without any.
std::string simulated_gaps(const DiagnosisOutcome& o) {
  std::string text;
  const auto add = [&](const std::string& what, const SimulatedModel& m) {
    text += fmt::format("{}{} {} ({} seeds)", text.empty() ? "" : "; ", what, gap_in_words(m.gap), m.runs);
  };
  if (o.nominal.runs > 0) add("as it is", o.nominal);
  if (o.calibrated) add("best parameters", *o.calibrated);
  if (o.augmented)
    add("with " + name_of(o.space, o.diagnosis.judgements[o.diagnosis.verdict.named.front()].hypothesis),
        *o.augmented);
  return text.empty() ? text : fmt::format("Gap by full simulations, all numbers free: {}.", text);
}

}  // namespace

std::string name_of(const ModelSpace& space, const Hypothesis& hypothesis) {
  if (hypothesis.unknown) return "something unknown";
  if (hypothesis.effects.empty()) return "no effect (re-calibration alone)";
  std::string text;
  for (const std::size_t e : hypothesis.effects)
    text += fmt::format("{}{}", text.empty() ? "" : " and ", space.effects[e].name);
  return text;
}

std::string label_of(const CandidateEffect& effect, std::size_t axis) {
  const std::string& key = effect.axes[axis].key;
  return effect.name + key.substr(key.rfind('.'));
}

std::string values_in_words(const ModelSpace& space, const Judgement& judgement) {
  std::string text;
  for (std::size_t k = 0; k < judgement.hypothesis.effects.size(); ++k) {
    const CandidateEffect& effect = space.effects[judgement.hypothesis.effects[k]];
    for (std::size_t a = 0; a < effect.axes.size(); ++a) {
      const Judgement::Interval& i = judgement.effects[k][a];
      text += fmt::format("{}{} {} ({} to {})", text.empty() ? "" : ", ", label_of(effect, a),
                          number_text(i.middle), number_text(i.low), number_text(i.high));
    }
  }
  return text;
}

std::vector<std::string> simulated_in_words(const DiagnosisOutcome& o) {
  std::vector<std::string> all;
  for (const FittedParameter& p : handed_over_parameters(o))
    all.push_back(fmt::format("{} {} (middle of its interval {}, {} to {})", p.label,
                              number_text(*p.simulated), number_text(p.within.middle),
                              number_text(p.within.low), number_text(p.within.high)));
  return all;
}

std::string gap_in_words(const Gap& gap) {
  if (!gap.is_test)
    return fmt::format("chi-square {} with no more numbers than parameters: no test", number_text(gap.chi2));
  return fmt::format("chi-square {} on {}, {}", number_text(gap.chi2), gap.freedom, p_in_words(gap));
}

std::vector<std::string> diagnosis_in_words(const DiagnosisOutcome& o) {
  std::vector<std::string> lines{answer(o)};
  if (handed_over(o) != nullptr) lines.push_back(handed_over_in_words(o));
  if (const std::string ends = at_ends_in_words(o); !ends.empty()) lines.push_back(ends);
  lines.push_back(counted(o));
  lines.push_back(tested(o));
  if (const std::string gaps = simulated_gaps(o); !gaps.empty()) lines.push_back(gaps);
  if (o.held_out_calibrated && o.held_out_augmented && o.held_out_augmented->count > 0)
    lines.push_back(fmt::format(
        "Left out of the fit in turn and foretold ({}): with re-calibration alone chi-square {} on {}, with "
        "the effect {}.",
        fmt::join(o.held_out_augmented->parts, ", "), number_text(o.held_out_calibrated->chi2),
        o.held_out_calibrated->count, number_text(o.held_out_augmented->chi2)));
  if (!o.next.empty()) {
    std::string text =
        "What would tell them apart best (difference in standard deviations of five repeats): ";
    for (std::size_t k = 0; k < o.next.size(); ++k)
      text +=
          fmt::format("{}{} ({})", k == 0 ? "" : ", ", o.next[k].label, number_text(o.next[k].difference, 2));
    lines.push_back(text + ".");
  }
  if (!o.settled)
    lines.push_back(
        fmt::format("The answer had not settled in the last round of simulation ({} done); more simulations "
                    "(`simulations` in the model file) would make it firmer.",
                    o.rounds));
  return lines;
}

}  // namespace scree
