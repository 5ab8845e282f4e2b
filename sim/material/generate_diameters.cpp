// Spheres from a grading: systematic sampling of the curve's mass, from coarse to fine.
//
// With m the mass drawn so far, the next sphere stands for the next stretch [m, m + v(d)] of the curve's
// mass, v(d) being its own. Its diameter is the curve's at a random place u in that stretch:
//
//     d = D(1 - (m + u v(d)) / M),   v(d) = density(d) pi d^3 / 6,   u uniform in [0, 1)
//
// which has one solution, as the left side rises with d and the right side falls; in a gap of the curve,
// where it may lie, an end of the gap is taken: the coarse one while half a sphere of it is left above the
// gap. Each error is carried to the next sphere. At any diameter the mass drawn then differs from the curve's
// by less than the mass of one sphere of about that diameter. Where that is more than the bound (the coarse
// end of a small load), whole draws are repeated, and the first within the bound, or else the nearest to it,
// is taken.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "sim/material/grading.h"
#include "sim/material/random.h"

namespace scree {

namespace {

constexpr double passing_bound = 0.0199;  // share; the promise is 2 points
constexpr double mass_bound = 0.0049;     // share; the promise is 0.5 %
constexpr int most_draws = 200;
constexpr double most_spheres = 2e7;

/// The mass of a sphere grows with d^power.
class SphereShape {
 public:
  explicit SphereShape(const RockDensity& density) : power_(3 + density.exponent) {}
  /// factor d^power
  double operator()(double factor, double d) const {
    return power_ == 3 ? factor * d * d * d : factor * std::pow(d, power_);
  }
  double power() const { return power_; }

 private:
  double power_;
};

/// The curve read from coarse to fine; diameters fall slowly, so that the segment is at hand.
class CoarseToFine {
 public:
  CoarseToFine(const Grading& grading, const SphereShape& shape)
      : points_(grading.points()), shape_(shape), segment_(grading.points().size() - 1) {}

  /// Root d of d = D(1 - (mass_share + scale d^power)), scale below `sphere`: sphere d^power is the share
  /// of the mass that a sphere has.
  double solve(double mass_share, double scale, double sphere) {
    const auto rest = [&](double d) { return 1 - mass_share - shape_(scale, d); };
    while (segment_ + 1 < points_.size() && rest(points_[segment_].diameter) > points_[segment_].passing)
      ++segment_;
    while (segment_ > 1 && rest(points_[segment_ - 1].diameter) < points_[segment_ - 1].passing) --segment_;
    const auto &a = points_[segment_ - 1], &b = points_[segment_];
    // A gap is crossed where less than half a sphere of its coarse end is left above it, whatever u.
    const auto is_left = [&](const Grading::Point& coarse) {
      return 1 - coarse.passing - mass_share >= shape_(0.5 * sphere, coarse.diameter);
    };
    if (segment_ > 1 && a.passing == points_[segment_ - 2].passing && !is_left(a))
      return points_[segment_ - 2].diameter;
    if (a.passing == b.passing) return is_left(b) ? b.diameter : a.diameter;
    const double slope = (b.passing - a.passing) / std::log(b.diameter / a.diameter);
    // f(t) = passing(a e^t) - rest(a e^t) rises; Newton kept inside a shrinking bracket.
    double low = 0, high = std::log(b.diameter / a.diameter);
    if (a.passing >= rest(a.diameter)) return a.diameter;
    if (b.passing <= rest(b.diameter)) return b.diameter;
    double t = 0.5 * (low + high);
    for (int i = 0; i < 60; ++i) {
      const double d = a.diameter * std::exp(t);
      const double f = a.passing + slope * t - rest(d);
      (f > 0 ? high : low) = t;
      double next = t - f / (slope + shape_(shape_.power() * scale, d));
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      if (std::abs(next - t) < 1e-13) break;
      t = next;
    }
    return a.diameter * std::exp(t);
  }

