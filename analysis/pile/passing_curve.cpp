#include "analysis/pile/passing_curve.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace scree {
namespace {

// Gauss-Hermite rule of five points for a normal distribution of deviation 1 (Abramowitz & Stegun, 25.4.46):
// its mean and variance are exact, so that mean log d keeps its value.
struct Spread {
  double deviation, share;
};
constexpr Spread kSpread[] = {{-2.8569700138728056, 0.011257411327720693},
                              {-1.3556261799742659, 0.22207592200561264},
                              {0, 0.53333333333333333},
                              {1.3556261799742659, 0.22207592200561264},
                              {2.8569700138728056, 0.011257411327720693}};
constexpr int kHalvings = 60;  // of the range in which a diameter is looked for

}  // namespace

void PassingCurve::Steps::add(double diameter, double mass) {
  const double all = (cumulative.empty() ? 0.0 : cumulative.back()) + mass;
  if (!diameters.empty() && diameters.back() == diameter) {
    cumulative.back() = all;
  } else {
    diameters.push_back(diameter);
    cumulative.push_back(all);
  }
}

PassingCurve::Steps PassingCurve::steps_of(const std::vector<double>& diameters,
                                           const std::vector<double>& masses) {
  std::vector<std::size_t> order(diameters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return diameters[a] < diameters[b]; });
  Steps steps;
  for (const std::size_t i : order) steps.add(diameters[i], masses[i]);
  return steps;
}

PassingCurve::PassingCurve(const std::vector<double>& diameters, const std::vector<double>& masses,
                           double blur)
    : blur_(blur) {
  if (diameters.empty()) throw std::invalid_argument("a passing curve needs at least one grain");
  if (diameters.size() != masses.size())
    throw std::invalid_argument("a passing curve needs one mass for each diameter");
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (!(diameters[i] > 0 && masses[i] > 0))
      throw std::invalid_argument("a passing curve needs diameters and masses above 0");
  if (!(blur >= 0)) throw std::invalid_argument("the blur of a passing curve must be at least 0");
  sharp_ = steps_of(diameters, masses);
  if (blur_ == 0) return;
  std::vector<double> parts, shares;
  for (const Spread& part : kSpread)
    for (std::size_t i = 0; i < masses.size(); ++i) {
      parts.push_back(diameters[i] * std::exp(part.deviation * blur_));
      shares.push_back(part.share * masses[i]);
    }
  blurred_ = steps_of(parts, shares);
}

double PassingCurve::passing(double diameter) const {
  const Steps& steps = seen();
  const auto above = std::upper_bound(steps.diameters.begin(), steps.diameters.end(), diameter);
  return above == steps.diameters.begin()
             ? 0.0
             : steps.cumulative[above - steps.diameters.begin() - 1] / steps.mass();
}

double PassingCurve::diameter(double passing) const {
  assert(passing >= 0 && passing <= 1);
  const double wanted = passing * sharp_.mass();
  if (blur_ > 0) return blurred_diameter(wanted);
  const std::vector<double>&diameters = sharp_.diameters, &cumulative = sharp_.cumulative;
  const auto at = std::lower_bound(cumulative.begin(), cumulative.end(), wanted);
  if (at == cumulative.begin()) return diameters.front();
  if (at == cumulative.end()) return diameters.back();
  const std::size_t i = at - cumulative.begin();
  const double t = (wanted - cumulative[i - 1]) / (cumulative[i] - cumulative[i - 1]);
  return diameters[i - 1] * std::pow(diameters[i] / diameters[i - 1], t);
}

// Smeared is the curve that is linear in log d between grains, not its steps: the more grains are split, the
// more of a curve through them would be steps.
double PassingCurve::blurred_diameter(double wanted) const {
  const std::vector<double>&diameters = sharp_.diameters, &cumulative = sharp_.cumulative;
  const auto finer = [&](double d) {
    const auto above = std::upper_bound(diameters.begin(), diameters.end(), d);
    if (above == diameters.begin()) return 0.0;
    const std::size_t i = above - diameters.begin() - 1;
    if (above == diameters.end()) return cumulative[i];
    return cumulative[i] + (cumulative[i + 1] - cumulative[i]) * std::log(d / diameters[i]) /
                               std::log(diameters[i + 1] / diameters[i]);
  };
  double low = std::log(diameters.front()) + kSpread[0].deviation * blur_,
         high = std::log(diameters.back()) - kSpread[0].deviation * blur_;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    double there = 0;
    for (const Spread& part : kSpread) there += part.share * finer(std::exp(middle - part.deviation * blur_));
    (there < wanted ? low : high) = middle;
  }
  return std::exp(high);
}

namespace {

/// Mean of log10 d over the mass between `low` and `high` (kg from the finest); a grain across a bound counts
/// in part.
double mean_log_between(const std::vector<double>& diameters, const std::vector<double>& cumulative,
                        double low, double high) {
  double sum = 0, mass = 0, before = 0;
  for (std::size_t i = 0; i < diameters.size(); ++i) {
    const double part = std::min(cumulative[i], high) - std::max(before, low);
    if (part > 0) {
      sum += part * std::log10(diameters[i]);
      mass += part;
    }
    before = cumulative[i];
  }
  return sum / mass;
}

}  // namespace

double PassingCurve::mean_log_diameter() const {
  return mean_log_between(seen().diameters, seen().cumulative, 0, seen().mass());
}

double PassingCurve::coarsest_quartile_log_diameter() const {
  return mean_log_between(seen().diameters, seen().cumulative, 0.75 * seen().mass(), seen().mass());
}

}  // namespace scree
