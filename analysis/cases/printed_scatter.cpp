#include "analysis/cases/printed_scatter.h"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/welch.h"

namespace scree {
namespace {

// Of the mean of the repeats.
double variance(double std, int repeats) {
  return std * std / repeats;
}

}  // namespace

PrintedMean printed_mean(const std::vector<Comparison>& compared, const PileValue& value) {
  PrintedMean printed;
  std::optional<double> scatter;
  bool at_most = false;
  for (const Comparison& row : compared) {
    const ReferenceValue& r = row.reference;
    if (r.kind != "pfc3d") continue;
    printed.repeats = std::max(printed.repeats, r.repeats);
    if (r.section != value.section) continue;
    const Meaning meaning = meaning_of(r);
    if (r.quantity == value.quantity && meaning == Meaning::value) {
      printed.mean = r.value;
      printed.std = r.std;
    }
    if (r.quantity != value.quantity + "_scatter" || meaning == Meaning::at_least) continue;
    if (scatter && !at_most) continue;
    scatter = r.upper.value_or(r.value);
    at_most = meaning != Meaning::value;
  }
  if (!printed.std) {
    printed.std = scatter;
    printed.at_most = at_most;
  }
  return printed;
}

PrintedHalf half_of_difference(const PrintedMean& a, const PrintedMean& b, bool relative, double difference,
                               double our_b) {
  if (!a.scatters() && !b.scatters()) return {};
  double scale = 1, ratio = 1;
  if (relative) {
    const double sign = std::copysign(1.0, b.mean.value_or(a.mean.value_or(our_b)));
    ratio = 1 + sign * difference;
    scale = std::abs(b.mean ? *b.mean : a.mean && ratio != 0 ? *a.mean / ratio : our_b);
    if (!(scale > 0)) return {};
  }
  const bool at_most = (a.scatters() && a.at_most) || (b.scatters() && b.at_most);
  if (a.scatters() && b.scatters()) {
    const Welch test = welch({0, *a.std, a.repeats}, {0, std::abs(ratio) * *b.std, b.repeats});
    return {test.t_95 * test.error / scale, at_most};
  }
  const PrintedMean& known = a.scatters() ? a : b;
  const auto repeats = [&](const PrintedMean& each) {
    return each.repeats > 1 ? each.repeats : known.repeats;
  };
  const double error =
      std::sqrt(variance(*known.std, repeats(a)) + ratio * ratio * variance(*known.std, repeats(b)));
  return {t_95(known.repeats - 1) * error / scale, at_most};
}

PrintedHalf half_of_slope(const std::vector<double>& x, const std::vector<PrintedMean>& printed) {
  PrintedHalf result;
  double others = 0, freedom = 0;
  int known = 0;
  std::vector<double> places;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (printed[k].mean) places.push_back(x[k]);
    if (!printed[k].scatters()) continue;
    others += variance(*printed[k].std, printed[k].repeats);
    freedom += printed[k].repeats - 1;
    result.at_most |= printed[k].at_most;
    ++known;
  }
  if (known == 0) return {};
  others /= known;
  const double middle = mean_std(places).mean;
  double xx = 0, sum = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!printed[k].mean) continue;
    const double arm2 = (x[k] - middle) * (x[k] - middle);
    xx += arm2;
    sum += arm2 * (printed[k].scatters() ? variance(*printed[k].std, printed[k].repeats) : others);
  }
  if (xx > 0) result.half = t_95(freedom) * std::sqrt(sum) / xx;
  return result;
}

}  // namespace scree