 private:
  const std::vector<Grading::Point>& points_;
  SphereShape shape_;
  std::size_t segment_;
};

std::vector<double> draw(const Grading& grading, double mass, double sphere_factor, const SphereShape& shape,
                         Random& random) {
  CoarseToFine curve(grading, shape);
  const double finest = sphere_factor * std::pow(grading.min_diameter(), shape.power());
  std::vector<double> diameters;
  double drawn = 0;
  // A last sphere that would leave more mass over than without it is not drawn.
  while (drawn + 0.5 * finest < mass) {
    const double d = curve.solve(drawn / mass, random.uniform() * sphere_factor / mass, sphere_factor / mass);
    diameters.push_back(d);
    drawn += shape(sphere_factor, d);
  }
  return diameters;
}

/// Largest of the passing errors at the grading's points and the mass error, each over its bound; 1 or less:
/// both are kept.
double worst_error(const std::vector<double>& diameters, const Grading& grading, double mass,
                   double sphere_factor, const SphereShape& shape) {
  const auto& points = grading.points();
  std::vector<double> between(points.size(), 0.0);  // mass finer than point i, not finer than point i - 1
  double total = 0;
  for (const double d : diameters) {
    const auto above =
        std::lower_bound(points.begin(), points.end(), d,
                         [](const Grading::Point& point, double x) { return point.diameter < x; });
    const double sphere = shape(sphere_factor, d);
    between[std::min<std::size_t>(above - points.begin(), points.size() - 1)] += sphere;
    total += sphere;
  }
  double worst = std::abs(total / mass - 1) / mass_bound, finer = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    finer += between[i];
    worst = std::max(worst, std::abs(finer / total - points[i].passing) / passing_bound);
  }
  return worst;
}

/// mass / density(d) is this times d^-exponent.
double solid_mass_factor(double mass, const RockDensity& density) {
  return mass / density.value * std::pow(density.diameter, density.exponent);
}

}  // namespace

double mean_inverse_power(const Grading& grading, double power) {
  double sum = 0;
  const auto& points = grading.points();
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double a = points[i - 1].diameter, b = points[i].diameter;
    const double stretch = power * std::log(b / a);  // expm1: no cancellation for small powers
    const double mean = stretch == 0 ? 1 : -std::expm1(-stretch) / stretch * std::pow(a, -power);
    sum += (points[i].passing - points[i - 1].passing) * mean;
  }
  return sum;
}

double expected_spheres(const Grading& grading, double mass, const RockDensity& density) {
  return 6 / std::numbers::pi * solid_mass_factor(mass, density) *
         mean_inverse_power(grading, 3 + density.exponent);
}

double solid_volume(const Grading& grading, double mass, const RockDensity& density) {
  return solid_mass_factor(mass, density) * mean_inverse_power(grading, density.exponent);
}

std::vector<double> generate_diameters(const Grading& grading, double mass, const RockDensity& density,
                                       std::uint64_t seed, std::uint64_t dump) {
  if (!(std::isfinite(mass) && mass > 0))
    throw std::invalid_argument(fmt::format("mass {} kg must be above 0", mass));
  if (!(std::isfinite(density.value) && density.value > 0))
    throw std::invalid_argument(fmt::format("density {} kg/m3 must be above 0", density.value));
  const SphereShape shape(density);
  const double sphere_factor =
      density.value * std::numbers::pi / 6 * std::pow(density.diameter, -density.exponent);
  if (mass < sphere_factor * std::pow(grading.min_diameter(), shape.power()))
    throw std::invalid_argument(
        fmt::format("mass {} kg is less than the smallest sphere of grading {}", mass, grading.name()));
  if (const double count = expected_spheres(grading, mass, density); count > most_spheres)
    throw std::invalid_argument(fmt::format("{} kg of grading {} are {:.2g} spheres; scalp its fine end",
                                            mass, grading.name(), count));

  Random random(seed, dump, RandomPurpose::diameters);
  std::vector<double> best;
  double best_error = 0;
  for (int i = 0; i < most_draws; ++i) {
    std::vector<double> diameters = draw(grading, mass, sphere_factor, shape, random);
    const double error = worst_error(diameters, grading, mass, sphere_factor, shape);
    if (best.empty() || error < best_error) {
      best = std::move(diameters);
      best_error = error;
    }
    if (best_error <= 1) break;
  }
  // One sphere can be a little larger than the one before it, each having its own u.
  std::sort(best.begin(), best.end(), std::greater<>());
  return best;
}

}  // namespace scree
