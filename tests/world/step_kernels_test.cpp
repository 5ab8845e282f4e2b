// The vectorised loops against the law written out: all pairs, one by one, in double precision.
#include "sim/world/step_kernels.h"

#include <gtest/gtest.h>

#include <numbers>
#include <numeric>
#include <utility>

#include "tests/world/random_spheres.h"

namespace scree {
namespace {

Vec3 any_vector(Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

// What contact_forces() works on, for spheres that are all awake.
struct Scene {
  Spheres spheres;
  PairList pairs;
  Sleep sleep{false, 0.1};
  ContactLaw law;
  std::vector<FrictionFactors> friction;
  std::vector<ForceSum> sums;
  std::vector<BlockWork> blocks;

  Scene(int count, int fixed, const Material& material, const ContactEffects& effects = {})
      : spheres(random_spheres(count, fixed, 21)), law(material, effects), sums(count) {
    if (!effects.none())
      for (int i = 0; i < count; ++i)
        friction.push_back(friction_factors(effects, 2 * spheres.place[i].w, i >= spheres.movable));
    Random random(22, 0, RandomPurpose::positions);
    for (int i = 0; i < spheres.movable; ++i) {
      spheres.velocity[i].set(any_vector(random));
      spheres.spin[i].set(any_vector(random));
      spheres.spin[i].w = 0.4 * spheres.velocity[i].w * spheres.place[i].w * spheres.place[i].w;
    }
    list();
  }
  void list() {
    std::vector<int> order(static_cast<std::size_t>(spheres.size()));
    std::iota(order.begin(), order.end(), 0);
    pairs.rebuild(spheres, order, 0.05);
    sleep.renumber(order, spheres, pairs, std::vector<std::uint8_t>(order.size(), 0), 0.0, 9.81);
    split_into_blocks(sleep.awake(), blocks);
  }
  // One step's forces; as one thread does it, or as several do.
  void forces(double dt, bool write_down) {
    const StepView view{spheres, pairs,       sleep,     law, friction.empty() ? nullptr : friction.data(),
                        dt,      sums.data(), write_down};
    for (auto work = blocks.rbegin(); work != blocks.rend(); ++work) {
      work->inbox.clear();
      contact_forces(view, *work);
    }
    for (auto from = blocks.rbegin(); from != blocks.rend(); ++from)
      for (const FarForces& far : from->written_down())
        blocks[static_cast<std::size_t>(far.block)].inbox.push_back(&far);
  }
};

// The formulae of rrlinear.h for one contact with memory, as written in their source.
struct Reference {
  Vec3 shear = Vec3::Zero(), rolling = Vec3::Zero();
  double twisting = 0;
  bool closed = false;
};

// Share of a step in which a contact pulls that had the overlap `was` one way before: the way and half a step
// more if it closes, the rest of the way beyond half a step, which it had already, if it opens.
double share_of_pull(double was, double is) {
  if (is <= 0) return was <= 0 ? 0 : was / (was - is) - 0.5;
  return was > 0 ? 1 : is / (is - was) + 0.5;
}

struct Additions {
  double normal_dashpot = 0, shear_dashpot = 0;
  ContactEffects effects = {};
};
class StepKernelsWithAdditions : public testing::TestWithParam<Additions> {};

TEST_P(StepKernelsWithAdditions, ForcesAreThoseOfTheLawPairByPair) {
  Material material;
  material.mu = 0.3;
  material.mu_r = 0.2;
  material.normal_damping_ratio = GetParam().normal_dashpot;
  material.shear_damping_ratio = GetParam().shear_dashpot;
  const ContactEffects& effects = GetParam().effects;
  const double dt = 0.05;
  Scene scene(700, 60, material, effects);
  const Spheres& s = scene.spheres;
  std::vector<std::vector<Reference>> memory(700, std::vector<Reference>(700));
  for (int step = 0; step < 3; ++step) {
    scene.forces(dt, false);
    std::vector<Vec3> force(700, Vec3::Zero()), torque(700, Vec3::Zero());
    std::vector<double> forces(700, 0), torques(700, 0);  // sums of sizes, over the contacts of a sphere
    int contacts = 0, sliding = 0, opened = 0;
    for (int i = 0; i < s.movable; ++i)
      for (int j = i + 1; j < s.size(); ++j) {
        const double r1 = s.place[i].w, r2 = s.place[j].w;
        const Vec3 d = s.place[j].vec() - s.place[i].vec();
        const double u = r1 + r2 - d.norm();
        Reference& m = memory[i][j];
        if (u <= 0 && !m.closed) continue;
        const Vec3 n = d / d.norm();
        const double r = std::min(r1, r2), kn = M_PI * r * r * material.effective_modulus / (r1 + r2);
        const double ks = kn / material.stiffness_ratio, rbar = r1 * r2 / (r1 + r2), kr = ks * rbar * rbar;
        const double a1 = r1 - 0.5 * u, a2 = r2 - 0.5 * u;
        const Vec3 w1 = s.spin[i].vec(), w2 = s.spin[j].vec();
        const Vec3 v = s.velocity[j].vec() - w2.cross(a2 * n) - s.velocity[i].vec() - w1.cross(a1 * n);
        const double pull = 2 * M_PI * effects.surface_energy * rbar * share_of_pull(u + dt * n.dot(v), u);
        m.closed = u > 0;
        if (!m.closed) {
          m = {};
          force[i] += pull * n, force[j] -= pull * n;
          for (const auto& [sphere, arm] : {std::pair(i, a1), std::pair(j, a2)})
            forces[sphere] += std::abs(pull), torques[sphere] += std::abs(arm * pull);
          ++opened;
          continue;
        }
        ++contacts;
        const double twist = std::atan(0.5 * (w1 + w2).dot(n) * dt);
        const auto turned = [&](const Vec3& old) -> Vec3 {
          Vec3 flat = old - n * n.dot(old);
          if (old.norm() == 0) return Vec3::Zero();
          flat *= old.norm() / flat.norm();
          return std::cos(twist) * flat + std::sin(twist) * n.cross(flat);
        };
        const Vec3 slip = v - n * n.dot(v);
        const double m1 = s.velocity[i].w, m2 = s.velocity[j].w,
                     mass = j < s.movable ? m1 * m2 / (m1 + m2) : m1;
        const double fn =
            std::max(kn * u - 2 * material.normal_damping_ratio * std::sqrt(mass * kn) * n.dot(v), 0.0);
        m.shear = turned(m.shear) + ks * dt * slip;
        double mu =
            material.mu * (1 - effects.weakening * slip.norm() / (slip.norm() + effects.weakening_speed));
        double mu_r = material.mu_r;
        if (j < s.movable) {
          const double size = std::sqrt(4 * r1 * r2) / effects.reference_diameter;
          mu *= std::pow(size, effects.mu_exponent), mu_r *= std::pow(size, effects.mu_r_exponent);
        } else {
          const double size = std::sqrt(2 * r1 / effects.reference_diameter);
          mu *= std::pow(size, effects.mu_exponent) * effects.fixed_mu;
          mu_r *= std::pow(size, effects.mu_r_exponent) * effects.fixed_mu_r;
        }
        const bool slides = m.shear.norm() > mu * fn;
        if (slides) {
          m.shear *= mu * fn / m.shear.norm();
          ++sliding;
        }
        const Vec3 bend = w2 - w1 - n * n.dot(w2 - w1);
        m.rolling = turned(m.rolling) + kr * dt * bend;
        const double most = mu_r * rbar * fn;
        if (m.rolling.norm() > most) m.rolling *= most / m.rolling.norm();
        const double most_twist = effects.mu_t * rbar * fn;
        m.twisting = std::clamp(m.twisting + kr * dt * n.dot(w2 - w1), -most_twist, most_twist);
        Vec3 f = m.shear - n * (fn - pull);
        if (!slides) f += 2 * material.shear_damping_ratio * std::sqrt(mass * ks) * slip;
        force[i] += f, force[j] -= f;
        for (const auto& [sphere, arm] : {std::pair(i, a1), std::pair(j, a2)}) {
          forces[sphere] += f.norm() + kn * u;
          torques[sphere] += std::abs(arm) * (f.norm() + kn * u) + m.rolling.norm() + std::abs(m.twisting);
        }
        const Vec3 moment = m.rolling + m.twisting * n;
        torque[i] += a1 * n.cross(f) + moment, torque[j] += a2 * n.cross(f) - moment;
      }
    ASSERT_GT(contacts, 500);
    ASSERT_GT(sliding, 10);
    ASSERT_LT(sliding, contacts - 10);
    if (step > 0) {
      ASSERT_GT(opened, 0);
    }
    for (int i = 0; i < s.movable; ++i) {
      // What is remembered, and motion in the contact plane, are in single precision: some 2^-24 a step.
      EXPECT_LE((scene.sums[i].force.vec() - force[i]).norm(), 1e-6 * forces[i]) << i;
      EXPECT_LE((scene.sums[i].torque.vec() - torque[i]).norm(), 1e-6 * torques[i]) << i;
    }
    for (int i = 0; i < scene.spheres.movable; ++i)
      scene.spheres.place[i].add(0.15 * dt * scene.spheres.velocity[i].vec());
  }
}

INSTANTIATE_TEST_SUITE_P(
    WithAndWithout, StepKernelsWithAdditions,
    testing::Values(Additions{0, 0}, Additions{0.4, 0}, Additions{0, 0.3}, Additions{0.2, 0.5},
                    Additions{.effects = {.surface_energy = 5e4}}, Additions{.effects = {.mu_t = 0.1}},
                    Additions{.effects = {.weakening = 0.6, .weakening_speed = 0.5}},
                    Additions{
                        .effects = {.mu_exponent = 0.5, .mu_r_exponent = -0.4, .reference_diameter = 0.8}},
                    Additions{.effects = {.fixed_mu = 0.5, .fixed_mu_r = 2}},
                    Additions{0.2, 0.5, {1e4, 0.2, 0.3, 1, 0.2, 0.3, 0.7, 1.5, 0.8}}));

// A contact that opens and closes again, listed all the while, begins anew: its shear is ks times the slip of
// one step. With cohesion a contact still bears shear at the moment when it opens.
class StepKernelsWithCohesion : public testing::TestWithParam<double> {};

TEST_P(StepKernelsWithCohesion, ContactThatOpensForgetsItsShear) {
  Material material;
  material.mu = 1;
  ContactEffects effects;
  effects.surface_energy = GetParam();  // J/m2
  Scene scene(2, 0, material, effects);
  Spheres& s = scene.spheres;
  const double speed = 0.01, dt = 0.01;
  s.place[0] = {0, 0, 0, 1}, s.place[1] = {1.9, 0, 0, 1};
  s.velocity[0].set(Vec3::Zero()), s.velocity[1].set({0, speed, 0});
  s.spin[0].set(Vec3::Zero()), s.spin[1].set(Vec3::Zero());
  scene.list();
  const double one_step = ball_ball(scene.law, 1.0, 1.0).ks * speed * dt;
  for (const int steps : {1, 2}) {
    scene.forces(dt, false);
    EXPECT_NEAR(scene.sums[0].force.y, steps * one_step, 1e-6 * one_step);
  }
  s.place[1].x = 2.05;
  scene.forces(dt, false);
  EXPECT_EQ(scene.sums[0].force.vec(), Vec3::Zero());
  s.place[1].x = 1.9;
  scene.forces(dt, false);
  EXPECT_NEAR(scene.sums[0].force.y, one_step, 1e-6 * one_step);
}
INSTANTIATE_TEST_SUITE_P(Bonds, StepKernelsWithCohesion, testing::Values(0.0, 1e4));

// A block that touches hundreds of small spheres: its row, and the pairs that close in one step, are longer
// than what is taken at a time. Their springs push it up with sum kn u.
TEST(StepKernels, LongRowsAreTakenWhole) {
  Spheres s;
  const int small = 400;
  const double big_radius = 1.0, radius = 0.02, overlap = 0.001;
  const auto add = [&](const Vec3& at, double r) {
    const double mass = 2700 * 4.0 / 3 * std::numbers::pi * r * r * r;
    s.place.push_back({at.x(), at.y(), at.z(), r});
    s.velocity.push_back({0, 0, 0, mass});
    s.spin.push_back({0, 0, 0, 0.4 * mass * r * r});
    s.id.push_back(s.size() - 1), s.dump.push_back(1), s.lost.push_back(0), s.asleep.push_back(0);
  };
  add(Vec3::Zero(), big_radius);
  Vec3 expected = Vec3::Zero();
  const ContactLaw law{Material{}};
  const double kn = ball_ball(law, big_radius, radius).kn;
  for (int k = 0; k < small; ++k) {  // on the lower half, far from each other: a spiral
    const double z = -0.1 - 0.85 * k / small, turn = 2.399963 * k;
    const Vec3 n(std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z);
    add((big_radius + radius - overlap) * n, radius);
    expected -= kn * overlap * n;
  }
  s.movable = s.size();
  std::vector<int> order(s.size());
  std::iota(order.begin(), order.end(), 0);
  PairList pairs;
  pairs.rebuild(s, order, 0.0);
  Sleep sleep{false, 0.1};
  sleep.renumber(order, s, pairs, std::vector<std::uint8_t>(s.size(), 0), 0.0, 9.81);
  std::vector<BlockWork> blocks;
  split_into_blocks(sleep.awake(), blocks);
  std::vector<ForceSum> sums(s.size());
  for (int step = 0; step < 2; ++step) {
    contact_forces({s, pairs, sleep, law, nullptr, 1e-4, sums.data(), false}, blocks[0]);
    EXPECT_EQ(sums[0].force.w, small);
    EXPECT_LT((sums[0].force.vec() - expected).norm(), 1e-9 * small * kn * overlap);
    for (int k = 1; k <= small; ++k) EXPECT_EQ(sums[k].force.w, 1);
  }
}

// One thread adds far forces as it goes, several write them down; the sums are the same to the last bit.
TEST(StepKernels, WrittenDownForcesAddUpToTheSameBits) {
  Scene one(1800, 100, Material{}), many(1800, 100, Material{});
  ASSERT_GT(one.blocks.size(), 2u);
  for (int step = 0; step < 3; ++step) {
    one.forces(1e-4, false);
    many.forces(1e-4, true);
    for (Scene* scene : {&one, &many}) {
      const LeapfrogView view{scene->spheres, scene->pairs, scene->sums.data(), Vec3(0, 0, -9.81), 0.4,
                              true,           1e-4};
      for (BlockWork& work : scene->blocks) leapfrog(view, work);
    }
    for (int i = 0; i < one.spheres.movable; ++i) {
      ASSERT_EQ(one.sums[i].force.vec(), many.sums[i].force.vec());
      ASSERT_EQ(one.sums[i].torque.vec(), many.sums[i].torque.vec());
      ASSERT_EQ(one.spheres.place[i].vec(), many.spheres.place[i].vec());
    }
  }
}

}  // namespace
}  // namespace scree
