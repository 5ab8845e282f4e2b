#pragma once
// The vector type of the whole program.
#include <Eigen/Core>
#include <Eigen/Geometry>

namespace scree {
using Vec3 = Eigen::Vector3d;
using Quaternion = Eigen::Quaterniond;

/// A rigid placement: world = position + rotation * local.
struct Pose {
  Vec3 position = Vec3::Zero();  ///< m
  Quaternion rotation = Quaternion::Identity();
  Vec3 to_world(const Vec3& local) const { return position + rotation * local; }
  Vec3 to_local(const Vec3& world) const { return rotation.conjugate() * (world - position); }
};
}  // namespace scree
