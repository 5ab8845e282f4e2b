#pragma once
// The loads of an experiment that dumps rock, one after another.
#include <vector>

#include "sim/scene/load.h"
#include "sim/scene/scenario.h"
#include "sim/world/spheres.h"

namespace scree {

struct DumpLoads {
  std::vector<std::vector<NewSphere>> spheres;  ///< by load, in the world's frame
  std::vector<double> heights;                  ///< m, of the load over the bottom of its region, by load
};

/// Every load of `payload` (kg) in its region, at its pose; one load a pose. Nothing that happens later
/// changes what will be dumped. Throws as generate_diameters and fill_region do.
DumpLoads make_dump_loads(const Scenario& scenario, double payload, const std::vector<Pose>& poses,
                          const LoadRegion& region, std::uint64_t seed);

}  // namespace scree
