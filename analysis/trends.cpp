#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <stdexcept>

#include "analysis/csv_table.h"
#include "analysis/outputs.h"
#include "analysis/reproduction.h"

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
  ReferenceValue what;
  what.case_name = trend.case_name;
  what.quantity = trend.quantity;
  what.section = trend.section;
  std::vector<double> values;
  for (const Outputs& seed : result.seeds)
    if (const auto value = output_for(what, seed)) values.push_back(*value);
  return mean_std(values);
}

}  // namespace

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
    const MeanStd a = spread(*here, trend), b = spread(*there, trend);
    if (a.n < 2 || b.n < 2) continue;
    const double va = a.std * a.std / a.n, vb = b.std * b.std / b.n;
    const double scale = trend.relative ? std::abs(b.mean) : 1;
    const double error = std::sqrt(va + vb), difference = a.mean - b.mean;
    if (!(error > 0) || !(scale > 0)) continue;
    // Welch, Biometrika 34 (1947) 28: degrees of freedom of two samples of unequal variance.
    const double freedom = (va + vb) * (va + vb) / (va * va / (a.n - 1) + vb * vb / (b.n - 1));
    const boost::math::students_t distribution(freedom);
    const double wide = boost::math::quantile(distribution, 0.975) * error;
    comparisons.push_back(
        {trend, difference / scale, (difference - wide) / scale, (difference + wide) / scale,
         2 * boost::math::cdf(boost::math::complement(distribution, std::abs(difference) / error))});
  }
  return comparisons;
}

}  // namespace scree
