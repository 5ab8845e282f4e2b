#include "analysis/image/grain_size.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace scree {

std::string_view name_of(SizeModel model) {
  switch (model) {
    case SizeModel::sphere:
      return "sphere";
    case SizeModel::ellipsoid:
      return "ellipsoid";
    case SizeModel::feret:
      break;
  }
  return "feret";
}

GrainSize size_of(const GrainShape& shape, double m_per_px, SizeModel model, double shape_factor,
                  double density) {
  const auto ellipsoid = [&](double a, double b) {
    return GrainSize{b * m_per_px,
                     density * std::numbers::pi / 6 * a * b * shape_factor * b * std::pow(m_per_px, 3)};
  };
  if (model == SizeModel::ellipsoid) return ellipsoid(shape.major, shape.minor);
  if (model == SizeModel::feret) return ellipsoid(shape.feret_max, shape.feret_min);
  const double d = shape.equal_area_diameter() * m_per_px;
  return {d, density * std::numbers::pi / 6 * d * d * d};
}

ShapeFactor calibrate_shape_factor(std::span<const WeighedFraction> fractions) {
  ShapeFactor factor;
  double weighed = 0, with_lambda_1 = 0;
  for (const WeighedFraction& fraction : fractions) {
    if (!(fraction.weighed > 0))
      throw std::invalid_argument(fmt::format("{}: a mass above 0 is needed", fraction.name));
    if (!(fraction.with_lambda_1 > 0))
      throw std::invalid_argument(fmt::format("{}: no grain was found in the picture", fraction.name));
    factor.by_fraction.push_back(fraction.weighed / fraction.with_lambda_1);
    weighed += fraction.weighed;
    with_lambda_1 += fraction.with_lambda_1;
  }
  if (fractions.empty()) throw std::invalid_argument("a shape factor needs at least one weighed fraction");
  factor.value = weighed / with_lambda_1;
  return factor;
}

}  // namespace scree
