#include "sim/world/energy_balance.h"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {
constexpr double kSmall = 1e-3;  // of weight times radius
}

double EnergyBalance::put_in() const {
  const EnergyAccount& a = account;
  double sum = 0;
  for (const double term : {a.came_moving, fall(), a.set_moving, a.tools, a.shaking, a.pressed, a.fragments})
    sum += std::max(term, 0.0);
  return sum;
}

double EnergyBalance::error() const {
  const EnergyAccount& a = account;
  return a.came_moving + fall() + a.set_moving + a.tools + a.shaking + a.pressed + a.fragments -
         (held.kinetic + held.elastic + held.pull) - a.losses.total() - a.put_to_sleep - a.lost_other;
}

double EnergyBalance::relative_error() const {
  const double scale = std::max(put_in(), kSmall * account.weight_times_radius);
  return error() == 0 ? 0.0 : error() / scale;
}

}  // namespace scree
