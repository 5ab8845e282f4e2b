#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "analysis/segregation.h"

namespace scree {

PassingCurve::PassingCurve(std::vector<double> diameters, const std::vector<double>& masses) {
  if (diameters.empty()) throw std::invalid_argument("a passing curve needs at least one grain");
  if (diameters.size() != masses.size())
    throw std::invalid_argument("a passing curve needs one mass for each diameter");
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (!(diameters[i] > 0 && masses[i] > 0))
      throw std::invalid_argument("a passing curve needs diameters and masses above 0");
  std::vector<std::size_t> order(diameters.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return diameters[a] < diameters[b]; });
  for (const std::size_t i : order) {
    mass_ += masses[i];
    if (!diameters_.empty() && diameters_.back() == diameters[i]) {
      cumulative_.back() = mass_;
    } else {
      diameters_.push_back(diameters[i]);
      cumulative_.push_back(mass_);
    }
  }
}

double PassingCurve::passing(double diameter) const {
  const auto above = std::upper_bound(diameters_.begin(), diameters_.end(), diameter);
  return above == diameters_.begin() ? 0.0 : cumulative_[above - diameters_.begin() - 1] / mass_;
}

double PassingCurve::diameter(double passing) const {
  assert(passing >= 0 && passing <= 1);
  const double wanted = passing * mass_;
  const auto at = std::lower_bound(cumulative_.begin(), cumulative_.end(), wanted);
  if (at == cumulative_.begin()) return diameters_.front();
  if (at == cumulative_.end()) return diameters_.back();
  const std::size_t i = at - cumulative_.begin();
  const double t = (wanted - cumulative_[i - 1]) / (cumulative_[i] - cumulative_[i - 1]);
  return diameters_[i - 1] * std::pow(diameters_[i] / diameters_[i - 1], t);
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
  return mean_log_between(diameters_, cumulative_, 0, mass_);
}

double PassingCurve::coarsest_quartile_log_diameter() const {
  return mean_log_between(diameters_, cumulative_, 0.75 * mass_, mass_);
}

double PassingCurve::finest_quartile_log_diameter() const {
  return mean_log_between(diameters_, cumulative_, 0, 0.25 * mass_);
}

}  // namespace scree
