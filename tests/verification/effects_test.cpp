// Each effect on the contact law in a scene small enough for a formula.
#include "sim/effects/effect.h"
#include "tests/verification/scene.h"

namespace scree::verification {
namespace {

constexpr double kRadius = 0.05, kDt = 2e-5;
constexpr double kD50 = 2 * kRadius;

Modifications changes_of(const std::string& name, std::vector<double> values) {
  const EffectUse use{find_effect(name), std::move(values)};
  return modifications(std::span(&use, 1), {.d50 = kD50});
}

WorldSettings with_effect(WorldSettings settings, const std::string& name, std::vector<double> values) {
  const Modifications changes = changes_of(name, std::move(values));
  settings.contact_effects = changes.contact;
  settings.flight_damping = changes.flight_damping;
  settings.material.normal_damping_ratio += changes.normal_damping_ratio;
  settings.material.density_exponent = changes.density_exponent;
  settings.material.density_diameter = kD50;
  return settings;
}

// Gravity turned as on a plane of this slope, downhill along x.
Vec3 on_slope(double tangent) {
  const double angle = std::atan(tangent);
  return kGravity * Vec3(std::sin(angle), 0, -std::cos(angle));
}

// A pull of Bo m g against the weight m g: a sphere hangs under a fixed one of its size when Bo > 1, by an
// overlap of (Bo - 1) m g / kn, and falls when Bo < 1.
TEST(Cohesion, SphereHangsUnderAnother) {
  for (const double bond : {0.9, 1.1}) {
    WorldSettings settings = with_effect(undamped(kDt), "cohesion", {bond});
    settings.material.local_damping = 0.4;
    RrlinearWorld world(settings);
    const double weight = ball_mass(settings.material, kRadius) * kGravity;
    const double kn = pair_stiffness(settings.material, kRadius, kRadius);
    const double overlap = (bond - 1) * weight / kn;
    world.add_spheres(
        {fixed_ball({0, 0, 0}, kRadius), ball({0, 0, -2 * kRadius + std::max(overlap, 1e-7)}, kRadius)});
    world.advance_to(1.0);
    if (bond > 1)
      EXPECT_NEAR(place_of(world, 1).z(), -2 * kRadius + overlap, 1e-3 * overlap);
    else
      EXPECT_LT(place_of(world, 1).z(), -1);
  }
}

// The pull goes with Rbar = R1 R2 / (R1 + R2), the weight with R^3: of two spheres under large ones alike the
// smaller hangs. With R2 = 3 R1 and R1 = s D50 / 2, pull over weight is Bo (3/4) 2 / s^2.
TEST(Cohesion, HoldsTheSmallRatherThanTheLarge) {
  for (const double size : {0.8, 1.3}) {
    WorldSettings settings = with_effect(undamped(kDt), "cohesion", {0.8});
    settings.material.local_damping = 0.4;
    RrlinearWorld world(settings);
    const double r = size * kRadius;
    world.add_spheres({fixed_ball({0, 0, 0}, 3 * r), ball({0, 0, -4 * r + 1e-7}, r)});
    world.advance_to(0.5);
    const bool hangs = 0.8 * 1.5 / (size * size) > 1;
    EXPECT_EQ(place_of(world, 1).z() > -5 * r, hangs) << size;
  }
}

// A contact that is only pulled together, by P, can be sheared up to mu P: the spring presses with P.
TEST(Cohesion, GivesFrictionWithoutWeight) {
  WorldSettings settings = with_effect(weightless(kDt), "cohesion", {1.0});
  settings.material.mu = 0.5;
  settings.material.mu_r = 100;
  settings.material.local_damping = 0.4;
  const double pull = ball_mass(settings.material, kRadius) * kGravity;  // bond number 1
  for (const double share : {0.9, 1.1}) {
    RrlinearWorld world(settings);
    const double overlap = pull / pair_stiffness(settings.material, kRadius, kRadius);
    world.add_spheres({fixed_ball({0, 0, 0}, kRadius), ball({0, 0, -2 * kRadius + overlap}, kRadius)});
    world.advance_to(0.1);
    // Sideways gravity of this share of mu P: the sphere stays, or slips off.
    RrlinearWorld pulled([&] {
      WorldSettings s = settings;
      s.gravity = Vec3(share * 0.5 * pull / ball_mass(settings.material, kRadius), 0, 0);
      return s;
    }());
    pulled.add_spheres({fixed_ball({0, 0, 0}, kRadius), ball(place_of(world, 1), kRadius)});
    pulled.advance_to(0.3);
    EXPECT_EQ(place_of(pulled, 1).x() < 0.1 * kRadius, share < 1) << place_of(pulled, 1).x();
  }
}

// Restitution of a dashpot that never pulls (Schwager & Poeschel 2007, eq. 21, below critical damping):
// e = exp(-b / sqrt(1 - b^2) (pi - atan(2 b sqrt(1 - b^2) / (1 - 2 b^2)))) for b < 1 / sqrt(2).
TEST(Restitution, IsThatOfTheTensionFreeOscillator) {
  for (const double beta : {0.1, 0.3, 0.6}) {
    RrlinearWorld world(with_effect(weightless(kDt), "restitution", {beta}));
    add_floor(world, {0, 0});
    world.add_spheres({ball({0, 0, 1.01 * kRadius}, kRadius, {0, 0, -1})});
    world.advance_to(0.2);
    const double root = std::sqrt(1 - beta * beta);
    const double e = std::exp(-beta / root * (kPi - std::atan(2 * beta * root / (1 - 2 * beta * beta))));
    EXPECT_NEAR(velocity_of(world, 0).z(), e, 0.01 * e) << beta;
  }
}

// What a sphere of `size` D50 does from rest on a plane of this slope within a second, over its radius:
// springs are stiff, and without local damping, which by itself holds what is pushed by little.
double way_down(const std::string& effect, double exponent, double size, double tangent,
                const Surface& plane) {
  WorldSettings settings = with_effect(undamped(1e-5), effect, {exponent});
  settings.material.effective_modulus = 1e8;
  settings.gravity = on_slope(tangent);
  const double radius = size * kRadius;
  const double overlap =
      ball_mass(settings.material, radius) * kGravity / wall_stiffness(settings.material, radius);
  RrlinearWorld world(settings);
  add_floor(world, plane);
  world.add_spheres({ball({0, 0, radius - overlap}, radius)});
  world.advance_to(1.0);
  return place_of(world, 0).x() / radius;
}

// A sphere on a plane rolls when tan(slope) > mu_r (d / D50)^(b / 2): the plane counts as of D50. Above by a
// tenth it would make 5/14 g t^2 (1 - 1 / 1.1) sin(slope), some radii.
TEST(RollingBySize, SmallAndLargeRollAtDifferentSlopes) {
  const double mu_r = 0.3, b = 0.8;
  for (const double size : {0.5, 2.0}) {
    const double limit = mu_r * std::pow(size, 0.5 * b);
    EXPECT_LT(way_down("rolling_by_size", b, size, 0.9 * limit, {5, mu_r}), 0.02) << size;
    EXPECT_GT(way_down("rolling_by_size", b, size, 1.1 * limit, {5, mu_r}), 0.5) << size;
  }
}

// A sphere that cannot roll slides when tan(slope) > mu (d / D50)^(b / 2).
TEST(FrictionBySize, SmallAndLargeSlideAtDifferentSlopes) {
  const double mu = 0.4, b = -0.6;
  for (const double size : {0.5, 2.0}) {
    const double limit = mu * std::pow(size, 0.5 * b);
    EXPECT_LT(way_down("friction_by_size", b, size, 0.9 * limit, {mu, 100}), 0.02) << size;
    EXPECT_GT(way_down("friction_by_size", b, size, 1.1 * limit, {mu, 100}), 0.5) << size;
  }
}

// Between spheres the factor is (sqrt(d1 d2) / D50)^b.
TEST(FrictionBySize, FactorsOfAPairMultiply) {
  const ContactEffects effects = changes_of("friction_by_size", {0.7}).contact;
  const double d1 = 0.03, d2 = 0.4;
  const double both = friction_factors(effects, d1, false).mu * friction_factors(effects, d2, false).mu;
  EXPECT_NEAR(both, std::pow(std::sqrt(d1 * d2) / kD50, 0.7), 1e-6);
  EXPECT_EQ(friction_factors(effects, d1, false).mu_r, 1);
}

// A sphere that spins about the vertical on a plane is slowed by mu_t R m g; without the effect it spins on.
TEST(Twisting, SpinAboutTheNormalDecays) {
  const double mu_t = 0.2, time = 0.2, spin = 20;
  for (const bool twisting : {false, true}) {
    WorldSettings settings = undamped(kDt);
    if (twisting) settings = with_effect(settings, "twisting", {mu_t});
    RrlinearWorld world(settings);
    const double mass = ball_mass(settings.material, kRadius), inertia = 0.4 * mass * kRadius * kRadius;
    const double overlap = mass * kGravity / wall_stiffness(settings.material, kRadius);
    add_floor(world, {0.3, 0});
    world.add_spheres({ball({0, 0, kRadius - overlap}, kRadius, Vec3::Zero(), {0, 0, spin})});
    world.advance_to(time);
    const double lost = twisting ? mu_t * kRadius * mass * kGravity / inertia * time : 0;
    EXPECT_LT(lost, spin);
    EXPECT_NEAR(spin_of(world, 0).z(), spin - lost, 0.005 * spin);
  }
}

// The same between two spheres, which the vector kernel computes: two equal ones pressed together by their
// pull (bond number 1), spinning against each other about the line of their centres, are each slowed by mu_t
// Rbar P.
TEST(Twisting, SpheresStopEachOther) {
  const double mu_t = 0.4, time = 0.05, spin = 10;
  WorldSettings settings = with_effect(weightless(kDt), "cohesion", {1});
  settings.contact_effects.mu_t = mu_t;
  const double mass = ball_mass(settings.material, kRadius), inertia = 0.4 * mass * kRadius * kRadius;
  const double pull = mass * kGravity;
  const double overlap = pull / pair_stiffness(settings.material, kRadius, kRadius);
  RrlinearWorld world(settings);
  world.add_spheres({ball({0, 0, 0}, kRadius, Vec3::Zero(), {spin, 0, 0}),
                     ball({2 * kRadius - overlap, 0, 0}, kRadius, Vec3::Zero(), {-spin, 0, 0})});
  world.advance_to(time);
  const double lost = mu_t * 0.5 * kRadius * pull / inertia * time;
  EXPECT_GT(lost, 0.1 * spin);
  EXPECT_NEAR(spin_of(world, 0).x(), spin - lost, 0.01 * spin);
  EXPECT_NEAR(spin_of(world, 1).x(), -spin + lost, 0.01 * spin);
}

// A sphere that slides without rolling (mu_r is high) is slowed by g mu (1 - w v / (v + vc)).
TEST(Weakening, SlidingSphereIsSlowedLess) {
  const double mu = 0.5, w = 0.6, vc = 0.4, start = 3, time = 0.3;
  WorldSettings settings = with_effect(undamped(kDt), "weakening", {w, vc});
  RrlinearWorld world(settings);
  const double overlap =
      ball_mass(settings.material, kRadius) * kGravity / wall_stiffness(settings.material, kRadius);
  add_floor(world, {mu, 1000});
  world.add_spheres({ball({0, 0, kRadius - overlap}, kRadius, {start, 0, 0})});
  world.advance_to(time);
  double v = start;
  for (double t = 0; t < time; t += 1e-5) v -= 1e-5 * kGravity * mu * (1 - w * v / (v + vc));
  EXPECT_NEAR(velocity_of(world, 0).x(), v, 0.02 * (start - v));
}

// Local damping in flight keeps 1 - share of alpha.
TEST(UndampedFlight, FallsFaster) {
  for (const double share : {0.0, 0.5, 1.0}) {
    WorldSettings settings = with_effect(undamped(1e-4), "undamped_flight", {share});
    settings.material.local_damping = 0.4;
    RrlinearWorld world(settings);
    world.add_spheres({ball({0, 0, 0}, kRadius, {0, 0, -1})});
    world.advance_to(0.5);
    EXPECT_NEAR(velocity_of(world, 0).z(), -1 - (1 - 0.4 * (1 - share)) * kGravity * 0.5, 1e-9);
  }
}

TEST(DensityBySize, MassGrowsWithSizeToThreeAndMore) {
  RrlinearWorld world(with_effect(undamped(kDt), "density_by_size", {0.2}));
  world.add_spheres({ball({0, 0, 0}, kRadius), ball({1, 0, 0}, 2 * kRadius)});
  const Snapshot now = world.snapshot();
  EXPECT_NEAR(now.grains[0].mass, ball_mass(world.settings().material, kRadius), 1e-12);
  EXPECT_NEAR(now.grains[1].mass / now.grains[0].mass, std::pow(2, 3.2), 1e-9);
}

// Balls of a base layer are ground, the rock itself is not.
TEST(GroundFriction, ActsOnFixedBalls) {
  const ContactEffects effects = changes_of("ground_friction", {0.5}).contact;
  EXPECT_EQ(friction_factors(effects, kD50, true).mu, 0.5f);
  EXPECT_EQ(friction_factors(effects, kD50, true).mu_r, 0.5f);
  EXPECT_EQ(friction_factors(effects, kD50, false).mu, 1);
}

// A tool with a pull of Bo m g holds a grain of D50 from above when Bo > 1.
TEST(StickyTools, ToolHoldsAGrainFromAbove) {
  for (const double bond : {0.9, 1.1}) {
    WorldSettings settings = undamped(kDt);
    settings.material.local_damping = 0.4;
    RrlinearWorld world(settings);
    Surface tool;
    tool.surface_energy = changes_of("sticky_tools", {bond}).tool_surface_energy;
    world.add_mesh(make_box({-1, -1, 0}, {1, 1, 0.5}), tool, Motion::fixed(Pose{}));
    world.add_spheres({ball({0, 0, -kRadius + 1e-6}, kRadius)});
    world.advance_to(0.5);
    EXPECT_EQ(place_of(world, 0).z() > -2 * kRadius, bond > 1) << bond;
  }
}

}  // namespace
}  // namespace scree::verification
