// The mass behind a cut changes where a grain's middle comes in or falls out, and as the cut moves on it only
// falls until the next one comes in: the heaviest cut begins at the middle of a grain.
#include "analysis/pile/heaviest_cut.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {
namespace {

constexpr double kAsMuch = 0.98;

}  // namespace

bool in_cut(const Grain& grain, double cut, double depth) {
  return grain.position.y() >= cut && grain.position.y() <= cut + depth;
}

double heaviest_cut(std::vector<Grain> grains, double depth) {
  std::sort(grains.begin(), grains.end(),
            [](const Grain& a, const Grain& b) { return a.position.y() < b.position.y(); });
  std::vector<double> shown;  // kg, by the cut that begins at each grain
  double mass = 0;
  for (std::size_t first = 0, end = 0; first < grains.size(); ++first) {
    for (; end < grains.size() && in_cut(grains[end], grains[first].position.y(), depth); ++end)
      mass += grains[end].mass;
    shown.push_back(mass);
    mass -= grains[first].mass;
  }
  const double most = *std::max_element(shown.begin(), shown.end());
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < grains.size(); ++k)
    if (const double cut = grains[k].position.y();
        shown[k] >= kAsMuch * most && std::abs(cut) < std::abs(best))
      best = cut;
  return best;
}

}  // namespace scree
