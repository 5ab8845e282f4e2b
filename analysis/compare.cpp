#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "analysis/results.h"

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

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// 0 for the section at the crest; -1 when the name is that of no section.
int section_index(const std::string& name, int count) {
  if (name == "top") return 0;
  if (name == "middle") return 1;
  if (name == "bottom") return 2;
  if (name.size() == 2 && name[0] == 'S' && name[1] >= '1' && name[1] <= '9' && name[1] - '0' <= count)
    return name[1] - '1';
  return -1;
}

/// Passing at the 1 m sieve of the shares `passing`; NaN when the table has no such sieve.
double passing_1m(const SectionTable& table, const std::vector<double>& passing) {
  for (std::size_t i = 0; i < table.sieves.size() && i < passing.size(); ++i)
    if (std::abs(table.sieves[i] - 1.0) < 1e-9) return passing[i];
  return nan;
}

double above_1m(const SectionTable& table, const Section& section) {
  return section.mass > 0 ? section.mass * (1 - passing_1m(table, section.passing)) : 0;
}

double section_quantity(const SectionTable& table, int index, const std::string& quantity) {
  const Section& section = table.sections[index];
  if (quantity == "chi") return section.chi;
  if (quantity == "d10") return section.d10;
  if (quantity == "d50") return section.d50;
  if (quantity == "d80") return section.d80;
  if (quantity == "d90") return section.d90;
  if (quantity == "d95") return section.d95;
  if (quantity == "d10_rel") return section.d10_rel;
  if (quantity == "d50_rel") return section.d50_rel;
  if (quantity == "d80_rel") return section.d80_rel;
  if (quantity == "d90_rel") return section.d90_rel;
  if (quantity == "d95_rel") return section.d95_rel;
  if (quantity == "mass_t") return section.mass / 1000;
  if (quantity == "share_above_1m") {  // of all mass above 1 m, the part that lies here
    double total = 0;
    for (const Section& each : table.sections) total += above_1m(table, each);
    return total > 0 ? above_1m(table, section) / total : nan;
  }
  return nan;
}

/// What one seed has for a reference value; NaN when it has nothing.
double simulated_value(const SeedResult& seed, const ReferenceValue& reference) {
  if (reference.section == "whole") {
    if (reference.quantity == "angle") return seed.repose ? seed.repose->angle : nan;
    if (reference.quantity == "rebound_height") return seed.rebound_height.value_or(nan);
    if (reference.quantity == "slope_angle") return seed.slope_angle.value_or(nan);
    if (reference.quantity == "share_above_1m_orig" && !seed.sections.empty())
      return 1 - passing_1m(seed.sections.front(), seed.sections.front().original_passing);
    return nan;
  }
  const int count = section_count(reference), index = section_index(reference.section, count);
  if (index < 0) return nan;
  const SectionTable* chosen = nullptr;
  for (const SectionTable& table : seed.sections) {
    if (static_cast<int>(table.sections.size()) != count) continue;
    const bool its_dumps = reference.dumps > 0 && table.dumps == reference.dumps;
    if (!chosen || its_dumps || (table.dumps > chosen->dumps && chosen->dumps != reference.dumps))
      chosen = &table;
    if (its_dumps) break;
  }
  return chosen ? section_quantity(*chosen, index, reference.quantity) : nan;
}

}  // namespace

bool is_value(const ReferenceValue& reference) {
  const std::string& relation = reference.relation;
  return relation == "eq" || relation == "approx" || relation == "mean" || relation == "derived";
}

std::vector<Comparison> compare_with_reference(const std::vector<SeedResult>& seeds,
                                               const std::vector<ReferenceValue>& reference,
                                               const std::vector<std::string>& cases) {
  std::vector<Comparison> comparisons;
  for (const std::string& name : cases) {
    if (std::none_of(reference.begin(), reference.end(),
                     [&](const auto& row) { return row.case_name == name; }))
      throw std::invalid_argument(fmt::format("compare: no reference case is called '{}'", name));
    for (const ReferenceValue& row : reference) {
      if (row.case_name != name || !is_value(row)) continue;
      std::vector<double> values;
      for (const SeedResult& seed : seeds) values.push_back(simulated_value(seed, row));
      const MeanStd simulated = mean_std(values);
      if (simulated.n == 0) continue;
      Comparison comparison{row, simulated.mean, std::nullopt, std::nullopt};
      if (simulated.n > 1) comparison.simulated_std = simulated.std;
      const double deviation = std::hypot(row.std.value_or(0), comparison.simulated_std.value_or(0));
      if (row.std && deviation > 0) comparison.z = (simulated.mean - row.value) / deviation;
      comparisons.push_back(std::move(comparison));
    }
  }
  return comparisons;
}

}  // namespace scree
