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
    const double here = r.upper.value_or(r.value);
    const bool bound = meaning != Meaning::value;
    if (scatter && bound && (!at_most || here >= *scatter)) continue;
    scatter = here;
    at_most = bound;
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
    const double sign = std::copysign(1.0, b.mean.value_or(std::isnan(our_b) ? a.mean.value_or(1) : our_b));
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
  std::vector<double> places;
  int known = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (printed[k].mean) places.push_back(x[k]);
    known += printed[k].scatters();
  }
  if (known == 0) return {};
  // What each variance counts: by its own mean, and by its part of those that are borrowed.
  const double middle = mean_std(places).mean;
  double xx = 0, borrowed = 0;
  std::vector<double> counts(x.size(), 0.0);
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!printed[k].mean) continue;
    const double arm2 = (x[k] - middle) * (x[k] - middle);
    xx += arm2;
    (printed[k].scatters() ? counts[k] : borrowed) += arm2;
  }
  PrintedHalf result;
  double sum = 0, squares = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (!printed[k].scatters()) continue;
    const double count = counts[k] + borrowed / known;
    const double part = count * variance(*printed[k].std, printed[k].repeats);
    sum += part;
    squares += part * part / (printed[k].repeats - 1);
    result.at_most |= count > 0 && printed[k].at_most;
  }
  if (xx > 0 && sum > 0) result.half = t_95(sum * sum / squares) * std::sqrt(sum) / xx;
  return result;
}

}  // namespace scree
