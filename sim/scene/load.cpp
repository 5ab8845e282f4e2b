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
constexpr double kDensest = 0.6;  // solid fraction; at random few gradings get denser

// Places the grains one after another where their spheres touch none before; false when one finds no place.
bool fill(Load& load, const LoadRegion& region, const std::vector<double>& diameters, Random random,
          const Clumps& clumps) {
  const bool cylinder = region.length.y() == 0;
  const double size = 0.5 * clumps.size();
  const int each = clumps.spheres();
  NeighbourGrid grid;
  grid.reset(each * static_cast<int>(diameters.size()), size * diameters.back(), size * diameters.front());
  for (int i = 0; i < static_cast<int>(diameters.size()); ++i) {
    const double r = size * diameters[i], arm = clumps.elongation * r;
    bool free = false;
    for (int tries = 0; tries < kTries && !free; ++tries) {
      Vec3 axis = Vec3::Zero();
      double flat = 0;  // its length seen from above
      if (clumps.on()) {
        const double up = random.uniform(-1, 1), around = 2.0 * std::numbers::pi * random.uniform();
        flat = std::sqrt(std::max(0.0, 1 - up * up));
        axis = {flat * std::cos(around), flat * std::sin(around), up};
      }
      const Vec3 reach = Vec3::Constant(r) + arm * axis.cwiseAbs();
      Vec3 x;
      if (cylinder) {
        const double rho = (0.5 * region.length.x() - r - arm * flat) * std::sqrt(random.uniform());
        const double angle = 2.0 * std::numbers::pi * random.uniform();
        x = {rho * std::cos(angle), rho * std::sin(angle), 0};
      } else {
        x = {random.uniform(-region.length.x() + reach.x(), -reach.x()),
             random.uniform(-0.5 * region.length.y() + reach.y(), 0.5 * region.length.y() - reach.y()), 0};
      }
      x.z() = random.uniform(reach.z(), load.height - reach.z());
      for (int k = 0; k < each; ++k) grid.place(each * i + k, x + (2 * k - 1) * arm * axis, r);
      free = true;
      for (int k = 0; k < each; ++k) {
        const int own = each * i + k;
        grid.query(own, [&](int j) {
          const double apart = r + grid.site(j).w;
          if (j / each != i && (grid.site(own).vec() - grid.site(j).vec()).squaredNorm() < apart * apart)
            free = false;
        });
      }
      if (!free) continue;
      load.positions.push_back(x);
      if (clumps.on()) load.axes.push_back(axis);
    }
    if (!free) return false;
  }
  return true;
}

}  // namespace

Load fill_region(const LoadRegion& region, const std::vector<double>& diameters, std::uint64_t seed,
                 std::uint64_t dump, const Clumps& clumps) {
  Load load;
  load.height = region.length.z();
  if (diameters.empty()) return load;
  const double largest = clumps.length() * diameters.front();
  const double width =
      region.length.y() == 0 ? region.length.x() : std::min(region.length.x(), region.length.y());
  if (largest > width)
    throw std::invalid_argument(
        fmt::format("a grain of {:.3f} m does not fit into a container {:.3f} m wide", largest, width));
  double solid = 0;
  for (const double d : diameters) solid += std::numbers::pi / 6 * d * d * d;
  const double area = region.length.y() == 0 ? 0.25 * std::numbers::pi * width * width
                                             : region.length.x() * region.length.y();
  load.height = std::max({load.height, 1.01 * largest, solid / (kDensest * area)});

  // A region that is too small grows, and is filled anew from the start: were only the rest put into what was
  // added, the fines, which are placed last, would lie on top.
  const auto filled = [&] {
    load.positions.clear();
    load.axes.clear();
    return fill(load, region, diameters, Random(seed, dump, RandomPurpose::positions), clumps);
  };
  while (!filled()) load.height *= kGrowth;
  return load;
}

}  // namespace scree
