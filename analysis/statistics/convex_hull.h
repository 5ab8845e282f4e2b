#pragma once
// What a set of points surrounds.
#include <Eigen/Dense>

namespace scree {

/// The point of the convex hull of `points` (a row each, one at least) that is nearest to `at`: `at` itself
/// where it is inside. Within 1e-6 where the numbers are about 1.
Eigen::VectorXd nearest_in_hull(const Eigen::MatrixXd& points, const Eigen::VectorXd& at);

}  // namespace scree
