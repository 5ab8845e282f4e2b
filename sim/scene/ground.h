#pragma once
// Ground of the experiments: bench, floor, base layer of fixed balls.
#include <cstdint>
#include <vector>

#include "sim/io/mesh.h"
#include "sim/scene/scenario.h"
#include "sim/world/spheres.h"

namespace scree {

/// x of the toe (m).
double toe_of(const BenchSpec& bench);

/// How far the balls of a layer, of `diameter` (m), stand out of the surface that carries their centres (m);
/// 0 without a layer.
double ball_radius(BaseLayer layer, double diameter);

/// Height (m) on which loads and blades stand on the bench top: that of its balls, where it has some.
double standing_height(const BenchSpec& bench);

/// The bench as a closed solid, 5 m deep below its floor.
TriangleMesh make_bench(const BenchSpec& bench);

/// Fixed balls that cover slope, floor and, with `layer_on_top`, the top: rows across the slope at a
/// hexagonal pitch, so that no straight groove leads down it. Their centres lie on the surface. The source
/// does not say how deep they sit; with the centres on the surface the masses of the highest and the lowest
/// of six sections of case A1 come out as printed (32 t, 375 t), with balls that rest on the surface they do
/// not (50 t, 204 t). `mixed` puts four balls of half the diameter at half of the places, drawn at random
/// (thesis, appendix F). Before a plane top the highest row lies a pitch below the crest, so that no ball
/// stands out above the top.
std::vector<NewSphere> make_base_layer(const BenchSpec& bench, std::uint64_t seed);

/// The same on a square floor at z = 0 from -half_width to half_width.
std::vector<NewSphere> make_floor_layer(double half_width, BaseLayer layer, double diameter,
                                        std::uint64_t seed);

/// About how many balls a layer has on a surface of this area (m2).
double estimated_balls(double area, BaseLayer layer, double diameter);

/// A tube about the z axis, closed as a solid: inner radius of the inscribed circle, from z = low to high
/// (m).
TriangleMesh make_tube(double inner_radius, double wall, double low, double high, int sides);

}  // namespace scree
