// A world that was saved goes on as if nothing had been: to the last bit, of all that it holds, whatever it
// was doing and with any number of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "sim/material/random.h"
#include "sim/world/rrlinear_world.h"
#include "tests/world/ball.h"

namespace scree {
namespace {

std::string saved(RockWorld& world) {
  std::string bytes;
  StateWriter writer(
      [&](const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); });
  world.save_state(writer);
  return bytes;
}

void load(RockWorld& world, const std::string& bytes) {
  std::size_t at = 0;
  StateReader reader(
      [&](void* data, std::size_t size) {
        std::memcpy(data, bytes.data() + at, size);
        at += size;
      },
      bytes.size());
  world.load_state(reader);
  EXPECT_EQ(at, bytes.size());
}

std::vector<NewSphere> rain(double height) {
  Random random(4, 0, RandomPurpose::positions);
  std::vector<NewSphere> spheres;
  for (int k = 0; k < 6; ++k)
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j)
        spheres.push_back(ball(
            {0.5 * i + random.uniform(-0.02, 0.02), 0.5 * j + random.uniform(-0.02, 0.02), height + 0.5 * k},
            random.uniform() < 0.2 ? 0.23 : random.uniform(0.06, 0.15)));
  return spheres;
}

struct Kind {
  const char* name;
  void (*change)(WorldSettings&);
};

// A load falls on fixed balls and comes to rest, a wall beside it is taken away, a second load falls, and a
// blade that waits moves through both. Time goes on by tick(t), in steps of 0.1 s.
void play(RockWorld& world, const std::function<void(double)>& tick) {
  const auto advance = [&](double end) {
    while (world.time() < end - 1e-9) tick(std::min(end, world.time() + 0.1));
  };
  std::vector<NewSphere> fixed;
  for (int x = -8; x <= 8; ++x)
    for (int y = -8; y <= 8; ++y) {
      fixed.push_back(ball({0.5 * x, 0.5 * y, 0}, 0.25));
      fixed.back().fixed = true;
    }
  world.add_spheres(fixed);
  world.reserve_numbers(static_cast<std::int64_t>(fixed.size()) + 2 * 294);
  const Surface surface{0.4, 0.4};
  world.add_mesh(make_box({-20, -20, -2}, {20, 20, 0}), surface, Motion::fixed(Pose{}));
  const int wall = world.add_mesh(make_box({1.8, -4, 0}, {2, 4, 4}), surface, Motion::fixed(Pose{}));
  const auto pose = [](double x) { return Pose{{x, 0, 0.3}, Quaternion::Identity()}; };
  const int blade = world.add_mesh(make_box({-0.3, -3, 0}, {0, 3, 1.5}), surface, Motion::fixed(pose(-3)));
  world.add_spheres(rain(0.6));
  advance(2.0);
  world.remove_mesh(wall);
  world.add_spheres(rain(3.5));
  advance(2.7);
  world.set_velocity(static_cast<std::int64_t>(fixed.size()) + 5, {0, 0, 4}, {1, 2, 3});
  world.set_mesh_motion(blade, Motion({{world.time(), pose(-3)}, {world.time() + 1, pose(-1)}}));
  advance(3.7);
}

class SavedWorld : public testing::TestWithParam<Kind> {
 protected:
  static std::unique_ptr<RrlinearWorld> make(int threads) {
    WorldSettings settings;
    settings.sleep = true;
    settings.threads = threads;
    GetParam().change(settings);
    return std::make_unique<RrlinearWorld>(settings);
  }
};

TEST_P(SavedWorld, GoesOnWithTheSameBits) {
  // Falling, at rest, before and after the second load, at its impact, before and while the blade moves.
  const std::vector<double> moments{0.1, 1.5, 2.0, 2.1, 2.5, 2.7, 3.2};
  std::vector<std::string> states;
  const auto whole = make(1);
  std::int64_t asleep = 0;
  play(*whole, [&](double time) {
    whole->advance_to(time);
    asleep = std::max(asleep, whole->statistics().asleep);
    if (states.size() < moments.size() && std::abs(time - moments[states.size()]) < 1e-6)
      states.push_back(saved(*whole));
  });
  ASSERT_EQ(states.size(), moments.size());
  const WorldSettings& settings = whole->settings();
  EXPECT_GT(whole->spheres().movable, kBlock) << "several threads share the work";
  EXPECT_GE(asleep, settings.sleep && !settings.vibration.on() ? 10 : 0);
  EXPECT_GE(whole->statistics().broken_spheres, settings.breakage.on() ? 5 : 0);
  EXPECT_GE(whole->statistics().lost_particles, settings.domain_high.x() < 10 ? 2 : 0);
  const std::string end = saved(*whole);

  for (std::size_t k = 0; k < moments.size(); ++k) {
    const auto resumed = make(k % 2 == 0 ? 3 : 1);
    bool loaded = false;
    play(*resumed, [&](double time) {
      if (loaded) return resumed->advance_to(time);
      resumed->skip_to(time);
      if (time < moments[k] - 1e-6) return;
      load(*resumed, states[k]);
      loaded = true;
      EXPECT_EQ(resumed->time(), time);
      EXPECT_TRUE(saved(*resumed) == states[k]) << "not what was written at " << moments[k] << " s";
    });
    EXPECT_TRUE(saved(*resumed) == end) << "another end after " << moments[k] << " s";
  }
}

