#include "analysis/image/graded_heights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/material/random.h"

namespace scree {
namespace {

constexpr int kBands = 12;  // whole numbers of them are two, three, four and six sections
constexpr double kBorder =
    0.02;                  // share of a band at either side where no middle lies: it may be seen beyond
constexpr int kDraws = 8;  // of a height, the best of which is taken

// Share of the mass above a share t of the height, where the density is 1 + a (2t - 1); and its inverse.
double share_above(double t, double a) {
  return t + a * (t * t - t);
}
double share_at(double above, double a) {
  if (std::abs(a) < 1e-9) return above;
  return (a - 1 + std::sqrt((1 - a) * (1 - a) + 4 * a * above)) / (2 * a);
}

// What a band has above its due, in shares of all mass.
struct Excess {
  double mass = 0;
  double log = 0;  // mass times (log d - mean) / deviation
};

}  // namespace

std::vector<GradedHeight> graded_heights(const std::vector<double>& diameters, const Grading& grading,
                                         const SceneSettings& settings) {
  double total = 0, mean = 0, variance = 0;
  for (const double d : diameters) total += d * d * d;
  for (const double d : diameters) mean += d * d * d / total * std::log(d);
  for (const double d : diameters) variance += d * d * d / total * std::pow(std::log(d) - mean, 2);
  const double deviation = variance > 0 ? std::sqrt(variance) : 1;

  const double band = settings.height / kBands;
  Random random(settings.seed, 4, RandomPurpose::picture);
  std::array<Excess, kBands> bands;
  std::vector<GradedHeight> heights;
  for (const double d : diameters) {
    const double mass = d * d * d / total, log = (std::log(d) - mean) / deviation;
    const double a = settings.segregation * (2 * grading.passing(d) - 1);
    for (int b = 0; b < kBands; ++b) {
      const double due =
          mass * (share_above((b + 1.0) / kBands, a) - share_above(static_cast<double>(b) / kBands, a));
      bands[b].mass -= due;
      bands[b].log -= due * log;
    }
    double least = 0;
    int best = -1;
    GradedHeight height;
    for (int draw = 0; draw < kDraws; ++draw) {
      const double at = d / 2 + share_at(random.uniform(), a) * (settings.height - d);
      const int b = std::clamp(static_cast<int>(at / band), 0, kBands - 1);
      // What the sum of the squares of all excess grows by, but for what is the same in every band.
      const double growth = bands[b].mass + log * bands[b].log;
      if (best >= 0 && growth >= least) continue;
      best = b, least = growth;
      height.low = (b + kBorder) * band, height.high = (b + 1 - kBorder) * band;
      height.wanted = std::clamp(at, height.low, height.high);
    }
    bands[best].mass += mass;
    bands[best].log += mass * log;
    heights.push_back(height);
  }
  return heights;
}

}  // namespace scree
