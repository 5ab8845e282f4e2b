// Flows of grains whose velocities are known.
#include "analysis/pile/flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace scree {
namespace {

FlowSettings settings() {
  FlowSettings s;
  s.bench = {12, 30};  // six sections of 2 m
  s.fewest_moving = 2;
  return s;
}

Grain grain(std::int64_t id, double z, double speed, double mass = 100) {
  Grain g;
  g.id = id;
  g.position = Vec3((12 - z) * std::sqrt(3.0), 0, z);
  g.velocity = Vec3(std::sqrt(0.75), 0, -0.5) * speed;  // down 30 degrees
  g.diameter = 0.5;
  g.mass = mass;
  return g;
}

TEST(Flow, SpeedsOfSectionsAreWeighedByMass) {
  FlowRecorder flow(settings());
  flow.add({0.0, {grain(1, 11, 2, 100), grain(2, 10.5, 4, 300), grain(3, 11.5, 0.05, 900)}});
  flow.add({0.1, {grain(1, 9, 1, 100), grain(2, 8.5, 1, 300), grain(3, 11.5, 0.05, 900)}});
  ASSERT_EQ(flow.rows().size(), 2u);
  EXPECT_NEAR(flow.rows()[0].mean[0], 3.5, 1e-12);  // (2 * 100 + 4 * 300) / 400; the third does not move
  EXPECT_NEAR(flow.rows()[0].fast[0], 4, 1e-12);
  EXPECT_TRUE(std::isnan(flow.rows()[0].mean[1]));
  EXPECT_TRUE(std::isnan(flow.rows()[1].mean[0]));
  EXPECT_NEAR(flow.highest_mean()[0], 3.5, 1e-12);
  EXPECT_NEAR(flow.highest_mean()[1], 1, 1e-12);
  EXPECT_TRUE(std::isnan(flow.highest_mean()[5]));
  EXPECT_NEAR(flow.rows()[0].kinetic_energy, 0.5 * (100 * 4 + 300 * 16 + 900 * 0.0025), 1e-9);
}

TEST(Flow, OneStrayBlockIsNoFlow) {
  FlowRecorder flow(settings());
  flow.add({0, {grain(1, 5, 20)}});
  EXPECT_TRUE(std::isnan(flow.highest_mean()[3]));
}

TEST(Flow, DepthIsThatOfAMovingCarpet) {
  // Cubes' worth of touching grains, two rows thick, over the middle of the slope; only they move.
  FlowSettings s = settings();
  s.porosity = 1 - std::numbers::pi / 6;
  const double d = 0.25, slope = std::numbers::pi / 6;
  Snapshot snapshot;
  for (double along = d / 2; along < 24; along += d)
    for (double y = -3 + d / 2; y < 3; y += d)
      for (int row = 0; row < 4; ++row) {
        Grain g;
        g.id = static_cast<std::int64_t>(snapshot.grains.size());
        const double off = (row + 0.5) * d;
        g.position = Vec3(along * std::cos(slope) + off * std::sin(slope), y,
                          12 - along * std::sin(slope) + off * std::cos(slope));
        g.diameter = d;
        g.mass = 20;
        if (row >= 2) g.velocity = Vec3(1, 0, -0.5);
        snapshot.grains.push_back(g);
      }
  FlowRecorder flow(s);
  flow.add(snapshot);
  EXPECT_NEAR(flow.rows()[0].depth, 0.5, 0.03);
  EXPECT_EQ(flow.largest_depth(), flow.rows()[0].depth);
}

TEST(Flow, FreeFallArrivesWithTheWholeDrop) {
  FlowRecorder flow(settings());
  const auto falling = [](double z) { return grain(7, z, std::sqrt(2 * 9.81 * (12 - z))); };
  double time = 0;
  for (const double z : {12.0, 8.0, 3.0, 0.0, 0.0}) flow.add({time += 0.1, {falling(z)}});
  EXPECT_NEAR(flow.arrival().mean_energy, 9.81 * 12, 1e-9);
  EXPECT_NEAR(flow.arrival().share_of_drop, 1, 1e-12);
  EXPECT_NEAR(flow.arrival().mass, 100, 1e-12) << "a grain arrives once";
}

TEST(Flow, ArrivalIsWeighedByMass) {
  FlowRecorder flow(settings());
  EXPECT_TRUE(std::isnan(flow.arrival().mean_energy) && std::isnan(flow.arrival().share_of_drop));
  flow.add({0, {grain(1, 6, 1, 100), grain(2, 6, 1, 300), grain(3, 1, 5, 900)}});
  flow.add({1, {grain(1, 1, 4, 100), grain(2, 1, 2, 300), grain(3, 1, 5, 900)}});
  EXPECT_NEAR(flow.arrival().mass, 400, 1e-12) << "the third was there before";
  EXPECT_NEAR(flow.arrival().mean_energy, (8 * 100 + 2 * 300) / 400.0, 1e-12);  // v^2 / 2
  EXPECT_NEAR(flow.arrival().fast_energy, 8, 1e-12);
}

TEST(Flow, KeepsTheLiveliestSnapshot) {
  FlowRecorder flow(settings());
  flow.add({0, {grain(1, 15, 30)}});  // above the crest
  EXPECT_FALSE(flow.liveliest());
  flow.add({1, {grain(1, 6, 1)}});
  flow.add({2, {grain(1, 4, 3)}});
  flow.add({3, {grain(1, 2, 2)}});
  ASSERT_TRUE(flow.liveliest());
  EXPECT_EQ(flow.liveliest()->time, 2);
}

TEST(Flow, MemoryIsBounded) {
  FlowSettings s = settings();
  s.most_rows = 4;
  FlowRecorder flow(s);
  for (int k = 0; k < 100; ++k) flow.add({0.1 * k, {grain(1, 5, k == 57 ? 9 : 1), grain(2, 5, 1)}});
  EXPECT_EQ(flow.snapshots(), 100u);
  ASSERT_EQ(flow.rows().size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(flow.rows()[k].time, 3.2 * static_cast<double>(k), 1e-9);
  EXPECT_NEAR(flow.highest_mean()[3], 5, 1e-12) << "maxima are over all snapshots";
}

TEST(Flow, RefusesBadArguments) {
  const auto with = [](auto change) {
    FlowSettings s = settings();
    change(s);
    return s;
  };
  EXPECT_THROW(FlowRecorder(with([](auto& s) { s.bench.height = 0; })), std::invalid_argument);
  EXPECT_THROW(FlowRecorder(with([](auto& s) { s.bench.slope_deg = 0; })), std::invalid_argument);
  EXPECT_THROW(FlowRecorder(with([](auto& s) { s.sections = 0; })), std::invalid_argument);
  EXPECT_THROW(FlowRecorder(with([](auto& s) { s.half_width = 0; })), std::invalid_argument);
  EXPECT_THROW(FlowRecorder(with([](auto& s) { s.moving_speed = -1; })), std::invalid_argument);
  EXPECT_THROW(FlowRecorder(with([](auto& s) { s.fewest_moving = 0; })), std::invalid_argument);
  EXPECT_THROW(FlowRecorder(with([](auto& s) { s.porosity = 1; })), std::invalid_argument);
  EXPECT_THROW(FlowRecorder(with([](auto& s) { s.most_rows = 3; })), std::invalid_argument);
  FlowRecorder flow(settings());
  flow.add({1, {}});
  EXPECT_THROW(flow.add({1, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace scree
