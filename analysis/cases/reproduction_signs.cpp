#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/cases/reproduction.h"

namespace scree {
namespace {

VelocityTrend trend_of(const PileValue& value, std::vector<const CaseResult*> cases) {
  VelocityTrend trend;
  trend.value = value;
  std::map<double, std::vector<double>> groups;
  std::vector<double> velocities, values;
  std::vector<double> every_velocity;
  std::vector<PrintedMean> repeats;
  for (const CaseResult* each : cases) {
    for (const Outputs& seed : each->runs.seeds)
      if (const auto number = output_for(value, seed)) {
        groups[*each->blade_velocity].push_back(*number);
        velocities.push_back(*each->blade_velocity);
        values.push_back(*number);
      }
    repeats.push_back(printed_mean(each->comparison, value));
    every_velocity.push_back(*each->blade_velocity);
    if (const PrintedMean& printed = repeats.back(); printed.mean)
      trend.printed.push_back({*each->blade_velocity, *printed.mean, printed.std.value_or(std::nan(""))});
  }
  trend.first = cases.front()->name, trend.last = cases.back()->name;
  trend.runs = values.size();
  trend.here = slope_of(velocities, values);
  std::vector<std::vector<double>> in_order;
  for (const auto& [velocity, group] : groups) {
    const MeanStd both = mean_std(group);
    trend.means.push_back({velocity, both.mean, both.n > 1 ? both.std : std::nan("")});
    in_order.push_back(group);
  }
  trend.order = jonckheere_terpstra(in_order);
  std::vector<double> printed_velocities, printed;
  for (const auto& point : trend.printed) {
    printed_velocities.push_back(point.x);
    printed.push_back(point.y);
  }
  trend.printed_slope = slope_of(printed_velocities, printed).slope;
  trend.printed_slope_half = half_of_slope(every_velocity, repeats);
  if (std::isfinite(trend.printed_slope) && std::isfinite(trend.here.p))
    trend.verdict = judged(trend.here.slope, trend.here.low, trend.here.high, trend.here.p,
                           trend.printed_slope, trend.printed_slope_half.half);
  return trend;
}

}  // namespace

std::vector<SegregationSigns> segregation_signs(const std::vector<CaseResult>& cases) {
  std::vector<SegregationSigns> all;
  for (const CaseResult& each : cases) {
    SegregationSigns signs;
    signs.case_name = each.name, signs.title = each.title;
    std::vector<double> crest, toe;
    for (const Outputs& seed : each.runs.seeds) {
      if (!seed.contains("chi_S1") || !seed.contains("chi_S6")) continue;
      crest.push_back(seed.at("chi_S1"));
      toe.push_back(seed.at("chi_S6"));
      signs.as_expected += crest.back() < 0 && toe.back() > 0;
    }
    if (crest.empty()) continue;
    signs.crest = mean_std(crest), signs.toe = mean_std(toe);
    signs.p_crest = p_of_sign(signs.crest, -1), signs.p_toe = p_of_sign(signs.toe, +1);
    signs.zero = spread_of(each.runs.seeds, "chi_zero_x_over_l");
    signs.printed_zero = printed_mean(each.comparison, {"xl_chi_zero", "whole"}).mean;
    all.push_back(std::move(signs));
  }
  return all;
}

std::vector<VelocityTrend> velocity_trends(const std::vector<CaseResult>& cases) {
  std::vector<const CaseResult*> pushed;
  for (const CaseResult& each : cases)
    if (each.blade_velocity && !each.runs.seeds.empty()) pushed.push_back(&each);
  std::stable_sort(pushed.begin(), pushed.end(),
                   [](const auto* a, const auto* b) { return *a->blade_velocity < *b->blade_velocity; });
  std::vector<double> velocities;
  for (const CaseResult* each : pushed)
    if (velocities.empty() || *each->blade_velocity > velocities.back())
      velocities.push_back(*each->blade_velocity);
  std::vector<VelocityTrend> trends;
  if (velocities.size() < 3) return trends;
  for (const char* quantity : {"chi", "d50_rel"}) {
    VelocityTrend trend = trend_of({quantity, "S1"}, pushed);
    if (trend.runs > 0) trends.push_back(std::move(trend));
  }
  return trends;
}

}  // namespace scree
