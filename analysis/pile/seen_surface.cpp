#include "analysis/pile/seen_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace scree {
namespace {

constexpr double kLinesAcross = 3;  // the smallest grain
constexpr double kMostLines = 8e6;

/// Lines of sight on a lattice, and the lattice points from a low to a high coordinate.
struct Lines {
  double origin, pitch;
  long count;
  double at(long i) const { return origin + (static_cast<double>(i) + 0.5) * pitch; }
  long first(double low) const { return std::max(0L, std::lround(std::ceil((low - origin) / pitch - 0.5))); }
  long last(double high) const {
    return std::min(count - 1, std::lround(std::floor((high - origin) / pitch - 0.5)));
  }
};

}  // namespace

std::vector<double> seen_shares(const std::vector<Grain>& pile, double angle_deg) {
  if (!(angle_deg >= 0 && angle_deg < 90))
    throw std::invalid_argument("a slope's angle must be from 0 to 90 degrees");
  if (pile.empty()) return {};
  const double slope = angle_deg * std::numbers::pi / 180;
  const Vec3 down(std::cos(slope), 0, -std::sin(slope)), out(std::sin(slope), 0, std::cos(slope));
  constexpr double kAll = std::numeric_limits<double>::max();
  double smallest = kAll, low[2] = {kAll, kAll}, high[2] = {-kAll, -kAll};
  for (const Grain& grain : pile) {
    const double r = 0.5 * grain.diameter, along[2] = {grain.position.dot(down), grain.position.y()};
    smallest = std::min(smallest, grain.diameter);
    for (int k = 0; k < 2; ++k)
      low[k] = std::min(low[k], along[k] - r), high[k] = std::max(high[k], along[k] + r);
  }
  const double pitch =
      std::max(smallest / kLinesAcross, std::sqrt((high[0] - low[0]) * (high[1] - low[1]) / kMostLines));
  const auto lines = [&](int k) {
    return Lines{low[k], pitch, std::lround(std::ceil((high[k] - low[k]) / pitch))};
  };
  const Lines u = lines(0), v = lines(1);
  constexpr int kNobody = -1;
  std::vector<int> seen(static_cast<std::size_t>(u.count * v.count), kNobody);
  std::vector<double> top(seen.size(), -std::numeric_limits<double>::infinity());
  std::vector<double> shares(pile.size(), 0);
  std::vector<long> lines_met(pile.size(), 0);
  for (std::size_t g = 0; g < pile.size(); ++g) {
    const double r = 0.5 * pile[g].diameter, x = pile[g].position.dot(down), y = pile[g].position.y(),
                 z = pile[g].position.dot(out);
    for (long i = u.first(x - r); i <= u.last(x + r); ++i)
      for (long j = v.first(y - r); j <= v.last(y + r); ++j) {
        const double off = std::pow(u.at(i) - x, 2) + std::pow(v.at(j) - y, 2);
        if (off > r * r) continue;
        ++lines_met[g];
        const auto here = static_cast<std::size_t>(i * v.count + j);
        const double height = z + std::sqrt(r * r - off);
        if (height <= top[here]) continue;
        top[here] = height;
        seen[here] = static_cast<int>(g);
      }
  }
  for (const int g : seen)
    if (g != kNobody) ++shares[static_cast<std::size_t>(g)];
  for (std::size_t g = 0; g < pile.size(); ++g)
    if (lines_met[g] > 0) shares[g] /= static_cast<double>(lines_met[g]);
  return shares;
}

}  // namespace scree
