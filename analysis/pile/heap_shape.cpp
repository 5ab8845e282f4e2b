#include "analysis/pile/heap_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "analysis/pile/mass_quantile.h"

namespace scree {
namespace {

// Height of the mean surface at a radius, linear between the middles of its rings.
double surface_at(const ReposeAngle& read, double radius) {
  const double at = radius / read.surface_step - 0.5;
  if (!(at >= 0 && at + 1 < static_cast<double>(read.surface.size())))
    return std::numeric_limits<double>::quiet_NaN();
  const auto k = static_cast<std::size_t>(at);
  const double t = at - static_cast<double>(k);
  return (1 - t) * read.surface[k] + t * read.surface[k + 1];
}

}  // namespace

HeapShape measure_heap_shape(const std::vector<Grain>& heap, const std::vector<Grain>& original,
                             const ReposeAngle& read, const Measurement& measured) {
  if (heap.empty()) throw std::invalid_argument("the heap has no grain");
  std::vector<NamedGrains> rings;
  for (int k = 0; k < kHeapRings; ++k)
    rings.push_back({fmt::format("ring{}", k + 1), (2.0 * k + 1) / (2.0 * kHeapRings), {}});
  std::vector<WeighedValue> distances;
  double mass = 0, outside = 0, volume = 0;
  for (const Grain& grain : heap) {
    const double r = std::hypot(grain.position.x() - read.axis[0], grain.position.y() - read.axis[1]);
    distances.push_back({r, grain.mass});
    mass += grain.mass;
    volume += std::numbers::pi / 6 * grain.diameter * grain.diameter * grain.diameter;
    const double step = r / read.radius * kHeapRings;
    if (step < kHeapRings)
      rings[static_cast<std::size_t>(std::clamp(step - measured.border_shift, 0.0, kHeapRings - 1.0))]
          .grains.push_back(&grain);
    else
      outside += grain.mass;
  }
  HeapShape shape;
  shape.spread_95 = mass_quantile(std::move(distances), 0.95) / std::cbrt(volume);
  if (std::isfinite(read.radius)) {
    shape.rings = tabulate(rings, original, measured);
    shape.rings.mass_outside = outside;
  }
  for (std::size_t k = 0; k < kHeapRings; ++k) {
    shape.mass_share[k] = of_ring(shape, k, [](const Section& ring) { return ring.mass; }) / mass;
    shape.profile[k] = surface_at(read, kProfilePlaces[k] * read.radius) / read.height;
  }
  return shape;
}

double of_ring(const HeapShape& heap, std::size_t k, const std::function<double(const Section&)>& value) {
  return k < heap.rings.sections.size() ? value(heap.rings.sections[k])
                                        : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace scree
