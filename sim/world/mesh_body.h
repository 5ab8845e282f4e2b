#pragma once
// A mesh in the world: a kinematic Bullet body with a triangle BVH, moved by a prescribed motion.
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <string>
#include <vector>

#include "sim/io/mesh.h"
#include "sim/material/material.h"
#include "sim/world/motion.h"

namespace scree {

inline btVector3 to_bullet(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
inline Vec3 from_bullet(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}
btTransform to_bullet(const Pose& pose);

/// A triangle ready for the closest-point test, in the mesh's own frame.
struct Facet {
  Vec3 a, b, c;
  Vec3 normal;     ///< unit, outward
  Vec3 low, high;  ///< its box

  /// True if the box comes closer to a point than `range` along every axis.
  bool box_within(const Vec3& point, double range) const {
    return point.x() + range > low.x() && point.x() - range < high.x() && point.y() + range > low.y() &&
           point.y() - range < high.y() && point.z() + range > low.z() && point.z() - range < high.z();
  }
};

class MeshBody {
 public:
  MeshBody(TriangleMesh mesh, const Surface& surface, Motion motion);
  MeshBody(const MeshBody&) = delete;
  MeshBody& operator=(const MeshBody&) = delete;

  const TriangleMesh& mesh() const { return mesh_; }
  const Surface& surface() const { return surface_; }
  const Motion& motion() const { return motion_; }
  const BodyState& state() const { return state_; }
  const std::vector<Facet>& facets() const { return facets_; }
  btRigidBody& body() { return *body_; }

  /// Replaces the motion; it should start where the body is.
  void set_motion(Motion motion) { motion_ = std::move(motion); }
  /// Moves to a time; does not touch the Bullet body.
  void move_to(double time) { state_ = motion_.at(time); }
  /// Writes pose and velocity to the Bullet body.
  void write_back();

  /// Speed of its fastest point (m/s, an upper bound).
  double fastest_point() const { return state_.velocity.norm() + state_.spin.norm() * extent_; }
  /// How far any point of the mesh may have moved since mark() (m, an upper bound).
  double moved_since_mark() const;
  void mark() { marked_ = state_.pose; }

  /// Appends every facet whose box meets the cube of half width `range` (m) about a
  /// world point, by Bullet's BVH, in rising order.
  void facets_near(const Vec3& point, double range, std::vector<int>& facets) const;

  /// For saving and going on: world_state.cpp.
  template <class Stream>
  void pose_state(Stream& stream);

 private:
  TriangleMesh mesh_;
  Surface surface_;
  Motion motion_;
  BodyState state_;
  Pose marked_;
  double extent_ = 0;  // largest distance of a vertex from the origin of the frame
  std::vector<Facet> facets_;
  std::vector<btScalar> vertices_;
  std::unique_ptr<btTriangleIndexVertexArray> arrays_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
  std::unique_ptr<btRigidBody> body_;
};

}  // namespace scree
