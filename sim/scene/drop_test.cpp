// One rock that falls on a floor: its rebound gives the local damping.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/scene/ground.h"
#include "sim/scene/stage.h"

namespace scree {
namespace {
constexpr double kLook = 1e-4;      // s between looks at the rock
constexpr double kMostTime = 1000;  // times the fall without damping
}  // namespace

RunOutcome run_drop_test(const Scenario& scenario, const DropTest& e, std::uint64_t seed, int threads,
                         const RunHooks& hooks) {
  const double radius = 0.5 * e.diameter, wide = 10 * e.diameter;
  Stage stage(scenario, seed, threads, hooks, {-wide, -wide, -e.diameter},
              {wide, wide, 2 * (e.height + e.diameter)});
  RockWorld& world = stage.world();
  stage.begin({}, {{{Vec3(0, 0, e.height + radius), e.diameter, 1}}});
  world.add_mesh(make_box({-wide, -wide, -wide}, {wide, wide, 0}), stage.ground_surface(), Motion());
  stage.add_tools();
  stage.set_dump(1, 1);
  stage.add_load();

  const double fall = std::sqrt(2 * e.height / world.settings().gravity.norm());
  bool bounced = false;
  double highest = 0;
  while (true) {
    if (world.time() > kMostTime * fall) throw std::invalid_argument("the rock has not come to its rebound");
    if (!stage.advance(kLook, bounced ? "rebounding" : "falling", bounced ? 0.7 : 0.0, bounced ? 1.0 : 0.7))
      return stage.finish();
    Grain rock;
    const double grains = stage.observe([&] {
      const Snapshot now = world.snapshot();
      if (!now.grains.empty()) rock = now.grains.front();
      return static_cast<double>(now.grains.size());
    });
    if (grains == 0)
      throw std::invalid_argument(
          "the rock went through the floor: raise material.effective_modulus_pa or lower "
          "experiment.height_m");
    if (grains > 1)
      throw std::invalid_argument(
          "the rock broke and has no rebound: lower effects.breakage.fragility_kg_per_j");
    const double height = stage.observe([&] { return rock.position.z() - radius; });
    const bool rises = stage.observe([&] { return rock.velocity.z(); }) > 0;
    if (bounced && !rises) break;
    bounced = bounced || rises;
    if (bounced) highest = std::max(highest, height);
  }
  RunOutcome outcome = stage.finish();
  outcome.rebound_height = highest;
  return outcome;
}

}  // namespace scree
