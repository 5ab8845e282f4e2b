// Two runs of the stored sweeps again, at their full size: a change of physics shows, a change of roundings
// does not. Which grains end where is as good as random, so that a run moves by as much as seeds differ when
// anything changes the order of sums.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <thread>

#include "analysis/pile/repose_angle.h"
#include "cli/ensemble/sweep_results.h"
#include "scree_version.h"
#include "sim/scene/run.h"

namespace scree {
namespace {

const std::filesystem::path kSource = SCREE_SOURCE_DIR;

struct Again {
  const char* sweep;
  std::vector<std::string> values;  // of the point
};

/// Deviation between seeds, over all points of a sweep.
double scatter(const std::vector<PointResults>& points) {
  double squares = 0;
  int free = 0;
  for (const PointResults& point : points) {
    const MeanStd both = point.of("angle_deg");
    if (both.n < 2) continue;
    squares += both.std * both.std * (both.n - 1);
    free += both.n - 1;
  }
  return std::sqrt(squares / free);
}

TEST(Sweeps, StoredAnglesAreFoundAgain) {
  const std::vector<Again> all{{"repose_lab", {"0.3", "0.1"}}, {"repose_field_qb", {"0.4", "0.4"}}};
  std::vector<double> off(all.size());  // in deviations
  const auto run = [&](std::size_t first) {
    for (std::size_t k = first; k < all.size(); k += 2) {
      const SweepResult loaded = load_sweep(
          kSource / "scenarios" / "sweeps" / (std::string(all[k].sweep) + ".yaml"), kSource / "assets");
      ASSERT_TRUE(loaded.errors.empty());
      const auto stored =
          read_sweep_csv(loaded.sweep, kSource / "assets" / "sweeps" / (std::string(all[k].sweep) + ".csv"));
      for (const PointResults& point : stored) {
        if (point.point->values != all[k].values) continue;
        const RunOutcome outcome = run_scenario(point.point->scenario, point.seeds[0], 1, {});
        EXPECT_TRUE(outcome.at_rest);
        const double angle = measure_repose(outcome.final_state.grains).angle;
        off[k] = (angle - point.of("angle_deg").mean) / scatter(stored);
        std::printf("%s %s %s: %.2f, stored mean %.2f, deviation %.2f degrees\n", all[k].sweep,
                    all[k].values[0].c_str(), all[k].values[1].c_str(), angle, point.of("angle_deg").mean,
                    scatter(stored));
      }
    }
  };
  std::thread other(run, 1);
  run(0);
  other.join();
  for (const double each : off) {
    EXPECT_NE(each, 0.0);  // it was run
    EXPECT_LT(std::abs(each), 4);
  }
}

}  // namespace
}  // namespace scree
