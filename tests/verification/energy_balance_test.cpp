// The account of energy (world/energy_balance.h): each term against its formula, and the sum against nothing.
#include <cstring>
#include <numbers>

#include "tests/verification/scene.h"

namespace scree::verification {
namespace {

constexpr double kRadius = 0.1, kDt = 2e-5;

EnergyBalance balance_of(const RockWorld& world) {
  return world.energy_balance().value();
}

// A ball at its overlap of rest on the level floor.
NewSphere on_floor(const Material& m, const Vec3& velocity, const Vec3& spin = Vec3::Zero()) {
  const double overlap = ball_mass(m, kRadius) * kGravity / wall_stiffness(m, kRadius);
  return ball({0, 0, kRadius - overlap}, kRadius, velocity, spin);
}

// With mu_r = mu a ball cannot roll and slides like a block: m v^2 / 2 goes into sliding friction over
// v^2 / (2 mu g), which is mu m g times the way.
TEST(EnergyBalance, SlidingTakesWhatABlockHad) {
  const double mu = 0.3, speed = 2;
  WorldSettings settings = undamped(kDt);
  settings.material.local_damping = 0.05;  // to end the swing on the springs; it takes its own small share
  settings.material.damping_reach = DampingReach::contacts;
  RrlinearWorld world(settings);
  add_floor(world, {mu, 1.0});
  world.add_spheres({on_floor(settings.material, {speed, 0, 0})});
  world.advance_to(1.0);
  const double mass = ball_mass(settings.material, kRadius), way = place_of(world, 0).x();
  const EnergyBalance b = balance_of(world);
  EXPECT_NEAR(b.account.came_moving, 0.5 * mass * speed * speed, 1e-9);
  EXPECT_NEAR(b.account.losses.sliding, mu * mass * kGravity * way, 0.01 * b.account.came_moving);
  EXPECT_NEAR(b.account.losses.sliding + b.account.losses.local_damping, b.account.came_moving,
              1e-3 * b.account.came_moving);
  EXPECT_LT(std::abs(b.relative_error()), 1e-3);
}

// Slip to rolling: from u0 without spin to 5/7 u0. What is lost is m u0^2 / 7, all of it by sliding.
TEST(EnergyBalance, SlipToRolling) {
  const double speed = 1;
  const WorldSettings settings = undamped(kDt);
  RrlinearWorld world(settings);
  add_floor(world, {0.3, 0.0});
  world.add_spheres({on_floor(settings.material, {speed, 0, 0})});
  world.advance_to(0.5);
  const EnergyBalance b = balance_of(world);
  const double lost = ball_mass(settings.material, kRadius) * speed * speed / 7;
  EXPECT_NEAR(b.account.losses.sliding, lost, 2e-3 * lost);
  EXPECT_EQ(b.account.losses.rolling, 0);
  EXPECT_LT(std::abs(b.relative_error()), 1e-3);
}

// A ball that rolls without slip has 7/10 m u^2; rolling friction takes all of it but what the rolling spring
// keeps swinging, (mu_r R m g)^2 / 2 kr.
TEST(EnergyBalance, RollingFrictionTakesWhatRolled) {
  const double speed = 0.5, mu_r = 0.1;
  const WorldSettings settings = undamped(kDt);
  RrlinearWorld world(settings);
  add_floor(world, {1.0, mu_r});
  world.add_spheres({on_floor(settings.material, {speed, 0, 0}, {0, speed / kRadius, 0})});
  world.advance_to(1.0);
  const EnergyBalance b = balance_of(world);
  const Material& m = settings.material;
  const double mass = ball_mass(m, kRadius), had = 0.7 * mass * speed * speed;
  const double kr = wall_stiffness(m, kRadius) / m.stiffness_ratio * kRadius * kRadius;
  const double swings = std::pow(mu_r * kRadius * mass * kGravity, 2) / (2 * kr);
  EXPECT_NEAR(b.account.losses.rolling, had, 2 * swings + 2e-3 * had);
  EXPECT_LT(b.account.losses.sliding, 1e-2 * had);
  EXPECT_LT(std::abs(b.relative_error()), 1e-3);
}

// A belt of speed V under a ball at rest brings it to 2/7 V and, backwards, to a spin of 5/7 V / r: the belt
// works m V^2 2/7, of which m V^2 / 7 goes into sliding.
TEST(EnergyBalance, BeltWorks) {
  const double speed = 1;
  const WorldSettings settings = undamped(kDt);
  RrlinearWorld world(settings);
  Pose end;
  end.position = {10 * speed, 0, 0};
  world.add_mesh(make_box({-20, -5, -1}, {20, 5, 0}), Surface{0.3, 0.0},
                 Motion({{0.0, Pose{}}, {10.0, end}}));
  world.add_spheres({on_floor(settings.material, Vec3::Zero())});
  world.advance_to(0.5);
  const EnergyBalance b = balance_of(world);
  // The ball swings on its shear spring in the end, so its speed is 2/7 V to mu g sqrt(2 m / 7 ks) only; the
  // work is V times the momentum it got, whatever that is.
  const double mass = ball_mass(settings.material, kRadius), unit = mass * speed * speed / 7;
  EXPECT_NEAR(b.account.tools, speed * mass * velocity_of(world, 0).x(), 2e-3 * unit);
  EXPECT_NEAR(b.account.tools, 2 * unit, 0.05 * 2 * unit);
  EXPECT_NEAR(b.account.losses.sliding, unit, 0.01 * unit);
  EXPECT_LT(std::abs(b.relative_error()), 2e-3);
}

// Local damping takes alpha of every force's work: from h to rest at the top of the rebound m g (h - h'),
// h' = ((1 - alpha) / (1 + alpha))^2 h, all of it by local damping.
TEST(EnergyBalance, LocalDampingOfADrop) {
  const double height = 0.5, alpha = 0.3;
  WorldSettings settings = undamped(kDt);
  settings.material.local_damping = alpha;
  RrlinearWorld world(settings);
  add_floor(world, {0.0, 0.0});
  world.add_spheres({ball({0, 0, kRadius + height}, kRadius)});
  const double fall = std::sqrt(2 * height / ((1 - alpha) * kGravity));
  world.advance_to(0.9 * fall);
  EXPECT_NEAR(balance_of(world).account.losses.local_damping, alpha * balance_of(world).fall(),
              1e-4 * balance_of(world).fall());
  do world.advance_to(world.time() + 1e-4);
  while (velocity_of(world, 0).z() <= 0);
  do world.advance_to(world.time() + 1e-4);
  while (velocity_of(world, 0).z() > 0);
  const EnergyBalance b = balance_of(world);
  const double weight = ball_mass(settings.material, kRadius) * kGravity;
  const double rebound = std::pow((1 - alpha) / (1 + alpha), 2) * height;
  EXPECT_NEAR(b.account.losses.local_damping, weight * (height - rebound), 0.02 * weight * height);
  EXPECT_NEAR(b.account.losses.local_damping, b.fall(), 1e-3 * b.fall());
  EXPECT_LT(std::abs(b.relative_error()), 1e-3);
}

// An impact on a dashpot: what the velocities lost.
TEST(EnergyBalance, DashpotOfAnImpact) {
  const double speed = 1;
  WorldSettings settings = weightless(kDt);
  settings.material.normal_damping_ratio = 0.2;
  RrlinearWorld world(settings);
  world.add_spheres({fixed_ball({0, 0, 0}, kRadius), ball({0, 0, 2.001 * kRadius}, kRadius, {0, 0, -speed})});
  world.advance_to(0.2);
  const double mass = ball_mass(settings.material, kRadius), out = velocity_of(world, 1).z();
  const double lost = 0.5 * mass * (speed * speed - out * out);
  ASSERT_GT(lost, 0.3 * mass * speed * speed);
  EXPECT_NEAR(balance_of(world).account.losses.dashpots, lost, 2e-3 * lost);
}

// A ball that spins about the normal ends when twisting friction has taken I w^2 / 2.
TEST(EnergyBalance, TwistingTakesASpin) {
  const double spin = 20;
  WorldSettings settings = undamped(kDt);
  settings.contact_effects.mu_t = 0.2;
  RrlinearWorld world(settings);
  add_floor(world, {0.3, 0.1});
  world.add_spheres({on_floor(settings.material, Vec3::Zero(), {0, 0, spin})});
  world.advance_to(1.0);
  const double had = 0.2 * ball_mass(settings.material, kRadius) * kRadius * kRadius * spin * spin;
  const EnergyBalance b = balance_of(world);
  EXPECT_NEAR(b.account.losses.twisting, had, 0.02 * had);
  EXPECT_LT(std::abs(b.relative_error()), 2e-3);
}

// A pull P = 2 pi gamma Rbar gives P u on the way in and takes it on the way out, wherever in a step the
// contact closes and opens: an impact without damping ends as fast as it began. What a step of the motion v
// dt is off by, P v dt / 2 at most, is a twentieth of the kinetic energy here.
TEST(EnergyBalance, PullOfAnImpactMakesNoEnergy) {
  const double speed = 1, dt = 4 * kDt;
  WorldSettings settings = weightless(dt);
  const double mass = ball_mass(settings.material, kRadius), kinetic = 0.5 * mass * speed * speed;
  for (const bool floor : {true, false}) {
    const double rbar = floor ? kRadius : 0.5 * kRadius;
    settings.contact_effects.surface_energy =
        0.05 * kinetic / (0.5 * speed * dt) / (2 * std::numbers::pi * rbar);
    for (int phase = 0; phase < 10; ++phase) {
      RrlinearWorld world(settings);
      const double apart = (5 + 0.1 * phase) * speed * dt;
      if (floor) {
        add_floor(world, {0.0, 0.0});
        world.add_spheres({ball({0, 0, kRadius + apart}, kRadius, {0, 0, -speed})});
      } else {
        world.add_spheres(
            {ball({0, 0, 2 * kRadius + apart}, kRadius, {0, 0, -speed}), fixed_ball({0, 0, 0}, kRadius)});
      }
      world.advance_to(0.2);
      const double out = velocity_of(world, 0).z();
      EXPECT_GT(out, 0);
      EXPECT_NEAR(0.5 * mass * out * out, kinetic, 0.004 * kinetic) << floor << ' ' << phase;
    }
  }
}

// Pull of a mesh on a ball that rolls over its rim, where faces hand the contact over, and on one that was
// put into it and is driven out: the account closes.
TEST(EnergyBalance, PullAtARimAndOutOfAWall) {
  WorldSettings settings = undamped(kDt);
  settings.material.local_damping = 0.2;
  const double weight = ball_mass(settings.material, kRadius) * kGravity;
  settings.contact_effects.surface_energy =
      0.5 * weight / (2 * std::numbers::pi * kRadius);  // half the weight
  for (const NewSphere& one :
       {ball({-0.2, 0, kRadius}, kRadius, {1, 0, 0}), ball({-1, 0, 0.3 * kRadius}, kRadius, {0, 0, 2})}) {
    RrlinearWorld world(settings);
    world.add_mesh(make_box({-5, -2, -2}, {0, 2, 0}), Surface{0.4, 0.1}, Motion());
    world.add_spheres({one});
    world.advance_to(0.6);
    EXPECT_LT(std::abs(balance_of(world).relative_error()), 2e-3) << one.position.x();
  }
}

// A sphere beyond the domain takes its energy along.
TEST(EnergyBalance, LostSphereTakesItsEnergyAlong) {
  WorldSettings settings = undamped(1e-3);
  settings.domain_low = Vec3(-10, -10, -5);
  RrlinearWorld world(settings);
  world.add_spheres({ball({0, 0, 0}, kRadius, {1, 0, 0}), ball({1, 0, 0}, kRadius)});
  world.advance_to(2);  // falls 19.6 m
  ASSERT_EQ(world.statistics().lost_particles, 2);
  const EnergyBalance b = balance_of(world);
  const double mass = ball_mass(settings.material, kRadius);
  EXPECT_NEAR(b.account.lost_other, 0.5 * mass + b.fall(), 0.01 * b.fall());
  EXPECT_GT(b.fall(), 2 * mass * kGravity * 5);
  EXPECT_EQ(b.held.total(), 0);
  EXPECT_LT(std::abs(b.relative_error()), 1e-2);  // half a step of the fall, O(dt)
}

// A velocity that is set, and spheres put upon each other: u^2 kn / 2 each.
TEST(EnergyBalance, WhatIsPutIn) {
  WorldSettings settings = weightless(kDt);
  RrlinearWorld world(settings);
  const double overlap = 0.02 * kRadius, kn = pair_stiffness(settings.material, kRadius, kRadius);
  world.add_spheres({ball({0, 0, 0}, kRadius), ball({2 * kRadius - overlap, 0, 0}, kRadius)});
  world.advance_to(0.1);
  const EnergyBalance apart = balance_of(world);
  EXPECT_NEAR(apart.account.pressed, 0.5 * kn * overlap * overlap, 1e-12);
  EXPECT_NEAR(apart.held.kinetic, apart.account.pressed, 1e-2 * apart.account.pressed);
  world.set_velocity(0, {3, 0, 0}, Vec3::Zero());
  const double mass = ball_mass(settings.material, kRadius);
  EXPECT_NEAR(balance_of(world).account.set_moving, 4.5 * mass - 0.5 * apart.held.kinetic,
              1e-9 + 1e-3 * apart.held.kinetic);
  EXPECT_NEAR(balance_of(world).error(), apart.error(), 1e-12);
}

// Rock that falls into a box as in a run: the step that the engine takes, corners of meshes, sleep.
void rain(RrlinearWorld& world, double time) {
  for (const auto& [low, high] :
       {std::pair(Vec3(-0.7, -0.6, -0.2), Vec3(0.7, 0.6, 0)),
        std::pair(Vec3(-0.7, -0.6, 0), Vec3(-0.5, 0.6, 3)), std::pair(Vec3(0.5, -0.6, 0), Vec3(0.7, 0.6, 3)),
        std::pair(Vec3(-0.5, -0.6, 0), Vec3(0.5, -0.4, 3)), std::pair(Vec3(-0.5, 0.4, 0), Vec3(0.5, 0.6, 3))})
    world.add_mesh(make_box(low, high), Surface{0.4, 0.2}, Motion());
  Random random(7, 0, RandomPurpose::positions);
  std::vector<NewSphere> rock;
  for (int layer = 0; layer < 5; ++layer)
    for (int k = 0; k < 20; ++k) {
      const double radius = 0.03 * std::pow(3.0, random.uniform() - 0.5);
      rock.push_back(ball({-0.4 + 0.2 * (k % 5) + 0.02 * random.uniform(),
                           -0.3 + 0.2 * (k / 5) + 0.02 * random.uniform(), 0.2 + 0.2 * layer},
                          radius));
    }
  world.add_spheres(rock);
  world.advance_to(time);
}

WorldSettings settings_of_a_run() {
  WorldSettings settings;
  settings.sleep = true;
  return settings;
}

TEST(EnergyBalance, ClosesWithEveryEffect) {
  struct Case {
    const char* name;
    void (*change)(WorldSettings&);
    double (*term)(const EnergyBalance&);  ///< what must not be nothing
  };
  const Case cases[] = {
      {"plain", [](WorldSettings&) {}, [](const EnergyBalance& b) { return b.account.put_to_sleep; }},
      {"without damping", [](WorldSettings& s) { s.material.local_damping = 0; },
       [](const EnergyBalance& b) { return b.account.losses.rolling; }},
      {"cohesion", [](WorldSettings& s) { s.contact_effects.surface_energy = 20; },
       [](const EnergyBalance& b) { return -b.held.pull; }},
      {"twisting", [](WorldSettings& s) { s.contact_effects.mu_t = 0.2; },
       [](const EnergyBalance& b) { return b.account.losses.twisting; }},
      {"weakening", [](WorldSettings& s) { s.contact_effects.weakening = 0.5; },
       [](const EnergyBalance& b) { return b.account.losses.sliding; }},
      {"dashpots",
       [](WorldSettings& s) { s.material.normal_damping_ratio = s.material.shear_damping_ratio = 0.2; },
       [](const EnergyBalance& b) { return b.account.losses.dashpots; }},
      {"dashpots at critical damping alone",
       [](WorldSettings& s) {
         s.material.normal_damping_ratio = s.material.shear_damping_ratio = 1;
         s.material.local_damping = 0;
       },
       [](const EnergyBalance& b) { return b.account.losses.dashpots; }},
      {"a shear dashpot of twice that",
       [](WorldSettings& s) {
         s.material.shear_damping_ratio = 2;
         s.material.local_damping = 0;
       },
       [](const EnergyBalance& b) { return b.account.losses.dashpots; }},
      {"vibration", [](WorldSettings& s) { s.vibration.amplitude = 0.5; },
       [](const EnergyBalance& b) { return b.account.shaking; }},
      {"breakage",
       [](WorldSettings& s) {
         s.breakage = {
             .fragility = 0.5, .exponent = 0.5, .reference_diameter = 0.06, .smallest_diameter = 0.02};
       },
       [](const EnergyBalance& b) { return -b.account.fragments; }},
  };
  for (const Case& one : cases) {
    WorldSettings settings = settings_of_a_run();
    one.change(settings);
    RrlinearWorld world(settings);
    rain(world, 1.5);
    const EnergyBalance b = balance_of(world);
    EXPECT_LT(std::abs(b.relative_error()), 0.01) << one.name;
    EXPECT_GT(one.term(b), 0) << one.name;
  }
}

TEST(EnergyBalance, DoesNotDependOnThreads) {
  EnergyAccount first;
  for (const int threads : {1, 2, 4}) {
    WorldSettings settings = settings_of_a_run();
    settings.threads = threads;
    RrlinearWorld world(settings);
    rain(world, 0.5);
    const EnergyAccount account = balance_of(world).account;
    if (threads == 1) first = account;
    EXPECT_EQ(std::memcmp(&first, &account, sizeof account), 0) << threads;
  }
}

// A ball that bounces without damping. At 0.1 of sqrt(m / k) the scheme keeps its energy to 1 %; at 1.3,
// where leapfrog is stable still (up to 2) and nothing blows up, it does not.
TEST(EnergyBalance, StaysOpenWhenTheStepIsTooLong) {
  for (const double ratio : {0.1, 1.3}) {
    WorldSettings settings = undamped(0);
    settings.fixed_time_step =
        ratio * std::sqrt(ball_mass(settings.material, kRadius) / wall_stiffness(settings.material, kRadius));
    RrlinearWorld world(settings);
    add_floor(world, {0.3, 0.1});
    world.add_spheres({ball({0, 0, 3 * kRadius}, kRadius)});
    // At the top of a bounce nothing has been put in: held against the whole fall.
    const double fall = ball_mass(settings.material, kRadius) * kGravity * 2 * kRadius;
    double largest = 0;
    for (int k = 1; k <= 20; ++k) {
      world.advance_to(0.1 * k);
      if (place_of(world, 0).z() > 1.01 * kRadius)
        largest = std::max(largest, std::abs(balance_of(world).error()) / fall);
    }
    if (ratio < 1)
      EXPECT_LT(largest, 0.01);
    else
      EXPECT_GT(largest, 0.01);
  }
}

}  // namespace
}  // namespace scree::verification
