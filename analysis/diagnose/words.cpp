#include "analysis/diagnose/words.h"

#include <fmt/format.h>

#include <algorithm>

#include "analysis/report_text.h"

namespace scree {
namespace {

// The last part of a key: bond_number.
std::string short_key(const std::string& key) {
  return key.substr(key.rfind('.') + 1);
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

std::string largest_differences(const Diagnosis& d) {
  std::string text;
  int count = 0;
  for (const Disagreement& each : d.numbers)
    if (each.significant && count < 3)
      text += fmt::format("{}{} ({:+.1f} standard deviations)", count++ == 0 ? "" : ", ", each.where, each.z);
  return text;
}

std::string paragraph(const DiagnosisOutcome& o) {
  const Diagnosis& d = o.diagnosis;
  const std::size_t n = d.measured.values.size();
  using Kind = DiagnosisVerdict::Kind;
  if (d.verdict.kind == Kind::nothing)
    return fmt::format(
        "Nothing is missing that these {} numbers could show: the model with its nominal parameters agrees "
        "with them ({}).",
        n, gap_in_words(d.nominal));
  const std::string where = largest_differences(d);
  std::string text = fmt::format(
      "The model with its nominal parameters does not agree with the {} measured "
      "numbers ({}{}{}). ",
      n, gap_in_words(d.nominal), where.empty() ? "" : "; most of all ", where);
  if (d.verdict.kind == Kind::calibration)
    return text + fmt::format("Other parameters explain them ({}): {}. No effect needs to be added.",
                              gap_in_words(d.calibration.gap), base_in_words(o.space, d.calibration));
  text +=
      fmt::format("No choice of its parameters mends that (at best {}). ", gap_in_words(d.calibration.gap));
  if (d.verdict.kind == Kind::unknown) {
    std::string best;
    for (const Judgement& j : d.judgements)
      if (best.empty() && !j.hypothesis.effects.empty())
        best = fmt::format("the best of them, {}, leaves {}", name_of(o.space, j.hypothesis),
                           gap_in_words(j.gap));
    return text + fmt::format(
                      "Something is missing that is not among the {} effects looked for: none of them "
                      "explains the data, alone or with a second one ({}).",
                      o.space.effects.size(), best);
  }
  const Judgement& first = d.judgements[d.verdict.named.front()];
  const std::string fit = fmt::format(
      "With {} it agrees ({}{}): {}.", name_of(o.space, first.hypothesis), gap_in_words(first.gap),
      o.augmented ? fmt::format("; by {} full simulations of each experiment with fresh seeds {}",
                                o.augmented->runs, gap_in_words(o.augmented->gap))
                  : "",
      values_in_words(o.space, first));
  if (d.verdict.kind == Kind::effect)
    return text +
           fmt::format("What is missing is {}{} (probability {}). ",
                       first.probability >= kSureAbove ? "" : "most probably ",
                       name_of(o.space, first.hypothesis), decimals_text(first.probability, 2)) +
           fit;
  std::string names;
  for (const std::size_t k : d.verdict.named)
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", name_of(o.space, d.judgements[k].hypothesis),
                         decimals_text(d.judgements[k].probability, 2));
  return text + "Something is missing, and the data cannot tell which of these (probability): " + names +
         ". " + fit;
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

std::string values_in_words(const ModelSpace& space, const Judgement& judgement) {
  std::string text;
  for (std::size_t k = 0; k < judgement.hypothesis.effects.size(); ++k) {
    const CandidateEffect& effect = space.effects[judgement.hypothesis.effects[k]];
    for (std::size_t a = 0; a < effect.axes.size(); ++a) {
      const Judgement::Interval& i = judgement.effects[k][a];
      text += fmt::format("{}{}.{} {} ({} to {})", text.empty() ? "" : ", ", effect.name,
                          short_key(effect.axes[a].key), number_text(i.middle), number_text(i.low),
                          number_text(i.high));
    }
  }
  return text;
}

std::string gap_in_words(const Gap& gap) {
  const std::string p = p_text(gap.p);
  return fmt::format("chi-square {} on {}, p {}", number_text(gap.chi2), gap.freedom,
                     p.starts_with('<') ? p : "= " + p);
}

std::vector<std::string> diagnosis_in_words(const DiagnosisOutcome& o) {
  std::vector<std::string> lines{paragraph(o)};
  if (o.held_out_calibrated && o.held_out_augmented)
    lines.push_back(
        fmt::format("Numbers that were left out of the fit in turn ({}): re-calibration alone misses them by "
                    "chi-square {} "
                    "on {}, the model with the effect by {}.",
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
        fmt::format("The answer still moved in the last of {} rounds of simulation; more simulations "
                    "(`simulations` in the model file) would make it firmer.",
                    o.rounds));
  return lines;
}

}  // namespace scree
