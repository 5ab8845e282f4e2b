#include "analysis/statistics/welch.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace scree {

double t_95(double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom), 0.975);
}

Welch welch(const MeanStd& a, const MeanStd& b) {
  Welch test;
  test.difference = a.mean - b.mean;
  if (a.n < 2 || b.n < 2) return test;
  const double va = a.std * a.std / a.n, vb = b.std * b.std / b.n;
  test.error = std::sqrt(va + vb);
  if (!(test.error > 0)) return test;
  const double freedom = (va + vb) * (va + vb) / (va * va / (a.n - 1) + vb * vb / (b.n - 1));
  const boost::math::students_t distribution(freedom);
  test.t_95 = t_95(freedom);
  test.p =
      2 * boost::math::cdf(boost::math::complement(distribution, std::abs(test.difference) / test.error));
  test.known = true;
  return test;
}

}  // namespace scree
