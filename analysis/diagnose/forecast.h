#pragma once
// How good a response surface has proved: what it said of simulations before it had learnt from them.
#include <vector>

namespace scree {

/// Error of a forecast along a direction in which errors are independent of those along the others; both
/// over the variance of one simulation between seeds.
struct Forecast {
  double variance = 0;  ///< of what the surface did not know, as it said itself
  double square = 0;    ///< of the error that came out, the scatter of the simulations included
};

/// Factors, at least 1, by which the scatter between seeds and the covariance of a surface are to be
/// multiplied so that it foretells its errors.
struct Widening {
  double scatter = 1, covariance = 1;
};

/// The most probable ones, with the errors normal of variance g (1 + f v): g widens the scatter, and g f the
/// covariance, which is in its unit. g is that of directions of which the surface knows all, differences
/// between seeds at one point: simulations scatter otherwise where they are drawn to than over the design. f
/// is that of directions of which it knows more than half a simulation tells, as it does of what it fits.
/// A priori both are log-normal (medians 1 and 1.5): polynomials through few runs are surer of themselves
/// than they are good.
Widening widening(const std::vector<Forecast>& forecasts);

}  // namespace scree
