#pragma once
// The loads of an experiment that brings rock over the crest of a bench.
#include <functional>
#include <vector>

#include "sim/scene/scenario.h"
#include "sim/world/motion.h"
#include "sim/world/spheres.h"

namespace scree {

struct BenchLoads {
  std::vector<std::vector<NewSphere>> spheres;  ///< by load, in the world's frame
  std::vector<double> heights;                  ///< m, of the load over the floor of its box, by load
  std::vector<double> points;                   ///< y (m), by load
};

/// Every load of `payload` (kg) in its box, at the place that `pose` gives for a point along the crest.
/// Nothing that happens later changes what will be dumped. Throws as generate_diameters and fill_region do.
BenchLoads make_bench_loads(const Scenario& scenario, double payload, int dumps,
                            const std::vector<double>& points, const Vec3& box, std::uint64_t seed,
                            const std::function<Pose(double)>& pose);

}  // namespace scree
