#pragma once
// Where a blade without side walls passes next.
#include <Eigen/Geometry>
#include <vector>

#include "sim/io/mesh.h"
#include "sim/io/snapshot.h"

namespace scree {

/// How far a blade reaches from its origin (m): sideways, and forward at any height.
struct BladeReach {
  double low_y = 0, high_y = 0, front = 0;
};
BladeReach reach_of(const TriangleMesh& blade);

/// Grains that a blade can push: on the bench behind the place where it stops (`end`, at most the crest's 0),
/// their centres above its cutting edge (m). Gives their mass (kg).
double rock_before_blade(const std::vector<Grain>& grains, double edge, double end);

/// A pass of the blade along x.
struct BladePass {
  double y = 0;  ///< of the blade's origin, m
  double start =
      0;            ///< x of the blade's origin, m, with everything in the lane that it could touch before it
  double mass = 0;  ///< of the rock in its lane, kg; 0: no lane has any
};

/// The pass along the lane with the most rock, of lanes a quarter of a blade apart that lie on a bench from
/// -half_width to half_width (m); of equal ones that next to the middle.
BladePass next_pass(const std::vector<Grain>& grains, const BladeReach& blade, double edge, double end,
                    double half_width);

/// How far a load must be raised above the ground (height `ground`, m) to lie on what is there: up to the
/// highest rock below its box, whose front is at x, with its middle at y.
double rock_under(const std::vector<Grain>& grains, double x, double y, const Vec3& box, double ground);

/// Mass (kg) of the grains that reach into one of these boxes.
double rock_in(const std::vector<Grain>& grains, const std::vector<Eigen::AlignedBox3d>& boxes);

}  // namespace scree
