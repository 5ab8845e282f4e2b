#include "sim/scene/dump_loads.h"

#include "sim/material/grading.h"

namespace scree {

DumpLoads make_dump_loads(const Scenario& scenario, double payload, const std::vector<Pose>& poses,
                          const LoadRegion& region, std::uint64_t seed) {
  const EffectiveModel model = effective_model(scenario);
  DumpLoads loads;
  int dump = 0;
  for (const Pose& here : poses) {
    ++dump;
    const auto stream = static_cast<std::uint64_t>(dump);
    const std::vector<double> diameters =
        generate_diameters(model.grading, payload, density_of(model.material), seed, stream);
    const Load load = fill_region(region, diameters, seed, stream, model.changes.clumps);
    loads.heights.push_back(load.height);
    std::vector<NewSphere> spheres;
    for (std::size_t k = 0; k < diameters.size(); ++k)
      spheres.push_back({.position = here.to_world(load.positions[k]),
                         .diameter = diameters[k],
                         .dump = dump,
                         .axis = load.axes.empty() ? Vec3::Zero() : Vec3(here.rotation * load.axes[k])});
    loads.spheres.push_back(std::move(spheres));
  }
  return loads;
}

}  // namespace scree
