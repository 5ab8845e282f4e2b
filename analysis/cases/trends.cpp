#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/cases/reproduction.h"
#include "analysis/results/outputs.h"
#include "analysis/statistics/welch.h"
#include "sim/material/csv_table.h"

namespace scree {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

const CaseResult* find(const std::vector<CaseResult>& cases, const std::string& name) {
  const auto found = std::find_if(cases.begin(), cases.end(),
                                  [&](const CaseResult& each) { return lower(each.name) == lower(name); });
  return found == cases.end() ? nullptr : &*found;
}

MeanStd spread(const CaseResult& result, const Trend& trend) {
  return spread_of(result.runs.seeds, [&](const Outputs& seed) {
    return output_for({trend.quantity, trend.section}, seed);
  });
}

TrendVerdict verdict_of(const TrendComparison& c) {
  const double printed = c.trend.difference;
  if (!c.trend.bound) return judged(c.difference, c.low, c.high, c.p, printed, c.printed.half);
  if (c.low > printed || c.high < -printed) return TrendVerdict::beyond;
  return c.low >= -printed && c.high <= printed ? TrendVerdict::within : TrendVerdict::undecided;
}

TrendComparison compared(const Trend& trend, const CaseResult& here, const CaseResult& there) {
  TrendComparison result;
  result.trend = trend;
  const MeanStd a = spread(here, trend), b = spread(there, trend);
  result.difference = result.low = result.high = result.p = std::nan("");
  const PileValue value{trend.quantity, trend.section};
  if (!trend.bound)
    result.printed =
        half_of_difference(printed_mean(here.comparison, value), printed_mean(there.comparison, value),
                           trend.relative, trend.difference, b.mean);
  const double scale = trend.relative ? std::abs(b.mean) : 1;
  const Welch test = welch(a, b);
  if (!test.known || !(scale > 0)) return result;
  // Of a relative difference the scale scatters, too: var(a / b) = va / b^2 + a^2 vb / b^4.
  const Welch scaled = trend.relative ? welch(a, {b.mean, std::abs(a.mean / b.mean) * b.std, b.n}) : test;
  const double half = scaled.t_95 * scaled.error / scale;
  result.difference = test.difference / scale;
  result.low = result.difference - half, result.high = result.difference + half;
  result.p = test.p;
  result.verdict = verdict_of(result);
  return result;
}

}  // namespace

TrendVerdict judged(double difference, double low, double high, double p, double printed,
                    double printed_half) {
  const bool inside = std::abs(difference - printed) <= std::hypot(0.5 * (high - low), printed_half);
  if (!(p < kSignificant)) return inside ? TrendVerdict::undecided : TrendVerdict::not_seen;
  if (difference * printed < 0) return inside ? TrendVerdict::undecided : TrendVerdict::opposite;
  return inside ? TrendVerdict::agrees : TrendVerdict::other_size;
}

std::vector<Trend> read_trends(const std::filesystem::path& file) {
  CsvTable table(file,
                 {"case", "against", "quantity", "section", "difference", "relative", "relation", "source"});
  std::vector<Trend> trends;
  while (table.next()) {
    Trend trend;
    trend.case_name = table.text("case");
    trend.against = table.text("against");
    trend.quantity = table.text("quantity");
    trend.section = table.text("section");
    trend.difference = table.number("difference");
    trend.relative = table.one_of("relative", {"no", "yes"}) == "yes";
    trend.bound = table.one_of("relation", {"eq", "lt"}) == "lt";
    trend.source = table.text("source");
    trends.push_back(std::move(trend));
  }
  return trends;
}

std::vector<TrendComparison> compare_trends(const std::vector<CaseResult>& cases,
                                            const std::vector<Trend>& trends) {
  std::vector<TrendComparison> comparisons;
  for (const Trend& trend : trends) {
    const CaseResult *here = find(cases, trend.case_name), *there = find(cases, trend.against);
    if (here == nullptr || there == nullptr) continue;
    comparisons.push_back(compared(trend, *here, *there));
  }
  return comparisons;
}

}  // namespace scree
