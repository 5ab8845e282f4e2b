#include "analysis/cases/printed_scatter.h"

#include <algorithm>
#include <cmath>

#include "analysis/statistics/welch.h"

namespace scree {
namespace {

// Of a sum of means, each times the root of its entry of `squares` (0: the mean is not in it). A mean without
// a scatter takes the mean of the others' variances. Degrees of freedom by Welch and Satterthwaite.
PrintedHalf half_of_sum(const std::vector<double>& squares, const std::vector<PrintedMean>& printed) {
  double borrowed = 0;
  int known = 0;
  for (std::size_t k = 0; k < printed.size(); ++k)
    if (printed[k].scatters())
      ++known;
    else
      borrowed += squares[k];
  PrintedHalf result;
  double variance = 0, parts2 = 0;
  for (std::size_t k = 0; k < printed.size(); ++k) {
    const PrintedMean& each = printed[k];
    if (!each.scatters()) continue;
    const double part = (squares[k] + borrowed / known) * *each.std * *each.std / each.repeats;
    variance += part;
    parts2 += part * part / (each.repeats - 1);
    result.at_most |= part > 0 && each.at_most;
  }
  if (variance > 0) result.half = t_95(variance * variance / parts2) * std::sqrt(variance);
  return result;
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
  if (!relative) return half_of_sum({1, 1}, {a, b});
  const double sign = std::copysign(1.0, b.mean.value_or(std::isnan(our_b) ? a.mean.value_or(1) : our_b));
  const double ratio = 1 + sign * difference;
  const double scale = b.mean ? *b.mean : a.mean && ratio != 0 ? *a.mean / ratio : our_b;
  if (!(std::abs(scale) > 0)) return {};
  return half_of_sum({1 / (scale * scale), ratio * ratio / (scale * scale)}, {a, b});
}

PrintedHalf half_of_slope(const std::vector<double>& x, const std::vector<PrintedMean>& printed) {
  std::vector<double> places;
  for (std::size_t k = 0; k < x.size(); ++k)
    if (printed[k].mean) places.push_back(x[k]);
  const double middle = mean_std(places).mean;
  double xx = 0;
  for (const double place : places) xx += (place - middle) * (place - middle);
  if (!(xx > 0)) return {};
  std::vector<double> squares(x.size(), 0.0);
  for (std::size_t k = 0; k < x.size(); ++k)
    if (printed[k].mean) squares[k] = std::pow((x[k] - middle) / xx, 2);
  return half_of_sum(squares, printed);
}

}  // namespace scree
