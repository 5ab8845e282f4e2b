#pragma once
// From a grain's outline to its sieve size and mass.
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/image/grain_shape.h"

namespace scree {

/// How a body is made of an outline (thesis, chapter 4).
enum class SizeModel {
  sphere,     ///< diameter of the disc of equal area; mass of that sphere
  ellipsoid,  ///< axes a and b of the fitted ellipse, c = lambda b; diameter b, mass of the ellipsoid
  feret       ///< the same with largest and smallest Feret diameter for a and b
};
constexpr SizeModel kSizeModels[] = {SizeModel::sphere, SizeModel::ellipsoid, SizeModel::feret};
std::string_view name_of(SizeModel model);

/// Thickness over width, c / b (flatness), of rock of Canadian Malartic, from weighed fractions.
constexpr double kShapeFactor = 0.53;

struct GrainSize {
  double diameter = 0;  ///< m: that of the square mesh it passes, the middle axis of three
  double mass = 0;      ///< kg
};

/// `m_per_px`, `shape_factor` lambda = c / b and `density` (kg/m3) above 0. A sphere has no use for lambda.
GrainSize size_of(const GrainShape& shape, double m_per_px, SizeModel model, double shape_factor,
                  double density);

/// Rock that was photographed and weighed.
struct WeighedFraction {
  std::string name;
  double weighed = 0;        ///< kg
  double with_lambda_1 = 0;  ///< kg: sum over its grains of density pi/6 a b^2
};

/// The shape factor for which the mass from images is the one weighed (thesis, equation 4.3).
struct ShapeFactor {
  double value = 0;  ///< of all fractions together
  std::vector<double> by_fraction;
};
/// Throws std::invalid_argument without fractions, or for masses that are not above 0.
ShapeFactor calibrate_shape_factor(std::span<const WeighedFraction> fractions);

}  // namespace scree
