#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/report_text.h"
#include "analysis/reproduction.h"

namespace scree {
namespace {

std::string place(const ReferenceValue& reference) {
  return fmt::format("{} {}{}{}", reference.case_name, reference.quantity,
                     reference.section == "whole" ? "" : " ",
                     reference.section == "whole" ? "" : reference.section);
}

}  // namespace

std::vector<std::string> reproduction_in_words(const std::vector<CaseResult>& cases,
                                               const std::vector<TrendComparison>& trends) {
  std::vector<std::string> lines;
  int judged[2] = {0, 0}, agreeing[2] = {0, 0}, unjudged = 0;  // pfc3d, measured
  std::vector<std::string> apart;
  for (const CaseResult& each : cases) {
    if (each.missing + each.failed > 0)
      lines.push_back(fmt::format("{}: {} runs done, {} not run, {} failed", each.name, each.seeds.size(),
                                  each.missing, each.failed));
    for (const Comparison& row : each.comparison) {
      const int who = row.reference.kind == "measured";
      if (!row.z) {
        ++unjudged;
        continue;
      }
      ++judged[who];
      if (std::abs(*row.z) < 2)
        ++agreeing[who];
      else
        apart.push_back(fmt::format("{} ({}): {} {:.3g}, here {:.3g}, z {:+.1f}", place(row.reference),
                                    kind_in_words(row.reference.kind),
                                    meaning_of(row.reference) == Meaning::value ? "printed" : "bound",
                                    row.reference.value, row.simulated, *row.z));
    }
  }
  const char* names[] = {"PFC3D", "measurements"};
  for (int who : {0, 1})
    if (judged[who] > 0)
      lines.push_back(
          fmt::format("{} of {} values printed of {} agree within two standard deviations ({:.0f} %)",
                      agreeing[who], judged[who], names[who], 100.0 * agreeing[who] / judged[who]));
  if (unjudged > 0)
    lines.push_back(fmt::format("{} values are not judged: neither side has a deviation", unjudged));
  for (std::string& line : apart) lines.push_back("does not agree: " + line);
  int same = 0, sure = 0, opposite = 0, directed = 0;
  for (const TrendComparison& each : trends) {
    if (each.trend.bound) continue;
    ++directed;
    const bool agrees = each.difference * each.trend.difference > 0;
    same += agrees, sure += agrees && each.p < 0.05, opposite += !agrees && each.p < 0.05;
  }
  if (directed > 0)
    lines.push_back(fmt::format(
        "of {} printed differences between cases {} have the same direction here, {} of them beyond the "
        "scatter of seeds (p < 0.05); {} have the opposite one beyond it",
        directed, same, sure, opposite));
  return lines;
}

}  // namespace scree
