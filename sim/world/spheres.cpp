#include "sim/world/spheres.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace scree {
namespace {

std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  v = (v | v << 2) & 0x1249249249249249ull;
  return v;
}

template <class T>
void permute(std::vector<T>& values, const std::vector<int>& order) {
  std::vector<T> sorted(values.size());
  for (std::size_t k = 0; k < order.size(); ++k) sorted[k] = values[order[k]];
  values.swap(sorted);
}

}  // namespace

std::vector<int> sort_spheres(Spheres& s, const std::vector<std::uint8_t>& fixed) {
  const int n = s.size();
  Vec3 low = Vec3::Constant(1e300);
  double smallest = 1e300;
  for (int i = 0; i < n; ++i) {
    if (s.lost[i]) continue;
    low = low.cwiseMin(s.place[i].vec());
    smallest = std::min(smallest, s.place[i].w);
  }
  std::vector<std::uint64_t> key(n);
  for (int i = 0; i < n; ++i) {
    if (s.lost[i]) {
      key[i] = ~std::uint64_t{0} >> 1;
    } else {
      const Vec3 cell = (s.place[i].vec() - low) / (4.0 * smallest);
      key[i] = spread_bits(static_cast<std::uint64_t>(cell.x())) |
               spread_bits(static_cast<std::uint64_t>(cell.y())) << 1 |
               spread_bits(static_cast<std::uint64_t>(cell.z())) << 2;
    }
    if (fixed[i]) key[i] |= std::uint64_t{1} << 63;
  }
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return key[a] != key[b] ? key[a] < key[b] : s.id[a] < s.id[b]; });
  permute(s.place, order);
  permute(s.velocity, order);
  permute(s.spin, order);
  permute(s.id, order);
  permute(s.dump, order);
  permute(s.lost, order);
  permute(s.asleep, order);
  if (!s.partner.empty()) {
    permute(s.partner, order);
    permute(s.angular, order);
    std::vector<std::int32_t> now(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) now[order[k]] = static_cast<std::int32_t>(k);
    for (std::int32_t& other : s.partner)
      if (other >= 0) other = now[other];
  }
  s.movable = static_cast<int>(std::count(fixed.begin(), fixed.end(), 0));
  return order;
}

}  // namespace scree
