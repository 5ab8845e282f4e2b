#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "analysis/results/finished_runs.h"
#include "analysis/results/outputs.h"

namespace scree {

int section_count(const ReferenceValue& reference) {
  const std::string& section = reference.section;
  if (section == "top" || section == "middle" || section == "bottom") return 3;
  const auto end = reference.case_name.rfind("sec");
  if (end != std::string::npos && end > 0 && end + 3 == reference.case_name.size()) {
    const char digit = reference.case_name[end - 1];
    if (digit >= '1' && digit <= '9') return digit - '0';
  }
  return 6;
}

Meaning meaning_of(const ReferenceValue& reference) {
  const std::string& relation = reference.relation;
  if (relation == "eq" || relation == "approx" || relation == "mean" || relation == "derived")
    return Meaning::value;
  if (relation == "gt" || relation == "min") return Meaning::at_least;
  if (relation == "lt" || relation == "le" || relation == "max") return Meaning::at_most;
  return relation == "range" ? Meaning::range : Meaning::none;
}

namespace {

constexpr std::string_view kScatter = "_scatter";

// Ours of a printed value, and its deviation; of a printed scatter that of the seeds: a deviation of n values
// scatters by its 1 / sqrt(2 (n - 1)).
MeanStd simulated_value(const ReferenceValue& row, const std::vector<Outputs>& seeds) {
  PileValue value = pile_value(row);
  const bool scatter = value.quantity.ends_with(kScatter);
  if (scatter) value.quantity.resize(value.quantity.size() - kScatter.size());
  const MeanStd both = spread_of(seeds, [&](const Outputs& seed) { return output_for(value, seed); });
  if (!scatter) return both;
  return both.n > 1 ? MeanStd{both.std, both.std / std::sqrt(2.0 * (both.n - 1)), both.n} : MeanStd{};
}

}  // namespace

std::vector<Comparison> compare_with_reference(const std::vector<Outputs>& seeds,
                                               const std::vector<ReferenceValue>& reference,
                                               const std::vector<std::string>& cases) {
  std::vector<Comparison> comparisons;
  for (const std::string& name : cases) {
    if (std::none_of(reference.begin(), reference.end(),
                     [&](const auto& row) { return row.case_name == name; }))
      throw std::invalid_argument(fmt::format("compare: no reference case is called '{}'", name));
    for (const ReferenceValue& row : reference) {
      const Meaning meaning = meaning_of(row);
      if (row.case_name != name || meaning == Meaning::none) continue;
      if (meaning != Meaning::value && row.kind != "pfc3d") continue;
      const MeanStd simulated = simulated_value(row, seeds);
      if (simulated.n == 0) continue;
      Comparison comparison{row, simulated.mean, std::nullopt, std::nullopt};
      comparison.finished_instead = std::any_of(seeds.begin(), seeds.end(), [&](const Outputs& seed) {
        return finished_pile_instead(pile_value(row), seed);
      });
      if (simulated.n > 1) comparison.simulated_std = simulated.std;
      const bool above = meaning == Meaning::range && simulated.mean > row.upper.value();
      const std::optional<double> stated = above ? row.upper_std : row.std;
      const double printed_std =
          stated.value_or((above ? row.upper_rounding : row.rounding) / std::sqrt(3.0));
      const double deviation = std::hypot(printed_std, comparison.simulated_std.value_or(0));
      double difference = simulated.mean - row.value;
      if (meaning == Meaning::range)
        difference = above ? simulated.mean - row.upper.value() : std::min(difference, 0.0);
      if (meaning == Meaning::at_least) difference = std::min(difference, 0.0);
      if (meaning == Meaning::at_most) difference = std::max(difference, 0.0);
      if (deviation > 0 && (stated || comparison.simulated_std)) comparison.z = difference / deviation;
      comparisons.push_back(std::move(comparison));
    }
  }
  return comparisons;
}

std::vector<std::string> comparison_notes(const std::vector<Comparison>& comparison) {
  std::vector<std::string> notes;
  for (const Comparison& row : comparison) {
    if (!row.finished_instead) continue;
    std::string note = fmt::format(
        "{}: printed of the pile after load {}, which was not kept; held against the finished pile "
        "(output.after_dumps: [{}] keeps it)",
        row.reference.case_name, row.reference.dumps, row.reference.dumps);
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(std::move(note));
  }
  return notes;
}

}  // namespace scree
