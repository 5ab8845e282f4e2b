// The drop test: one rock on a floor.
#include <gtest/gtest.h>

#include <cmath>

#include "scree_version.h"
#include "sim/scene/run.h"

namespace scree {
namespace {

// With local damping alpha a rock falls at (1 - alpha) g, is pushed back by a spring with (1 + alpha) of its
// force on the way in and (1 - alpha) on the way out, and rises against (1 + alpha) g:
// rebound / height = ((1 - alpha) / (1 + alpha))^2, as long as the rock does not sink in under its weight by
// a length that counts beside the rebound (m g / kn = 0.1 mm for 0.1 m; 9 mm for 1 m).
TEST(DropTest, ReboundIsThatOfTheClosedForm) {
  const std::string source = SCREE_SOURCE_DIR;
  for (const double alpha : {0.2, 0.38, 0.4, 0.52, 0.63, 0.8})
    for (const char* size : {"0.1", "0.02"}) {
      ScenarioResult loaded = load_scenario(
          source + "/scenarios/drop_test.yaml",
          {"material.local_damping=" + std::to_string(alpha), std::string("experiment.diameter_m=") + size},
          source + "/assets");
      ASSERT_TRUE(loaded.errors.empty()) << loaded.errors.front().text();
      const RunOutcome outcome = run_scenario(loaded.scenario, 1, 1, {});
      ASSERT_TRUE(outcome.rebound_height.has_value());
      const double root = std::sqrt(*outcome.rebound_height / 1.0), found = (1 - root) / (1 + root);
      EXPECT_NEAR(found, alpha, 0.01) << size;
    }
}

TEST(DropTest, WithoutDampingItComesBack) {
  const std::string source = SCREE_SOURCE_DIR;
  ScenarioResult loaded =
      load_scenario(source + "/scenarios/drop_test.yaml", {"material.local_damping=0"}, source + "/assets");
  const RunOutcome outcome = run_scenario(loaded.scenario, 1, 1, {});
  EXPECT_NEAR(*outcome.rebound_height, 1.0, 0.01);
}

}  // namespace
}  // namespace scree
