#include "sim/scene/dump_loads.h"

#include "sim/material/grading.h"

namespace scree {

DumpLoads make_dump_loads(const Scenario& scenario, double payload, int dumps,
                          const std::vector<double>& points, const LoadRegion& region, std::uint64_t seed,
                          const std::function<Pose(double)>& pose) {
  const Grading grading = read_grading(scenario.grading_file);
  DumpLoads loads;
  for (int dump = 1; dump <= dumps; ++dump) {
    const auto stream = static_cast<std::uint64_t>(dump);
    const std::vector<double> diameters =
        generate_diameters(grading, payload, scenario.material.density, seed, stream);
    const Load load = fill_region(region, diameters, seed, stream);
    loads.points.push_back(points[static_cast<std::size_t>(dump - 1) % points.size()]);
    loads.heights.push_back(load.height);
    const Pose here = pose(loads.points.back());
    std::vector<NewSphere> spheres;
    for (std::size_t k = 0; k < diameters.size(); ++k)
      spheres.push_back({here.to_world(load.positions[k]), diameters[k], dump});
    loads.spheres.push_back(std::move(spheres));
  }
  return loads;
}

}  // namespace scree
