// Collisions of spheres with each other and with a wall, and what they keep.
#include <filesystem>

#include "scree_version.h"
#include "sim/material/csv_table.h"
#include "tests/verification/scene.h"

namespace scree::verification {
namespace {

// Leapfrog on a linear spring keeps H = m v^2 / 2 + k x_n x_(n+1) / 2 (w^2 = k / m). A contact found within a
// step has x_n < 0 < x_(n+1)
// <= v dt, so H differs from m v^2 / 2 by at most k (v dt)^2 / 8, at the beginning as at the end:
// the speed of rebound is exact but for the share (w dt)^2 / 8.
double speed_error(double w, double dt) {
  return w * w * dt * dt / 8;
}

// Thesis, appendix D: two equal balls at +-1 m/s leave at -+1 m/s.
// Contact time pi sqrt(m_eff / kn), largest overlap v_rel sqrt(m_eff / kn).
TEST(HeadOnCollision, EqualBallsExchangeTheirVelocities) {
  const double dt = 1e-4, radius = 1.0;
  RrlinearWorld world(weightless(dt));
  const Material& m = world.settings().material;
  world.add_spheres({ball({-1.01, 0, 0}, radius, {1, 0, 0}), ball({1.01, 0, 0}, radius, {-1, 0, 0})});
  const double w = std::sqrt(pair_stiffness(m, radius, radius) / (0.5 * ball_mass(m, radius)));
  int touching = 0;
  while (world.time() < 0.3) {
    step(world);
    if ((place_of(world, 0) - place_of(world, 1)).norm() < 2 * radius) ++touching;
  }
  EXPECT_NEAR(velocity_of(world, 0).x(), -1, speed_error(w, dt));
  EXPECT_NEAR(velocity_of(world, 1).x(), 1, speed_error(w, dt));
  EXPECT_NEAR(touching * dt, kPi / w, 2 * dt);
  // Sampled at steps: the top of the sine is missed by at most (w dt)^2 / 8 as well.
  EXPECT_NEAR(world.statistics().largest_overlap_ratio * radius, 2.0 / w, 2.0 / w * 2 * speed_error(w, dt));
}

// Elastic: v1' = ((m1 - m2) v1 + 2 m2 v2) / (m1 + m2).
TEST(HeadOnCollision, UnequalBallsKeepMomentumAndEnergy) {
  const double dt = 2e-5, r1 = 0.1, r2 = 0.5;
  RrlinearWorld world(weightless(dt));
  const Material& m = world.settings().material;
  const double m1 = ball_mass(m, r1), m2 = ball_mass(m, r2), v1 = 1.0, v2 = -0.3;
  world.add_spheres({ball({-r1 - 1e-3, 0, 0}, r1, {v1, 0, 0}), ball({r2, 0, 0}, r2, {v2, 0, 0})});
  const double w = std::sqrt(pair_stiffness(m, r1, r2) * (m1 + m2) / (m1 * m2));
  world.advance_to(2 * kPi / w);
  const double u1 = velocity_of(world, 0).x(), u2 = velocity_of(world, 1).x();
  EXPECT_NEAR(m1 * u1 + m2 * u2, m1 * v1 + m2 * v2, 1e-12 * (m1 + m2));
  EXPECT_NEAR(u1, ((m1 - m2) * v1 + 2 * m2 * v2) / (m1 + m2), 2 * (v1 - v2) * speed_error(w, dt));
  const double before = 0.5 * (m1 * v1 * v1 + m2 * v2 * v2), after = 0.5 * (m1 * u1 * u1 + m2 * u2 * u2);
  EXPECT_NEAR(after, before, 2 * before * (m1 + m2) / m2 * speed_error(w, dt));
}

// Oblique impact on a wall, e = 1 (Chung & Ooi, Granular Matter 13, 2011, tests 4 and 5). When the contact
// slides throughout,
//   v_x' = v_x - mu (1 + e) v_z,   omega' = 5/2 mu (1 + e) v_z / r.
// It slides throughout, for a linear spring, when the slip s = v_x - 7/2 mu (v_z - v_n) never falls below mu
// k* v_n, v_n from v_z to -v_z: v_x >= max(k*, 7 - k*) mu v_z. The law's lever is r - u/2; weighted with the
// force, u is pi/4 of the largest overlap U, so the spin is smaller by the share pi U / (8 r).
struct Oblique {
  double vx, vz, spin;
};

Oblique oblique_impact(double vx, double mu, double dt) {
  const double radius = 0.1, vz = 1.0;
  WorldSettings settings = weightless(dt);
  RrlinearWorld world(settings);
  world.add_spheres({ball({0, 0, radius + 1e-4}, radius, {vx, 0, -vz})});
  add_floor(world, {mu, 0});
  world.advance_to(0.05);
  return {velocity_of(world, 0).x(), velocity_of(world, 0).z(), spin_of(world, 0).y()};
}

TEST(ObliqueImpact, GrossSlidingBranch) {
  const double radius = 0.1, vz = 1.0, mu = 0.3, dt = 1e-5, k_star = Material{}.stiffness_ratio;
  const Material m;
  const double w = std::sqrt(wall_stiffness(m, radius) / ball_mass(m, radius));
  const double limit = std::max(k_star, 7 - k_star) * mu * vz;
  for (const double vx : {1.02 * limit, 2 * limit, 5 * limit}) {
    const Oblique out = oblique_impact(vx, mu, dt);
    EXPECT_NEAR(out.vz, vz, speed_error(w, dt));
    // Friction is mu Fn in every step, so the balance with the rebound that came out holds to rounding. In
    // the very first step of the contact the spring may still hold: then one step's slip is missing, below mu
    // (w dt)^2.
    EXPECT_NEAR(out.vx, vx - mu * (vz + out.vz), mu * std::pow(w * dt, 2));
    const double lever = 1 - kPi * (vz / w) / (8 * radius);
    EXPECT_NEAR(out.spin, 2.5 * mu * (vz + out.vz) / radius * lever, 1e-4 * out.spin);
  }
}

TEST(ObliqueImpact, SticksBelowTheLimitOfGrossSliding) {
  const double mu = 0.3, k_star = Material{}.stiffness_ratio;
  const double vx = 0.9 * (7 - k_star) * mu;
  const Oblique out = oblique_impact(vx, mu, 1e-5);
  EXPECT_GT(out.vx, vx - 2 * mu + 1e-3);  // less than full friction was used
}

// Speed along a plate, after over before, as measured: where the sphere slides throughout, from 30 degrees
// on, that of the formula above. Where it sticks the shear stiffness decides: kn/ks is (2 - nu) / (2 (1 -
// nu)) = 1.15 for small slips of elastic spheres (Mindlin 1949, nu 0.23), and 2.5 in the thesis.
TEST(ObliqueImpact, LeavesTheSpeedThatIsMeasured) {
  constexpr double kSpeed = 3.9, kFriction = 0.092, kRestitution = 0.98, kRadius = 2.5e-3;
  WorldSettings settings = weightless(2e-8);
  settings.material.density = 4000;
  settings.material.effective_modulus = 1e9;
  settings.material.stiffness_ratio = 1.15;
  settings.material.normal_damping_ratio = 0.00646;  // restitution 0.98 (Schwager & Poeschel 2007, eq. 21)
  CsvTable measured(std::filesystem::path(SCREE_SOURCE_DIR) / "tests/verification/kharaz_2001.csv",
                    {"incidence_deg", "tangential_restitution"});
  int rows = 0;
  for (; measured.next(); ++rows) {
    const double degrees = measured.number("incidence_deg"), angle = degrees * kPi / 180;
    RrlinearWorld world(settings);
    world.add_spheres(
        {ball({0, 0, kRadius + 1e-6}, kRadius, {kSpeed * std::sin(angle), 0, -kSpeed * std::cos(angle)})});
    add_floor(world, {kFriction, 0}, 1);
    world.advance_to(1e-4);
    const double left = velocity_of(world, 0).x() / (kSpeed * std::sin(angle));
    EXPECT_NEAR(velocity_of(world, 0).z(), kRestitution * kSpeed * std::cos(angle), 0.002 * kSpeed);
    EXPECT_NEAR(left, measured.number("tangential_restitution"), degrees > 30 ? 0.01 : 0.1) << degrees;
    if (degrees > 30) {
      EXPECT_NEAR(left, 1 - kFriction * (1 + kRestitution) / std::tan(angle), 0.002) << degrees;
    }
  }
  EXPECT_EQ(rows, 8);
}

// Two equal spheres that meet head-on with equal spin (Chung & Ooi, test 7): contact points move apart at 2
// omega r. Impulse m v_rel, friction mu times it: v_t = mu v_rel, spin falls by 5/2 mu v_rel / r each.
TEST(ObliqueImpact, SpinningSpheresSlideOnEachOther) {
  const double radius = 0.1, speed = 0.2, mu = 0.4, dt = 5e-7;
  WorldSettings settings = weightless(dt);
  settings.material.mu = mu;
  settings.material.effective_modulus = 1e9;
  const Material& m = settings.material;
  const double w = std::sqrt(pair_stiffness(m, radius, radius) / (0.5 * ball_mass(m, radius)));
  const double v_rel = 2 * speed, limit = (7 - m.stiffness_ratio) * mu * v_rel;  // of the slip
  const double spin = 1.1 * limit / (2 * radius);
  RrlinearWorld world(settings);
  world.add_spheres({ball({-radius - 1e-6, 0, 0}, radius, {speed, 0, 0}, {0, 0, spin}),
                     ball({radius + 1e-6, 0, 0}, radius, {-speed, 0, 0}, {0, 0, spin})});
  world.advance_to(2 * kPi / w);
  const Vec3 v0 = velocity_of(world, 0), v1 = velocity_of(world, 1);
  // The closed form holds for a fixed normal. The line of centres turns, by 2 mu v_rel at the end over a
  // contact time pi / w.
  const double turned = 2 * mu * v_rel * (kPi / w) / (2 * radius);
  EXPECT_NEAR(v0.x(), -speed, v_rel * turned);
  EXPECT_NEAR(v0.y(), -mu * v_rel, v_rel * turned);  // its surface moves along +y: friction acts along -y
  EXPECT_NEAR(v0.y() + v1.y(), 0, 1e-12);
  const double lever = 1 - kPi * (v_rel / w) / (16 * radius);
  EXPECT_NEAR(spin_of(world, 0).z(), spin - 2.5 * mu * v_rel / radius * lever, 2.5 * v_rel / radius * turned);
  EXPECT_NEAR(spin_of(world, 0).z(), spin_of(world, 1).z(), 1e-12 * spin);
}

// A thousand spheres of ratio 1:4 run into each other, far from anything else.
std::vector<NewSphere> closing_cloud(double spread) {
  Random random(1, 0, RandomPurpose::positions);
  std::vector<NewSphere> cloud;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j)
      for (int k = 0; k < 10; ++k) {
        const Vec3 jitter(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const Vec3 at = Vec3(i - 4.5, j - 4.5, k - 4.5) * spread + 0.02 * jitter;
        const Vec3 wind(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        cloud.push_back(ball(at, random.uniform(0.05, 0.2), -0.8 * at + wind, 2 * wind));
      }
  return cloud;
}

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double linear_scale = 0, angular_scale = 0;
};

Momenta momenta(const RockWorld& world) {
  Momenta sum;
  const Spheres& s = world.spheres();
  for (int i = 0; i < s.size(); ++i) {
    const Vec3 p = s.velocity[i].w * s.velocity[i].vec();
    const Vec3 l = s.place[i].vec().cross(p) + s.spin[i].w * s.spin[i].vec();
    sum.linear += p;
    sum.angular += l;
    sum.linear_scale += p.norm();
    sum.angular_scale += l.norm();
  }
  return sum;
}

// Contact points of both spheres coincide (the levers add up to the distance of the centres) and leapfrog
// turns x x m v by exactly x x F dt, so angular momentum is kept to rounding as well.
TEST(ClosedSystem, MomentumAndAngularMomentumAreKept) {
  WorldSettings settings = weightless(1e-4);
  settings.material.mu = settings.material.mu_r = 0.4;
  RrlinearWorld world(settings);
  world.add_spheres(closing_cloud(0.42));
  const Momenta before = momenta(world);
  world.advance_to(0.15);
  const Momenta after = momenta(world);
  EXPECT_GT(world.statistics().largest_overlap_ratio, 0.01);  // they did meet
  EXPECT_LT((after.linear - before.linear).norm(), 1e-12 * before.linear_scale);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-12 * before.angular_scale);
}

// Energy as read pairs v(t - dt/2) with x(t). The leapfrog invariant of one spring differs from that reading
// by k x v dt / 2, at most w dt / 2 of the contact's energy; shear and rolling forces are read one step late,
// which is as much again. While spheres touch, total(t) <= total(0) (1 + 1.5 w dt); once apart, the reading
// is exact and only the (w dt)^2 / 4 of each entry and exit is left.
TEST(ClosedSystem, FrictionNeverMakesEnergy) {
  const double dt = 1e-4;
  WorldSettings settings = weightless(dt);
  settings.material.mu = settings.material.mu_r = 0.4;
  const Material& m = settings.material;
  const double w = std::sqrt(pair_stiffness(m, 0.05, 0.05) / (0.5 * ball_mass(m, 0.05)));
  const double w_turn =
      w * std::sqrt(2 * 3.5 / m.stiffness_ratio);  // shear and rolling springs on the inertia
  RrlinearWorld world(settings);
  world.add_spheres(closing_cloud(0.42));
  world.advance_to(0);
  const double start = world.energy().total();
  double lowest = start;
  for (int look = 1; look <= 30; ++look) {
    world.advance_to(0.01 * look);
    const Energy e = world.energy();
    EXPECT_LE(e.total(), start * (1 + 1e-4)) << world.time();
    EXPECT_LE(e.total(), lowest * (1 + 1e-4) + 1.5 * w_turn * dt * e.elastic) << world.time();
    lowest = std::min(lowest, e.total());
  }
  EXPECT_LT(lowest, 0.95 * start);  // friction took something
}

TEST(ClosedSystem, WithoutFrictionEnergyIsKept) {
  const double dt = 1e-4;
  RrlinearWorld world(weightless(dt));
  const Material& m = world.settings().material;
  const double w = std::sqrt(pair_stiffness(m, 0.05, 0.05) / (0.5 * ball_mass(m, 0.05)));
  std::vector<NewSphere> cloud = closing_cloud(0.42);
  for (NewSphere& s : cloud) s.velocity *= 2;
  world.add_spheres(cloud);
  world.advance_to(0);
  const double start = world.energy().total();
  world.advance_to(0.3);
  const Energy e = world.energy();
  // Entries and exits of either sign: (w dt)^2 / 4 of a contact's energy, a contact or two a sphere.
  EXPECT_NEAR(e.total(), start, start * (0.5 * w * w * dt * dt) + 0.5 * w * dt * e.elastic);
}

}  // namespace
}  // namespace scree::verification
