#include "analysis/statistics/convex_hull.h"

#include <algorithm>
#include <vector>

namespace scree {
namespace {

constexpr double kRounding = 1e-12;  // of squares of distances, and of weights
constexpr int kMostSteps = 1000;     // each adds a point or ends; far more than are needed

// Weights, of sum 1, of the point nearest to the origin in the plane (of any dimension) through some points.
Eigen::VectorXd nearest_in_plane(const Eigen::MatrixXd& points) {
  const Eigen::Index n = points.rows();
  Eigen::MatrixXd bordered = Eigen::MatrixXd::Ones(n + 1, n + 1);
  bordered(n, n) = 0;
  bordered.topLeftCorner(n, n) = points * points.transpose();
  const Eigen::VectorXd right = Eigen::VectorXd::Unit(n + 1, n);
  return bordered.completeOrthogonalDecomposition().solve(right).head(n);
}

}  // namespace

// P. Wolfe, Finding the nearest point in a polytope, Mathematical Programming 11 (1976) 128: a few of the
// points, with weights, whose nearest point is known; the point farthest towards the origin joins them until
// there is none.
Eigen::VectorXd nearest_in_hull(const Eigen::MatrixXd& points, const Eigen::VectorXd& at) {
  const Eigen::MatrixXd from_here = points.rowwise() - at.transpose();
  Eigen::Index first = 0;
  from_here.rowwise().squaredNorm().minCoeff(&first);
  std::vector<Eigen::Index> some{first};
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(1), nearest = from_here.row(first).transpose();
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::Index next = 0;
    const double least = (from_here * nearest).minCoeff(&next);
    if (nearest.squaredNorm() - least <= kRounding) break;
    if (std::find(some.begin(), some.end(), next) != some.end()) break;  // rounding alone
    some.push_back(next);
    weights.conservativeResize(weights.size() + 1);
    weights[weights.size() - 1] = 0;
    while (true) {
      const Eigen::VectorXd plane = nearest_in_plane(from_here(some, Eigen::all));
      // As far towards it as all weights stay positive; those that vanish are left out.
      double share = 1;
      for (Eigen::Index k = 0; k < plane.size(); ++k)
        if (plane[k] <= kRounding) share = std::min(share, weights[k] / (weights[k] - plane[k]));
      weights += share * (plane - weights);
      if (share == 1) break;
      std::vector<Eigen::Index> stay;
      std::vector<double> of_those;
      for (Eigen::Index k = 0; k < weights.size(); ++k)
        if (weights[k] > kRounding) {
          stay.push_back(some[static_cast<std::size_t>(k)]);
          of_those.push_back(weights[k]);
        }
      some = std::move(stay);
      weights = Eigen::Map<const Eigen::VectorXd>(of_those.data(), std::ssize(of_those));
    }
    nearest = from_here(some, Eigen::all).transpose() * weights;
  }
  return at + nearest;
}

}  // namespace scree
