#include "analysis/pile/half_cone.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace scree {

HalfCone analyse_half_cone(const std::vector<Grain>& pile, const std::vector<Grain>& original,
                           const Measurement& measured) {
  std::vector<Grain> whole = pile;
  for (Grain grain : pile) {
    grain.position.x() = -grain.position.x();
    whole.push_back(grain);
  }
  HalfCone cone;
  cone.shape = measure_repose(whole);
  const double height = cone.shape.flank_height;
  const double radius = height / std::tan(cone.shape.angle * std::numbers::pi / 180);
  if (!(height > 0 && radius > 0)) throw std::invalid_argument("the heap is no cone");

  double moment = 0, mass = 0;
  for (const Grain& grain : pile) moment += grain.mass * grain.position.y(), mass += grain.mass;
  std::vector<NamedGrains> cells{{"top", 1.0 / 6, {}}, {"middle", 0.5, {}}, {"bottom", 5.0 / 6, {}}};
  const double shift = measured.border_shift;  // down is out
  double outside = 0;
  for (const Grain& grain : pile) {
    const double up = grain.position.z() / height;
    const double out = std::hypot(grain.position.x(), grain.position.y() - moment / mass);
    if (up > (2 - shift) / 3)
      cells[0].grains.push_back(&grain);
    else if (up > (1 - shift) / 3 && out > (1 + shift) * radius / 3)
      cells[1].grains.push_back(&grain);
    else if (up <= (1 - shift) / 3 && out > (2 + shift) * radius / 3 &&
             out <= std::max(radius, cone.shape.radius))
      cells[2].grains.push_back(&grain);
    else
      outside += grain.mass;
  }
  cone.surface = tabulate(cells, original, measured);
  cone.surface.mass_outside = outside;
  return cone;
}

}  // namespace scree
