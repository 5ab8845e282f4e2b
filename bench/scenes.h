#pragma once
// The scenes that the benchmarks run: start packings that every code can read, and scree's world for them.
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/world/rock_world.h"

namespace scree::bench {

/// A scene's spheres at time 0.
using Packing = std::vector<NewSphere>;

/// Laboratory lift: 75 kg of Lab0 (8 to 89 mm) at rest in a bucket of 0.35 m on a floor. Settled by scree.
Packing lab_packing(double mass, double bucket_height);
/// Field dump: 1,200 t of QB0 (0.1 to 2.66 m), loose, 1.5 m above the upper slope of a 14 m bench at 45
/// degrees, which fixed balls of 1 m cover.
Packing field_packing(double mass);
/// Heap of about `count` spheres of QB0, loose, in a box on a plane, as wide as it is high.
Packing heap_packing(int count);

/// CSV with header x_m,y_m,z_m,diameter_m,fixed. Throws std::runtime_error.
void write_packing(const Packing& packing, const std::filesystem::path& file);
Packing read_packing(const std::filesystem::path& file);

/// A packing moved up until it hangs 0.3 m above what of another lies below it.
Packing lifted_above(Packing packing, const Packing& other);

struct SceneSettings {
  double time_step = 0;  ///< s; 0: scree's own
  bool sleep = false;
  int threads = 1;
};

/// A scene ready to run from time 0: `lab` begins its lift at 0.5 m/s, `field` falls, `heap` stands in its
/// box. Lab: mu = mu_r = 0.2; field and heap: 0.44. Throws std::invalid_argument for an unknown name.
std::unique_ptr<RockWorld> make_scene(const std::string& name, const Packing& packing,
                                      const SceneSettings& settings);

}  // namespace scree::bench
