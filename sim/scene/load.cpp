#include "sim/scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/material/random.h"
#include "sim/world/grid.h"

namespace scree {
namespace {

constexpr int kTries = 400;
constexpr double kGrowth = 1.02;

}  // namespace

Load fill_region(const LoadRegion& region, const std::vector<double>& diameters, std::uint64_t seed,
                 std::uint64_t dump) {
  Load load;
  load.height = region.length.z();
  if (diameters.empty()) return load;
  const bool cylinder = region.length.y() == 0;
  const double largest = diameters.front(), smallest = diameters.back();
  const double width = cylinder ? region.length.x() : std::min(region.length.x(), region.length.y());
  if (largest > width)
    throw std::invalid_argument(
        fmt::format("a sphere of {:.3f} m does not fit into a container {:.3f} m wide", largest, width));
  load.height = std::max(load.height, 1.01 * largest);

  Random random(seed, dump, RandomPurpose::positions);
  NeighbourGrid grid;
  grid.reset(static_cast<int>(diameters.size()), 0.5 * smallest, 0.5 * largest);
  for (int i = 0; i < static_cast<int>(diameters.size()); ++i) {
    const double r = 0.5 * diameters[i];
    for (int tries = 0;; ++tries) {
      if (tries == kTries) {
        load.height *= kGrowth;
        tries = 0;
      }
      Vec3 x;
      if (cylinder) {
        const double rho = (0.5 * region.length.x() - r) * std::sqrt(random.uniform());
        const double angle = 2.0 * std::numbers::pi * random.uniform();
        x = {rho * std::cos(angle), rho * std::sin(angle), 0};
      } else {
        x = {random.uniform(-region.length.x() + r, -r),
             random.uniform(-0.5 * region.length.y() + r, 0.5 * region.length.y() - r), 0};
      }
      x.z() = random.uniform(r, load.height - r);
      grid.place(i, x, r);
      bool free = true;
      grid.query(i, [&](int j) {
        const double reach = r + grid.site(j).w;
        if ((x - grid.site(j).vec()).squaredNorm() < reach * reach) free = false;
      });
      if (free) {
        load.positions.push_back(x);
        break;
      }
    }
  }
  return load;
}

}  // namespace scree
