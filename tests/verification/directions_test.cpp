// Space has no directions of its own: a scene that is turned, or seen in a mirror, goes the same way, turned
// or mirrored. It does not where one component is wrong, an axis of the world is meant instead of the
// contact's, or a spin is taken for a vector like others.
#include <Eigen/Geometry>
#include <utility>

#include "tests/verification/scene.h"

namespace scree::verification {
namespace {

// Spins are axial: a mirror turns them the other way round.
Vec3 axial(const Eigen::Matrix3d& q, const Vec3& spin) {
  return q.determinant() * (q * spin);
}

TriangleMesh moved(TriangleMesh mesh, const Eigen::Matrix3d& q) {
  for (auto& vertex : mesh.vertices) vertex = q * vertex;
  if (q.determinant() < 0)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

// Three spheres that spin, hit a plate and each other, stick, roll and slide; without local damping, which
// acts on each component by itself.
std::unique_ptr<RrlinearWorld> thrown(const Eigen::Matrix3d& q) {
  WorldSettings settings = undamped(2e-5);
  settings.gravity = q * Vec3(0, 0, -kGravity);
  settings.material.mu = 0.4;
  settings.material.mu_r = 0.3;
  settings.material.normal_damping_ratio = 0.1;
  settings.material.shear_damping_ratio = 0.05;
  auto world = std::make_unique<RrlinearWorld>(settings);
  const auto put = [&](const Vec3& place, double radius, const Vec3& velocity, const Vec3& spin) {
    return ball(q * place, radius, q * velocity, axial(q, spin));
  };
  world->add_spheres({put({0, 0, 0.11}, 0.1, {1, 0.5, -2}, {3, -2, 5}),
                      put({0.25, 0.1, 0.3}, 0.12, {-1, 0, -2}, {0, 4, -3}),
                      put({-0.2, -0.1, 0.25}, 0.08, {1, 0.7, -1.5}, {-5, 1, 2})});
  world->add_mesh(moved(make_box({-5, -5, -1}, {5, 5, 0}), q), {0.5, 0.2}, Motion::fixed(Pose{}));
  return world;
}

TEST(Directions, ASceneGoesTheSameWayTurnedAndMirrored) {
  const Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();
  Random random(7, 0, RandomPurpose::positions);
  // Histories are in single precision: 6e-8 of a force, which every impact after it amplifies.
  for (int trial = 0; trial < 6; ++trial) {
    Eigen::Vector4d turn;
    for (double& each : turn) each = random.uniform(-1, 1);
    Eigen::Matrix3d q = Eigen::Quaterniond(turn).normalized().toRotationMatrix();
    if (trial % 2 == 1) q.col(1) *= -1;  // a mirror
    const auto there = thrown(q), here = thrown(upright);
    for (const double time : {0.05, 0.1, 0.2, 0.4}) {
      there->advance_to(time);
      here->advance_to(time);
      for (const int k : {0, 1, 2}) {
        EXPECT_LT((place_of(*there, k) - q * place_of(*here, k)).norm(), 1e-6)
            << trial << ' ' << time << ' ' << k;
        EXPECT_LT((velocity_of(*there, k) - q * velocity_of(*here, k)).norm(), 1e-5)
            << trial << ' ' << time << ' ' << k;
        EXPECT_LT((spin_of(*there, k) - axial(q, spin_of(*here, k))).norm(), 1e-4)
            << trial << ' ' << time << ' ' << k;
      }
    }
    // They have met: friction with the plate alone would leave the first 0.90 m/s.
    EXPECT_LT(velocity_of(*here, 0).x(), 0.5);
  }
}

}  // namespace
}  // namespace scree::verification
