#pragma once
// Designs of experiments: which points of a space of parameters are simulated.
#include <cstdint>
#include <vector>

namespace scree {

/// Points of the unit cube, one row a point.
using UnitPoints = std::vector<std::vector<double>>;

/// Latin hypercube: in every dimension each of `count` equal slices holds one point, at random in it (McKay,
/// Beckman & Conover, Technometrics 21, 1979).
UnitPoints latin_hypercube(int count, int dimensions, std::uint64_t seed);

/// The first points of Sobol's sequence (direction numbers of Joe & Kuo, SIAM J. Sci. Comput. 30, 2008),
/// without the origin. More points later are the same and further ones.
UnitPoints sobol(int count, int dimensions);

}  // namespace scree
