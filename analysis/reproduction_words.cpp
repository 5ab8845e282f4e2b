#include <fmt/format.h>

#include <map>

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
  std::vector<std::string> lines, apart;
  struct Count {
    const char* what;
    int judged = 0, agreeing = 0;
  };
  Count counts[] = {
      {"values printed of PFC3D"}, {"values printed of measurements"}, {"bounds printed of PFC3D"}};
  int unjudged = 0;
  for (const CaseResult& each : cases) {
    if (each.missing + each.failed + each.restless > 0)
      lines.push_back(fmt::format(
          "{}: {} runs done, {} not run, {} failed, {} left out because they did not come to rest", each.name,
          each.seeds.size(), each.missing, each.failed, each.restless));
    for (const Comparison& row : each.comparison) {
      const bool value = meaning_of(row.reference) == Meaning::value;
      Count& count = counts[!value ? 2 : row.reference.kind == "measured"];
      const Verdict said = verdict(row);
      unjudged += said == Verdict::unknown;
      if (said == Verdict::unknown) continue;
      ++count.judged;
      if (said != Verdict::differs)
        ++count.agreeing;
      else
        apart.push_back(
            fmt::format("{} ({}): {} {:.3g}{}, here {:.3g}, z {:+.1f}", place(row.reference),
                        kind_in_words(row.reference.kind), value ? "printed" : "bound", row.reference.value,
                        row.reference.upper ? fmt::format(" to {:.3g}", *row.reference.upper) : "",
                        row.simulated, *row.z));
    }
  }
  for (const Count& count : counts)
    if (count.judged > 0)
      lines.push_back(fmt::format("{} of {} {} agree within two standard deviations ({:.0f} %)",
                                  count.agreeing, count.judged, count.what,
                                  100.0 * count.agreeing / count.judged));
  if (unjudged > 0)
    lines.push_back(fmt::format("{} values are not judged: more than one seed is needed", unjudged));
  for (std::string& line : apart) lines.push_back("does not agree: " + line);
  std::map<TrendVerdict, int> verdicts;
  for (const TrendComparison& each : trends) ++verdicts[each.verdict];
  if (!trends.empty())
    lines.push_back(fmt::format(
        "of {} printed differences between cases {} agree in direction and size, {} in direction alone, {} "
        "bounds are "
        "kept; {} go the other way, {} bounds are passed; {} are not decided by these seeds, {} not judged",
        trends.size(), verdicts[TrendVerdict::agrees], verdicts[TrendVerdict::other_size],
        verdicts[TrendVerdict::within], verdicts[TrendVerdict::opposite], verdicts[TrendVerdict::beyond],
        verdicts[TrendVerdict::undecided], verdicts[TrendVerdict::unknown]));
  return lines;
}

}  // namespace scree
