#include "sim/scene/dump_loads.h"

#include "sim/material/grading.h"

namespace scree {

DumpLoads make_dump_loads(const Scenario& scenario, double payload, const std::vector<Pose>& poses,
                          const LoadRegion& region, std::uint64_t seed) {
  const Grading grading = effective_model(scenario).grading;
  DumpLoads loads;
  int dump = 0;
  for (const Pose& here : poses) {
    ++dump;
    const auto stream = static_cast<std::uint64_t>(dump);
    const std::vector<double> diameters =
        generate_diameters(grading, payload, scenario.material.density, seed, stream);
    const Load load = fill_region(region, diameters, seed, stream);
    loads.heights.push_back(load.height);
    std::vector<NewSphere> spheres;
    for (std::size_t k = 0; k < diameters.size(); ++k)
      spheres.push_back({here.to_world(load.positions[k]), diameters[k], dump});
    loads.spheres.push_back(std::move(spheres));
  }
  return loads;
}

}  // namespace scree