INSTANTIATE_TEST_SUITE_P(Of, SavedWorld,
                         testing::Values(Kind{"plain", [](WorldSettings& s) { s.sleep = false; }},
                                         Kind{"sleep", [](WorldSettings&) {}},
                                         Kind{"effects",
                                              [](WorldSettings& s) {
                                                s.contact_effects.surface_energy = 5;
                                                s.contact_effects.mu_t = 0.1;
                                                s.contact_effects.mu_exponent = 0.3;
                                                s.contact_effects.weakening = 0.3;
                                              }},
                                         Kind{"vibration",
                                              [](WorldSettings& s) {
                                                s.vibration.amplitude = 0.3;
                                                s.vibration.frequency = 8;
                                              }},
                                         Kind{"breakage",
                                              [](WorldSettings& s) {
                                                s.breakage.fragility = 0.2;
                                                s.breakage.reference_diameter = 0.2;
                                                s.breakage.smallest_diameter = 0.1;
                                              }},
                                         Kind{"clumps", [](WorldSettings& s) { s.clumps.elongation = 0.6; }},
                                         Kind{"lost_clumps",
                                              [](WorldSettings& s) {
                                                s.clumps.elongation = 0.3;
                                                s.domain_low = Vec3(-1.9, -1.9, -1);
                                                s.domain_high = Vec3(1.9, 1.9, 20);
                                              }},
                                         Kind{"losses",
                                              [](WorldSettings& s) {
                                                s.domain_low = Vec3(-1.9, -1.9, -1);
                                                s.domain_high = Vec3(1.9, 1.9, 20);
                                              }}),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(SavedWorlds, OfOtherMeshesIsRefused) {
  WorldSettings settings;
  RrlinearWorld one(settings), other(settings);
  one.add_spheres({ball({0, 0, 1}, 0.2)});
  one.add_mesh(make_box({-1, -1, -1}, {1, 1, 0}), {0.4, 0.4}, Motion::fixed(Pose{}));
  one.advance_to(0.1);
  const std::string bytes = saved(one);
  EXPECT_THROW(load(other, bytes), StateError);
}

TEST(SavedWorlds, CutShortIsAnErrorAndNoMore) {
  WorldSettings settings;
  RrlinearWorld one(settings);
  one.add_spheres(rain(0.6));
  one.advance_to(0.2);
  const std::string bytes = saved(one);
  for (const double share : {0.0, 0.001, 0.3, 0.9}) {
    RrlinearWorld other(settings);
    EXPECT_THROW(
        load(other, bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size())))),
        StateError);
  }
}

#if defined(__GLIBCXX__) && defined(__x86_64__)
// A class that has grown has a new member. If later steps depend on it, it belongs into world_state.cpp (or
// the function state() beside the class), whose section then has another version; then the size here is
// changed.
TEST(SavedWorlds, HoldEveryMember) {
  EXPECT_EQ(sizeof(WorldStatistics), 96u);
  EXPECT_EQ(sizeof(Spheres), 224u);
  EXPECT_EQ(sizeof(GrowingSphere), 16u);
  EXPECT_EQ(sizeof(AwakeEnergy), 32u);
  EXPECT_EQ(sizeof(EnergyWatch), 56u);
  EXPECT_EQ(sizeof(ContactHistory), 64u);
  EXPECT_EQ(sizeof(MeshContact), 112u);
  EXPECT_EQ(sizeof(BodyState), 112u);
  EXPECT_EQ(sizeof(MeshBody), 400u);
  EXPECT_EQ(sizeof(Rows<Neighbour>), 56u);
  EXPECT_EQ(sizeof(NeighbourGrid), 200u);
  EXPECT_EQ(sizeof(PairList), 520u);
  EXPECT_EQ(sizeof(FacetList), 256u);
  EXPECT_EQ(sizeof(Sleep), 176u);
  EXPECT_EQ(sizeof(BlockWork), 328u);
  EXPECT_EQ(sizeof(RockWorld) - sizeof(BulletParts) - sizeof(btDiscreteDynamicsWorld) - sizeof(WorldSettings),
            576u);
  EXPECT_EQ(sizeof(RrlinearWorld) - sizeof(RockWorld) - sizeof(ContactLaw) - sizeof(Team), 1312u);
}
#endif

// Bullet keeps contacts and the order of its pairs in places that it does not give out.
TEST(SavedWorlds, OfTheImpulseEngineThereIsNone) {
  const auto world = make_impulse_world({});
  EXPECT_FALSE(world->keeps_state());
  StateWriter writer([](const void*, std::size_t) {});
  EXPECT_THROW(world->save_state(writer), StateError);
}

}  // namespace
}  // namespace scree
