// A sphere on a plate that moves. A velocity of a contact is that of the plate's point below it, rotation
// included.
#include <functional>

#include "tests/verification/scene.h"

namespace scree::verification {
namespace {

constexpr double kRadius = 0.2;
const Surface kPlate{0.5, 0.5};

// Smooth start and stop: share of the way s(t) = (1 - cos(pi t / T)) / 2, in 400 keys; greatest rate pi / (2
// T), greatest acceleration pi^2 / (2 T^2), from 1 s on.
Motion smooth(const std::function<Pose(double share)>& pose, double span) {
  std::vector<Motion::Key> keys{{0.0, pose(0)}};
  for (int k = 0; k <= 400; ++k)
    keys.push_back({1 + span * k / 400, pose(0.5 * (1 - std::cos(kPi * k / 400)))});
  return Motion(keys);
}

// The ball settles for 1 s, is carried, and rests for 1 s. Springs of shear and rolling give way by F / ks
// each, F = m a.
struct Carried {
  Vec3 start, end;
  double give;  ///< m, of both springs in series under m a, a = 1 m/s2
};

Carried carry(const Motion& motion, double x) {
  WorldSettings settings;
  settings.fixed_time_step = 2e-4;
  RrlinearWorld world(settings);
  const Material& m = settings.material;
  const double mass = ball_mass(m, kRadius), kn = wall_stiffness(m, kRadius);
  world.add_spheres({ball({x, 0, kRadius - mass * kGravity / kn}, kRadius)});
  world.add_mesh(make_box({-5, -5, -0.5}, {5, 5, 0}), kPlate, motion);
  world.advance_to(1);
  Carried c;
  c.start = place_of(world, 0);
  world.advance_to(motion.last_time() + 1);
  c.end = place_of(world, 0);
  c.give = 2 * mass / (kn / m.stiffness_ratio);
  return c;
}

TEST(MovingMesh, SphereIsLiftedWithThePlate) {
  const Carried c = carry(smooth(
                              [](double s) {
                                return Pose{{0, 0, 1.5 * s}, Quaternion::Identity()};
                              },
                              3.0),
                          0.3);
  EXPECT_NEAR(c.end.z() - c.start.z(), 1.5, 1e-6 * kRadius);
  EXPECT_NEAR(c.end.x(), c.start.x(), 1e-9);
}

// a = pi^2 / (2 T^2) * way = 0.82 m/s2, below mu g and mu_r g = 4.9: it neither slips nor rolls on. No slider
// is reached, so the springs end where they began.
TEST(MovingMesh, SphereIsCarriedSideways) {
  const Carried c = carry(smooth(
                              [](double s) {
                                return Pose{{1.5 * s, -0.5 * s, 0}, Quaternion::Identity()};
                              },
                              3.0),
                          0.3);
  EXPECT_NEAR(c.end.x() - c.start.x(), 1.5, 0.1 * c.give);
  EXPECT_NEAR(c.end.y() - c.start.y(), -0.5, 0.1 * c.give);
}

// A quarter turn about the vertical through the origin, sphere at 2 m: it arrives at (0, 2). The sphere does
// not spin with the plate, so springs turn with half the plate's rate and creep at most give * a * (half turn
// angle) sideways (no slider is reached).
TEST(MovingMesh, SphereIsCarriedRound) {
  const double span = 4.0, turn = 0.5 * kPi, x = 2;
  const Motion motion = smooth(
      [&](double s) {
        return Pose{Vec3::Zero(), Quaternion(Eigen::AngleAxisd(turn * s, Vec3::UnitZ()))};
      },
      span);
  const Carried c = carry(motion, x);
  const double rate = turn * kPi / (2 * span);                                // greatest, rad/s
  const double a = x * (rate * rate + turn * kPi * kPi / (2 * span * span));  // bound of the acceleration
  EXPECT_LT(a, 0.5 * kGravity);
  EXPECT_NEAR(c.end.x(), 0, c.give * a * 0.5 * turn);
  EXPECT_NEAR(c.end.y(), x, c.give * a * 0.5 * turn);
}

// Velocity while the plate turns: omega x r, with the half step of the integrator.
TEST(MovingMesh, SphereHasTheVelocityOfThePointBelowIt) {
  WorldSettings settings;
  settings.fixed_time_step = 2e-4;
  RrlinearWorld world(settings);
  const Material& m = settings.material;
  const double rate = 0.4, x = 1.5;
  std::vector<Motion::Key> keys;
  for (int k = 0; k <= 10; ++k)
    keys.push_back({double(k), Pose{Vec3::Zero(), Quaternion(Eigen::AngleAxisd(rate * k, Vec3::UnitZ()))}});
  const double rest = ball_mass(m, kRadius) * kGravity / wall_stiffness(m, kRadius);
  world.add_spheres({ball({x, 0, kRadius - rest}, kRadius, {0, rate * x, 0})});
  world.add_mesh(make_box({-5, -5, -0.5}, {5, 5, 0}), kPlate, Motion(keys));
  world.advance_to(6.0);
  const Vec3 at = place_of(world, 0), expected = Vec3(0, 0, rate).cross(at);
  // Local damping of the centripetal force leaves a slow outward creep: 1 % of the speed.
  EXPECT_LT((velocity_of(world, 0) - expected).norm(), 0.01 * rate * x);
}

// A tool that tilts: the sphere stands on a point that goes up on one side.
TEST(MovingMesh, SphereRidesATiltingPlate) {
  const double span = 3.0, tilt = 0.2, x = 2;  // tan(0.2) = 0.20 < mu_r: it stays
  const Motion motion = smooth(
      [&](double s) {
        return Pose{Vec3::Zero(), Quaternion(Eigen::AngleAxisd(-tilt * s, Vec3::UnitY()))};
      },
      span);
  const Carried c = carry(motion, x);
  const Vec3 expected = Quaternion(Eigen::AngleAxisd(-tilt, Vec3::UnitY())) * Vec3(x, 0, c.start.z());
  // The sphere rolls on the plate by what its own rotation lacks: it turns with the plate, so only the
  // springs give way.
  EXPECT_LT((c.end - expected).norm(), 2 * c.give * kGravity * std::sin(tilt));
}

}  // namespace
}  // namespace scree::verification
