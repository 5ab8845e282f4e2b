// Spheres on triangulated surfaces: what they feel is the surface, not its triangles.
#include "tests/verification/meshes.h"

namespace scree::verification {
namespace {

// Runs the same ball over two meshes of the plane z = 0, step by step side by side.
void expect_same_run(const TriangleMesh& reference, const TriangleMesh& mesh, double radius, double speed,
                     double spin, double length) {
  WorldSettings settings;
  settings.material.local_damping = 0;
  settings.material.effective_modulus = 1e6;
  const double mass = ball_mass(settings.material, radius), kn = wall_stiffness(settings.material, radius);
  settings.fixed_time_step = 0.1 * std::sqrt(mass / kn);
  const double rest = mass * kGravity / kn;
  const NewSphere start =
      ball({0.1 * length, 0.013, radius - rest}, radius, {speed, 0.07 * speed, 0}, {0, spin, 0});
  RrlinearWorld one(settings), two(settings);
  one.add_spheres({start});
  two.add_spheres({start});
  one.add_mesh(reference, {0.3, 0.1}, Motion::fixed(Pose{}));
  two.add_mesh(mesh, {0.3, 0.1}, Motion::fixed(Pose{}));
  const double path = 0.7 * length;
  int steps = 0;
  while (place_of(one, 0).x() < start.position.x() + path && ++steps < 20000) {
    step(one);
    step(two);
    const auto a = one.mesh_contacts(0), b = two.mesh_contacts(0);
    ASSERT_EQ(a.size(), 1u);
    ASSERT_EQ(b.size(), 1u) << "at x = " << place_of(two, 0).x();
    // The weight, whatever the triangles below.
    ASSERT_NEAR(kn * b[0].overlap, mass * kGravity, 1e-6 * mass * kGravity);
    // Memory is kept over seams; the springs differ by what the places do.
    const double friction = 0.3 * mass * kGravity;
    ASSERT_LT((a[0].history.shear - b[0].history.shear).norm(), 1e-6 * friction);
    ASSERT_LT((a[0].history.rolling - b[0].history.rolling).norm(), 1e-6 * friction * radius);
    if (one.spheres().velocity[0].x < 0.05 * speed) break;  // has come to rest: nothing more to cross
  }
  const double travelled = place_of(one, 0).x() - start.position.x();
  EXPECT_GT(travelled, 0.2 * length);
  EXPECT_LT((place_of(one, 0) - place_of(two, 0)).norm(), 1e-6 * travelled);
}

struct Strip {
  const char* name;
  TriangleMesh (*make)();
  double radius;
};

constexpr double kLength = 2.0, kWidth = 0.6;

class Seams : public testing::TestWithParam<Strip> {};

TEST_P(Seams, RollingBallFeelsOnePlane) {
  const double speed = 2.0;
  expect_same_run(coarse_strip(kLength, kWidth), GetParam().make(), GetParam().radius, speed,
                  speed / GetParam().radius, kLength);
}

TEST_P(Seams, SlidingBallFeelsOnePlane) {
  expect_same_run(coarse_strip(kLength, kWidth), GetParam().make(), GetParam().radius, 3.0, 0, kLength);
}

INSTANTIATE_TEST_SUITE_P(
    Strips, Seams,
    testing::Values(Strip{"RegularFine", [] { return regular_strip(kLength, kWidth, 100, 30); }, 0.1},
                    Strip{"RegularVeryFine", [] { return regular_strip(kLength, kWidth, 200, 60); }, 0.12},
                    Strip{"RegularLarge", [] { return regular_strip(kLength, kWidth, 4, 2); }, 0.02},
                    Strip{"JitteredFine", [] { return jittered_strip(kLength, kWidth, 80, 24); }, 0.1},
                    Strip{"JitteredLarge", [] { return jittered_strip(kLength, kWidth, 6, 3); }, 0.03},
                    Strip{"MismatchedFine", [] { return mismatched_strip(kLength, kWidth, 60, 20); }, 0.1},
                    Strip{"MismatchedLarge", [] { return mismatched_strip(kLength, kWidth, 3, 4); }, 0.02},
                    Strip{"ClosedBoxFine", [] { return fine_box(kLength, kWidth, 0.5, 80, 24, 10); }, 0.1},
                    Strip{"ClosedThinBoxFine", [] { return fine_box(kLength, kWidth, 0.05, 80, 24, 2); },
                          0.1}),
    [](const auto& p) { return std::string(p.param.name); });

TEST(SeamMeshes, AreWhatTheirNamesSay) {
  EXPECT_TRUE(fine_box(1, 1, 0.5, 4, 4, 2).closed);
  EXPECT_FALSE(regular_strip(1, 1, 4, 4).closed);
  EXPECT_FALSE(mismatched_strip(1, 1, 4, 4).closed);
}

// A centre that is carried over the ridge of a roof at constant height has one contact: the closest point of
// the roof.
class Ridge : public testing::TestWithParam<double> {};

TEST_P(Ridge, OneContactAtATimeWhateverTheTriangles) {
  const double angle = GetParam() * kPi / 180, slope = 0.5 * (kPi - angle), radius = 0.2;
  Surfaces coarse(roof(angle, 1.0, 2.0, 1, 1)), fine(roof(angle, 1.0, 2.0, 33, 47));
  const double height = 0.95 * radius;
  bool began = false;
  for (double x = -0.15; x <= 0.15; x += 0.0007) {
    const Vec3 centre(x, 0.011 + 0.3 * x, height);
    const auto a = coarse.touch(centre, radius), b = fine.touch(centre, radius);
    // Distance from the roof: to a side while the foot lies on it, else to the ridge.
    const double ax = std::abs(x);
    const bool on_side = ax * std::cos(slope) - height * std::sin(slope) > 0;
    const double distance =
        on_side ? ax * std::sin(slope) + height * std::cos(slope) : std::hypot(ax, height);
    if (distance >= radius) continue;
    ASSERT_EQ(a.size(), 1u) << x;
    ASSERT_EQ(b.size(), 1u) << x;
    EXPECT_NEAR(a[0].overlap, radius - distance, 1e-9 * radius);
    EXPECT_NEAR(b[0].overlap, radius - distance, 1e-9 * radius);
    EXPECT_LT((a[0].normal - b[0].normal).norm(), 1e-9);
    began = true;
  }
  EXPECT_TRUE(began);
}

TEST_P(Ridge, MemoryGoesOverTheRidge) {
  const double angle = GetParam() * kPi / 180, slope = 0.5 * (kPi - angle), radius = 0.2, gap = 0.19;
  Surfaces fine(roof(angle, 1.0, 2.0, 33, 47));
  // Along the offset surface at distance `gap`: left side, round the ridge, right side.
  std::vector<Vec3> path;
  for (double s = 0.1; s > 0; s -= 1e-3)
    path.push_back(s * Vec3(-std::cos(slope), 0, -std::sin(slope)) +
                   gap * Vec3(-std::sin(slope), 0, std::cos(slope)));
  for (double a = -slope; a <= slope; a += 5e-3) path.push_back(gap * Vec3(std::sin(a), 0, std::cos(a)));
  for (double s = 0; s < 0.1; s += 1e-3)
    path.push_back(s * Vec3(std::cos(slope), 0, -std::sin(slope)) +
                   gap * Vec3(std::sin(slope), 0, std::cos(slope)));
  fine.touch(path[0], radius);
  fine.slots[0].history.shear = {0, 7, 0};
  for (const Vec3& centre : path) {
    const auto contacts = fine.touch(centre, radius);
    ASSERT_EQ(contacts.size(), 1u);
    EXPECT_NEAR(contacts[0].overlap, radius - gap, 1e-9);
    ASSERT_EQ(contacts[0].history.shear.y(), 7);
  }
}

INSTANTIATE_TEST_SUITE_P(Angles, Ridge, testing::Values(150.0, 120.0, 90.0, 60.0));

class Corner : public testing::TestWithParam<double> {};

TEST_P(Corner, ConcaveCornerIsTwoContacts) {
  const double angle = GetParam() * kPi / 180, radius = 0.2;
  const Vec3 wall_normal(std::sin(angle), 0, -std::cos(angle));
  for (const int n : {1, 29}) {
    Surfaces surfaces(corner(angle, 2.0, 2.0, n, n + n / 2));
    // Centre at 0.97 r from the floor, 0.95 r from the wall.
    const double z = 0.97 * radius;
    for (double y = -0.2; y < 0.2; y += 0.003) {
      const double x = (0.95 * radius + z * std::cos(angle)) / std::sin(angle);
      const auto contacts = surfaces.touch({x, y, z}, radius);
      ASSERT_EQ(contacts.size(), 2u) << n << " " << y;
      for (const MeshContact& c : contacts) {
        const bool floor = (c.normal - Vec3(0, 0, 1)).norm() < (c.normal - wall_normal).norm();
        EXPECT_LT((c.normal - (floor ? Vec3(0, 0, 1) : wall_normal)).norm(), 1e-9);
        EXPECT_NEAR(c.overlap, (floor ? 0.03 : 0.05) * radius, 1e-9);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Angles, Corner, testing::Values(60.0, 90.0, 120.0, 150.0));

// u / r = v sqrt(4 rho / (3 E)) for any radius: at 25 m/s and E = 1 MPa the sphere is pressed 1.5 radii deep
// and comes back with the speed it came with (no damping).
double rebound_speed(TriangleMesh wall, double speed, double x = 0.07, double y = 0.03) {
  WorldSettings settings = weightless(0);
  settings.time_step_safety = 0.1;
  RrlinearWorld world(settings);
  const double radius = 0.5;
  world.add_spheres({ball({x, y, radius + 0.1}, radius, {0, 0, -speed})});
  world.add_mesh(std::move(wall), {0, 0}, Motion::fixed(Pose{}));
  world.advance_to(6 * radius / speed + 0.5);
  EXPECT_GT(world.statistics().largest_overlap_ratio, 0.99 * speed * std::sqrt(4 * 2760.0 / 3e6));
  return velocity_of(world, 0).z();
}

TEST(PressedThrough, FaceOfAThickWallPushesBack) {
  EXPECT_NEAR(rebound_speed(make_box({-5, -5, -5}, {5, 5, 0}), 25), 25, 0.25);
}

TEST(PressedThrough, SheetPushesBackToTheSideItCameFrom) {
  EXPECT_NEAR(rebound_speed(regular_strip(10, 4, 1, 1), 10), 10, 0.1);
}

// The centre stands exactly over a diagonal: the closest point of both triangles is on their common edge.
TEST(PressedThrough, SeamBelowTheCentreChangesNothing) {
  EXPECT_NEAR(rebound_speed(make_box({-5, -5, -5}, {5, 5, 0}), 25, 0, 0), 25, 0.25);
  MeshMaker sheet;
  sheet.patch({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 1, 1);
  EXPECT_NEAR(rebound_speed(sheet.mesh(), 25, 0, 0), 25, 0.25);
  MeshMaker fine;
  fine.patch({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 10, 10);
  EXPECT_NEAR(rebound_speed(fine.mesh(), 25, 0, 0), 25, 0.25);
}

TEST(PressedThrough, FastSphereDoesNotPassASheet) {
  MeshMaker m;
  m.patch({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 7, 7);
  EXPECT_NEAR(rebound_speed(m.mesh(), 25), 25, 0.25);
}

TEST(PressedThrough, FastSphereDoesNotPassAThinClosedWall) {
  // 0.1 m thick, a tenth of the diameter; 25 m/s would press the centre 0.26 m behind the front.
  EXPECT_NEAR(rebound_speed(make_box({-5, -5, -0.1}, {5, 5, 0}), 25), 25, 0.25);
}

// A sphere that starts within solid rock (its centre behind all faces) is left alone; when it comes out, it
// must not be shot off: kn r^2 / 2 would make 16.5 m/s at E = 1 MPa.
TEST(PressedThrough, SphereThatStartsInsideAWallIsNotShotOut) {
  WorldSettings settings = undamped(0);
  RrlinearWorld world(settings);
  const double radius = 0.5, depth = 5;
  world.add_spheres({ball({0, 0, -4.0}, radius)});
  world.add_mesh(make_box({-5, -5, -depth}, {5, 5, 0}), {0, 0}, Motion::fixed(Pose{}));
  world.advance_to(1.0);
  EXPECT_LT(velocity_of(world, 0).norm(), 1.05 * kGravity * 1.0);
}

// A sphere between two parallel walls of one mesh touches both from the inside.
TEST(Channel, TwoWallsOfOneMeshAreTwoContacts) {
  const double radius = 0.5, half = 0.49;
  MeshMaker sheet;
  sheet.patch({-half, -2, -2}, {0, 4, 0}, {0, 0, 4}, 3, 3);
  sheet.patch({half, -2, -2}, {0, 4, 0}, {0, 0, 4}, 3, 3);
  MeshMaker inwards;
  inwards.patch({-half, -2, -2}, {0, 4, 0}, {0, 0, 4}, 3, 3);
  inwards.patch({half, -2, -2}, {0, 0, 4}, {0, 4, 0}, 3, 3);
  for (const TriangleMesh& mesh : {sheet.mesh(), inwards.mesh()}) {
    Surfaces surfaces(mesh);
    for (int again = 0; again < 3; ++again) {  // with no memory, then with the memory of both
      const auto contacts = surfaces.touch({0.001, 0.1, 0.03}, radius);
      ASSERT_EQ(contacts.size(), 2u);
      for (const MeshContact& c : contacts)
        EXPECT_NEAR(c.overlap, radius - half + (c.normal.x() > 0 ? -0.001 : 0.001), 1e-12);
    }
  }
}

TEST(Channel, SecondWallIsTouchedFromTheSideTheSphereIsOn) {
  const double radius = 0.5,
               half = 0.49;  // touches the left wall first, and still when it meets the right one
  MeshMaker sheet;
  sheet.patch({-half, -2, -2}, {0, 4, 0}, {0, 0, 4}, 3, 3);
  sheet.patch({half, -2, -2}, {0, 4, 0}, {0, 0, 4}, 3, 3);
  Surfaces surfaces(sheet.mesh());
  for (double x = -0.04; x <= 0.04; x += 0.001) {
    for (const MeshContact& c : surfaces.touch({x, 0.1, 0.03}, radius)) {
      const double gap = c.normal.x() > 0 ? half + x : half - x;
      ASSERT_NEAR(c.overlap, radius - gap, 1e-12) << x;
    }
  }
}

}  // namespace
}  // namespace scree::verification
