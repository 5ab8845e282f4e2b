// The rrlinear law by itself: stiffnesses, limits, memory, damping.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "sim/contact/rrlinear.h"

namespace scree {
namespace {

constexpr double kPi = std::numbers::pi;

// Contact whose pieces do not move: all rates zero, n along z.
ContactMotion still(double overlap) {
  return {Vec3(0, 0, 1), overlap, Vec3::Zero(), Vec3::Zero(), 0.0, 1.0, 1e-3};
}

TEST(ContactLaw, Stiffnesses) {
  Material m;
  m.effective_modulus = 3e6;
  m.stiffness_ratio = 2.0;
  const ContactLaw law(m);
  const double r1 = 0.3, r2 = 0.8;
  const ContactStiffness b = ball_ball(law, r1, r2);
  EXPECT_NEAR(b.kn, kPi * r1 * r1 * 3e6 / (r1 + r2), 1e-9 * b.kn);  // kn = pi min(r)^2 E / (r1 + r2)
  EXPECT_NEAR(b.rbar, 1 / (1 / r1 + 1 / r2), 1e-12);
  EXPECT_NEAR(b.ks, b.kn / 2, 1e-9 * b.kn);
  EXPECT_NEAR(b.kr, b.ks * b.rbar * b.rbar, 1e-9 * b.kr);
  const ContactStiffness same = ball_ball(law, r2, r1);
  EXPECT_NEAR(same.kn, b.kn, 1e-12 * b.kn);
  EXPECT_NEAR(same.rbar, b.rbar, 1e-12 * b.rbar);
  const ContactStiffness f = ball_facet(law, r1);
  EXPECT_NEAR(f.kn, kPi * r1 * 3e6, 1e-9 * f.kn);  // kn = pi r^2 E / r
  EXPECT_EQ(f.rbar, r1);
  EXPECT_NEAR(f.kr, f.ks * r1 * r1, 1e-9 * f.kr);
}

TEST(ContactLaw, NormalForceIsLinearAndPushesPieceOneAway) {
  const ContactLaw law{Material{}};
  const ContactStiffness k = ball_facet(law, 0.5);
  ContactHistory history;
  const ContactForce f = contact_step(law, k, still(0.01), history);
  EXPECT_NEAR(f.force.z(), -k.kn * 0.01, 1e-12 * k.kn);
  EXPECT_EQ(f.rolling.norm(), 0);
}

TEST(ContactLaw, ShearIsLinearUpToFrictionAndDragsPieceOneAlong) {
  const ContactLaw law{Material{}};
  const ContactStiffness k = ball_facet(law, 0.5);
  ContactHistory history;
  ContactMotion c = still(0.01);
  c.velocity = {0.1, 0, 0.7};  // of piece 2; its normal part shears nothing
  contact_step(law, k, c, history);
  EXPECT_NEAR(history.shear.x(), k.ks * 0.1 * c.dt, 1e-9 * k.ks);
  ContactForce f;
  for (int n = 0; n < 1000; ++n) f = contact_step(law, k, c, history);
  EXPECT_NEAR(f.force.x(), law.mu * k.kn * 0.01, 1e-9 * k.kn);  // |Fs| = mu Fn
  EXPECT_NEAR(history.shear.norm(), law.mu * k.kn * 0.01, 1e-9 * k.kn);
}

TEST(ContactLaw, RollingIsLinearUpToItsLimitAndTwistIsFree) {
  const ContactLaw law{Material{}};
  const ContactStiffness k = ball_facet(law, 0.5);
  ContactHistory history;
  ContactMotion c = still(0.01);
  c.spin = {0, 0.2, 5.0};
  ContactForce f = contact_step(law, k, c, history);
  EXPECT_NEAR(f.rolling.y(), k.kr * 0.2 * c.dt, 1e-9 * k.kr);
  EXPECT_EQ(f.rolling.z(), 0);
  for (int n = 0; n < 1000; ++n) f = contact_step(law, k, c, history);
  EXPECT_NEAR(f.rolling.y(), law.mu_r * k.rbar * k.kn * 0.01, 1e-9 * k.kn);  // |Mr| = mu_r Rbar Fn
}

// A contact that turns about both axes takes its memory with it: a quarter turn in small steps keeps length
// and the angle to the path.
TEST(ContactLaw, MemoryTurnsWithTheContactPlane) {
  Vec3 v(2, 3, 0);
  const int steps = 1000;
  for (int n = 1; n <= steps; ++n) {
    const double a = 0.5 * kPi * n / steps;
    v = turned_with_contact(v, Vec3(std::sin(a), 0, std::cos(a)), 0);
  }
  EXPECT_NEAR((v - Vec3(0, 3, -2)).norm(), 0, 1e-2);  // turned about y with the normal, from z to x
  EXPECT_NEAR(v.norm(), std::sqrt(13.0), 1e-9);
  // Twist: a tenth of a turn, in steps of atan(angle) = angle - angle^3 / 3.
  Vec3 w(1, 0, 0);
  for (int n = 0; n < steps; ++n) w = turned_with_contact(w, Vec3(0, 0, 1), 0.2 * kPi / steps);
  EXPECT_NEAR(std::atan2(w.y(), w.x()), 0.2 * kPi, 1e-6);
  EXPECT_NEAR(w.norm(), 1, 1e-12);
}

// Single precision keeps the length, too, over 100,000 steps and however slowly the contact turns: half a
// unit in the last place a step is 6e-3 at the most, and goes either way, so that the mean of several
// memories does not drift.
SCREE_VECTORISED
void turn_many_times(std::array<float, 24>& memory, float tilt, float twist, int steps) {
  LaneVector<TwinFloats> v;
  __builtin_memcpy(&v, memory.data(), sizeof v);
  for (int n = 1; n <= steps; ++n) {
    const TwinFloats zero{};
    const double angle = static_cast<double>(tilt) * n;
    const LaneVector<TwinFloats> normal = {zero + static_cast<float>(std::sin(angle)), zero,
                                           zero + static_cast<float>(std::cos(angle))};
    v = turned_with_contact(v, normal, zero + twist);
  }
  __builtin_memcpy(memory.data(), &v, sizeof v);
}

TEST(ContactLaw, MemoryKeepsItsLengthInSinglePrecision) {
  for (const float tilt : {0.0f, 1e-6f, 5e-5f, 2e-4f, 3e-4f, 1e-3f, 1e-2f})
    for (const float twist : {0.0f, 1e-5f, 1e-4f, 2.4e-4f, 3e-4f, 1e-3f, 1e-2f}) {
      std::array<float, 24> memory{};  // x, y and z of eight vectors
      for (std::size_t k = 0; k < 8; ++k) {
        memory[k] = 0.3f * static_cast<float>(k) - 1;
        memory[8 + k] = 1.7f - 0.2f * static_cast<float>(k);
      }
      const std::array<float, 24> before = memory;
      turn_many_times(memory, tilt, twist, 100000);
      double drift = 0;
      for (std::size_t k = 0; k < 8; ++k) {
        const auto length = [&](const std::array<float, 24>& m) {
          return Vec3(m[k], m[8 + k], m[16 + k]).norm();
        };
        const double ratio = length(memory) / length(before);
        EXPECT_NEAR(ratio, 1, tilt == 0 && twist == 0 ? 1e-7 : 6e-3) << tilt << " " << twist;
        drift += (ratio - 1) / 8;
      }
      EXPECT_NEAR(drift, 0, 1e-3) << tilt << " " << twist;
    }
}

TEST(ContactLaw, ElasticEnergyIsTheWorkOfTheSprings) {
  const ContactLaw law{Material{}};
  const ContactStiffness k = ball_facet(law, 0.5);
  ContactHistory history;
  ContactMotion c = still(0.02);
  const double slip = 1e-3, bend = 2e-3;
  c.velocity = {slip / c.dt, 0, 0};
  c.spin = {0, bend / c.dt, 0};
  contact_step(law, k, c, history);
  const double work = 0.5 * (k.kn * 0.02 * 0.02 + k.ks * slip * slip + k.kr * bend * bend);
  EXPECT_NEAR(elastic_energy(k, 0.02, history), work, 1e-12 * work);
}

TEST(ContactLaw, DashpotDoesNotPull) {
  Material m;
  m.normal_damping_ratio = 0.5;
  const ContactLaw law(m);
  const ContactStiffness k = ball_facet(law, 0.5);
  ContactHistory history;
  ContactMotion c = still(1e-6);
  c.velocity = {0, 0, 10};  // pieces part fast
  EXPECT_EQ(contact_step(law, k, c, history).force.norm(), 0);
}

// f - alpha |f| sign(v): (1 - alpha) f along the motion, (1 + alpha) f against it, f at rest.
TEST(ContactLaw, LocalDamping) {
  EXPECT_DOUBLE_EQ(locally_damped(10, 1, 0.4), 6);
  EXPECT_DOUBLE_EQ(locally_damped(-10, 1, 0.4), -14);
  EXPECT_DOUBLE_EQ(locally_damped(10, -1, 0.4), 14);
  EXPECT_DOUBLE_EQ(locally_damped(10, 0, 0.4), 10);
}

}  // namespace
}  // namespace scree
