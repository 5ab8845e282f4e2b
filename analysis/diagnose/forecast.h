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

/// Factor, at least 1, by which the covariance of a surface is to be multiplied so that it foretells its
/// errors: the most probable one, with the errors normal, and of a log-normal prior (median 1.5, a factor of
/// 2 one standard deviation). Polynomials through few runs are surer of themselves than they are good.
double widening(const std::vector<Forecast>& forecasts);

}  // namespace scree
