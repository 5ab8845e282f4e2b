#include <fmt/format.h>

#include <cmath>
#include <map>

#include "analysis/cases/reproduction.h"
#include "analysis/report/report_text.h"
#include "analysis/statistics/welch.h"

namespace scree {
namespace {

std::string place(const ReferenceValue& reference) {
  return fmt::format("{} {}{}{}", reference.case_name, reference.quantity,
                     reference.section == "whole" ? "" : " ",
                     reference.section == "whole" ? "" : reference.section);
}

std::string with_deviation(const MeanStd& value) {
  return value.n > 1 ? fmt::format("{:.2f} +- {:.2f}", value.mean, value.std)
                     : fmt::format("{:.2f}", value.mean);
}

// Whether chi has the sign that is expected, as far as seeds can tell.
std::string sign_in_words(const char* section, const MeanStd& chi, const char* side, double p) {
  return fmt::format("chi({}) {}: {}", section, with_deviation(chi),
                     std::isnan(p)      ? chi.n == 1 ? std::string("one seed") : std::string("no scatter")
                          : p < kSignificant ? fmt::format("{} 0, p {}", side, p_text(p))
                                        : fmt::format("not shown to be {} 0, p {}", side, p_text(p)));
}

std::string in_words(const SegregationSigns& signs) {
  return fmt::format("{}: {}; {}; {}{}", signs.case_name,
                     sign_in_words("S1", signs.crest, "below", signs.p_crest),
                     sign_in_words("S6", signs.toe, "above", signs.p_toe),
                     signs.zero.n > 0 ? fmt::format("chi changes sign at x/L {}", with_deviation(signs.zero))
                                      : "chi does not change sign along the slope",
                     signs.printed_zero ? fmt::format(" (printed {:.2g})", *signs.printed_zero) : "");
}

std::string interval_in_words(const VelocityTrend& trend) {
  const PrintedHalf& by = trend.printed_slope_half;
  if (!(by.half > 0)) return ", taken as exact: no scatter is printed";
  return fmt::format(" ({}95 % {:+.2f} to {:+.2f})", by.at_most ? "at most " : "",
                     trend.printed_slope - by.half, trend.printed_slope + by.half);
}

std::string in_words(const VelocityTrend& trend) {
  const Slope& s = trend.here;
  return fmt::format(
      "{} of {} over the velocity of the blade, {} to {}, {} runs: slope {:+.2f} per m/s{}; "
      "Jonckheere-Terpstra p {}{}",
      trend.value.quantity == "chi" ? "chi" : "D50 ratio", trend.value.section, trend.first, trend.last,
      trend.runs, s.slope,
      std::isnan(s.p) ? std::string(", no interval")
                      : fmt::format(" (95 % {:+.2f} to {:+.2f}, p {})", s.low, s.high, p_text(s.p)),
      p_text(trend.order.p),
      trend.printed.size() > 1
          ? fmt::format("; PFC3D's slope {:+.2f}{} ({} cases printed): {}", trend.printed_slope,
                        interval_in_words(trend), trend.printed.size(), look(trend.verdict).words)
          : "");
}

}  // namespace

TrendLook look(TrendVerdict verdict) {
  switch (verdict) {
    case TrendVerdict::agrees:
      return {"close", "same direction, size within both scatters"};
    case TrendVerdict::other_size:
      return {"agrees", "same direction, other size"};
    case TrendVerdict::opposite:
      return {"differs", "opposite direction"};
    case TrendVerdict::within:
      return {"close", "within the bound"};
    case TrendVerdict::beyond:
      return {"differs", "beyond the bound"};
    case TrendVerdict::not_seen:
      return {"differs", "none seen, and the printed size is excluded"};
    case TrendVerdict::undecided:
      return {"unknown", "not decided"};
    case TrendVerdict::unknown:
      break;
  }
  return {"unknown", "not judged: too few runs or printed values"};
}

ReproductionWords reproduction_in_words(const std::vector<CaseResult>& cases,
                                        const std::vector<TrendComparison>& trends) {
  ReproductionWords words;
  struct Count {
    const char* what;
    int judged = 0, agreeing = 0;
  };
  Count counts[] = {
      {"values printed of PFC3D"}, {"values printed of measurements"}, {"bounds printed of PFC3D"}};
  int unjudged = 0;
  for (const CaseResult& each : cases) {
    if (!each.runs.complete()) words.runs.push_back(runs_in_words(each.name, each.runs));
    for (const std::string& note : comparison_notes(each.comparison))
      words.runs.push_back(fmt::format("{}: {}", each.name, note));
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
        words.apart.push_back(
            fmt::format("does not agree: {} ({}): {} {:.3g}{}, here {:.3g}, z {:+.1f}", place(row.reference),
                        kind_in_words(row.reference.kind), value ? "printed" : "bound", row.reference.value,
                        row.reference.upper ? fmt::format(" to {:.3g}", *row.reference.upper) : "",
                        row.simulated, *row.z));
    }
  }
  for (const Count& count : counts) {
    words.judged += count.judged, words.agreeing += count.agreeing;
    if (count.judged > 0)
      words.counts.push_back(fmt::format("{} of {} {} agree within two standard deviations ({:.0f} %)",
                                         count.agreeing, count.judged, count.what,
                                         100.0 * count.agreeing / count.judged));
  }
  if (unjudged > 0)
    words.counts.push_back(fmt::format("{} values are not judged: more than one seed is needed", unjudged));
  std::map<TrendVerdict, int> verdicts;
  for (const TrendComparison& each : trends) ++verdicts[each.verdict];
  if (!trends.empty())
    words.counts.push_back(fmt::format(
        "of {} printed differences between cases {} agree in direction and, within both scatters, in size, "
        "{} in direction alone, {} bounds are kept; {} go the other way, {} are not seen and their printed "
        "size is excluded, {} broken; {} are not decided, {} not judged",
        trends.size(), verdicts[TrendVerdict::agrees], verdicts[TrendVerdict::other_size],
        verdicts[TrendVerdict::within], verdicts[TrendVerdict::opposite], verdicts[TrendVerdict::not_seen],
        counted_text(static_cast<std::size_t>(verdicts[TrendVerdict::beyond]), "bound") +
            (verdicts[TrendVerdict::beyond] == 1 ? " is" : " are"),
        verdicts[TrendVerdict::undecided], verdicts[TrendVerdict::unknown]));
  for (const SegregationSigns& signs : segregation_signs(cases)) words.trends.push_back(in_words(signs));
  for (const VelocityTrend& trend : velocity_trends(cases)) words.trends.push_back(in_words(trend));
  return words;
}

}  // namespace scree
