#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/outputs.h"

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
      std::vector<double> values;
      for (const Outputs& seed : seeds)
        if (const auto value = output_for(row, seed)) values.push_back(*value);
      const MeanStd simulated = mean_std(values);
      if (simulated.n == 0) continue;
      Comparison comparison{row, simulated.mean, std::nullopt, std::nullopt};
      if (simulated.n > 1) comparison.simulated_std = simulated.std;
      const double printed_std = row.std.value_or(row.rounding / std::sqrt(3.0));
      const double deviation = std::hypot(printed_std, comparison.simulated_std.value_or(0));
      double difference = simulated.mean - row.value;
      if (meaning == Meaning::range)
        difference =
            simulated.mean < row.value ? difference : std::max(simulated.mean - row.upper.value(), 0.0);
      if (meaning == Meaning::at_least) difference = std::min(difference, 0.0);
      if (meaning == Meaning::at_most) difference = std::max(difference, 0.0);
      if (deviation > 0 && (row.std || comparison.simulated_std)) comparison.z = difference / deviation;
      comparisons.push_back(std::move(comparison));
    }
  }
  return comparisons;
}

}  // namespace scree
