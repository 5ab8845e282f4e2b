#include "sim/world/mesh_body.h"

#include <algorithm>
#include <cassert>

namespace scree {

btTransform to_bullet(const Pose& pose) {
  const Quaternion& q = pose.rotation;
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), to_bullet(pose.position));
}

MeshBody::MeshBody(TriangleMesh mesh, const Surface& surface, Motion motion)
    : mesh_(std::move(mesh)), surface_(surface), motion_(std::move(motion)) {
  assert(!mesh_.triangles.empty());
  for (const Vec3& v : mesh_.vertices) {
    vertices_.insert(vertices_.end(), {v.x(), v.y(), v.z()});
    extent_ = std::max(extent_, v.norm());
  }
  for (const auto& t : mesh_.triangles) {
    Facet f{mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]],
            Vec3::Zero(),         Vec3::Zero(),         Vec3::Zero()};
    f.low = f.a.cwiseMin(f.b).cwiseMin(f.c);
    f.high = f.a.cwiseMax(f.b).cwiseMax(f.c);
    f.normal = (f.b - f.a).cross(f.c - f.a).normalized();
    facets_.push_back(f);
  }
  arrays_ = std::make_unique<btTriangleIndexVertexArray>(
      static_cast<int>(mesh_.triangles.size()), mesh_.triangles.front().data(),
      static_cast<int>(3 * sizeof(int)), static_cast<int>(mesh_.vertices.size()), vertices_.data(),
      static_cast<int>(3 * sizeof(btScalar)));
  // Uncompressed boxes: quantised ones would depend on the size of the whole mesh.
  shape_ = std::make_unique<btBvhTriangleMeshShape>(arrays_.get(), false);
  shape_->setMargin(0);
  body_ = std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, shape_.get()));
  body_->setCollisionFlags(body_->getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  body_->setActivationState(DISABLE_DEACTIVATION);
  body_->setFriction(surface_.mu);
  move_to(0);
  mark();
  write_back();
}

void MeshBody::write_back() {
  body_->setWorldTransform(to_bullet(state_.pose));
  body_->setInterpolationWorldTransform(body_->getWorldTransform());
  body_->setLinearVelocity(to_bullet(state_.velocity));
  body_->setAngularVelocity(to_bullet(state_.spin));
}

double MeshBody::moved_since_mark() const {
  const double turn = state_.pose.rotation.angularDistance(marked_.rotation);
  return (state_.pose.position - marked_.position).norm() + turn * extent_;
}

void MeshBody::facets_near(const Vec3& point, double range, std::vector<int>& facets) const {
  struct Collect : btTriangleCallback {
    std::vector<int>& out;
    explicit Collect(std::vector<int>& o) : out(o) {}
    void processTriangle(btVector3*, int, int index) override { out.push_back(index); }
  };
  const std::size_t first = facets.size();
  Collect collect(facets);
  const btVector3 local = to_bullet(state_.pose.to_local(point)), half(range, range, range);
  shape_->processAllTriangles(&collect, local - half, local + half);
  std::sort(facets.begin() + static_cast<std::ptrdiff_t>(first), facets.end());
}

}  // namespace scree
