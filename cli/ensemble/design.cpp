#include "cli/ensemble/design.h"

#include <boost/random/sobol.hpp>
#include <utility>

#include "sim/material/random.h"

namespace scree {

UnitPoints latin_hypercube(int count, int dimensions, std::uint64_t seed) {
  UnitPoints points(static_cast<std::size_t>(count),
                    std::vector<double>(static_cast<std::size_t>(dimensions)));
  for (int d = 0; d < dimensions; ++d) {
    Random random(seed, static_cast<std::uint64_t>(d), RandomPurpose::design);
    std::vector<int> slice(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) slice[static_cast<std::size_t>(k)] = k;
    for (int k = count - 1; k > 0; --k)
      std::swap(slice[static_cast<std::size_t>(k)],
                slice[static_cast<std::size_t>(random.uniform() * (k + 1))]);
    for (int k = 0; k < count; ++k)
      points[static_cast<std::size_t>(k)][static_cast<std::size_t>(d)] =
          (slice[static_cast<std::size_t>(k)] + random.uniform()) / count;
  }
  return points;
}

UnitPoints sobol(int count, int dimensions) {
  boost::random::sobol sequence(static_cast<std::size_t>(dimensions));
  UnitPoints points(static_cast<std::size_t>(count),
                    std::vector<double>(static_cast<std::size_t>(dimensions)));
  for (auto& point : points)
    for (double& x : point) x = static_cast<double>(sequence()) / 0x1.0p64;
  return points;
}

}  // namespace scree
