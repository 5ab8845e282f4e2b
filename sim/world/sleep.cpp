#include "sim/world/sleep.h"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr double kWindow = 3.0;         // times sqrt(smallest radius / g)
constexpr double kQuietTravel = 0.005;  // of the radius, in one window
constexpr double kQuietPull = 0.1;      // of the weight
constexpr double kWake = 0.1;           // of (weight + mean contact force)
constexpr int kQuietWindows = 2;

// Square of the change of a contact force that wakes sphere i (N^2).
double wake_limit2(int i, const Spheres& s, const PairList& pairs, const ContactLaw& law, double gravity) {
  double sum = 0;
  int contacts = 0;
  const auto add = [&](int p, int a, int b) {
    if (!pairs.touching[p]) return;
    const double overlap = s.place[a].w + s.place[b].w - (s.place[a].vec() - s.place[b].vec()).norm();
    sum += ball_ball(law, s.place[a].w, s.place[b].w).kn * std::max(overlap, 0.0);
    ++contacts;
  };
  for (int p = pairs.begin(i); p < pairs.end(i); ++p) add(p, i, pairs.partner(p));
  for (int k = pairs.incoming_begin[i]; k < pairs.incoming_begin[i + 1]; ++k)
    add(pairs.incoming_pair[k], pairs.owner(pairs.incoming_pair[k]), i);
  const double limit = kWake * (s.velocity[i].w * gravity + (contacts > 0 ? sum / contacts : 0.0));
  return limit * limit;
}

}  // namespace

void Sleep::renumber(const std::vector<int>& order, Spheres& s, PairList& pairs,
                     const std::vector<std::uint8_t>& awake, double time, double gravity) {
  const int n = s.movable;
  double smallest = 1e300;
  for (int i = 0; i < n; ++i) smallest = std::min(smallest, s.place[i].w);
  window_ = gravity > 0 && n > 0 ? kWindow * std::sqrt(smallest / gravity) : 1e300;
  if (window_start_.empty()) window_end_ = time + window_;

  const int known = static_cast<int>(window_start_.size());
  std::vector<Vec3> start(n);
  std::vector<std::uint8_t> quiet(n, 0);
  std::vector<double> tolerance2(n, 0.0);
  asleep_ = 0;
  for (int i = 0; i < n; ++i) {
    const int old = order[i];
    start[i] = old < known ? window_start_[old] : s.place[i].vec();
    if (old < known) quiet[i] = quiet_windows_[old], tolerance2[i] = tolerance2_[old];
    if (!s.asleep[i]) continue;
    if (awake[i]) {
      s.asleep[i] = 0;
      quiet[i] = 0;
      forget_rest(i, pairs);
    } else {
      ++asleep_;
    }
  }
  window_start_.swap(start);
  quiet_windows_.swap(quiet);
  tolerance2_.swap(tolerance2);
  disturbed_.assign(n, 0);
  any_disturbed_ = false;
  row_active_.assign(s.size(), 1);
  mark_rows(s, pairs);
}

void Sleep::mark_rows(const Spheres& s, const PairList& pairs) {
  if (!on_) return;
  for (int i = 0; i < s.movable; ++i) {
    bool active = !s.asleep[i];
    for (int p = pairs.begin(i); !active && p < pairs.end(i); ++p) {
      const int j = pairs.partner(p);
      active = j < s.movable && !s.asleep[j];
    }
    row_active_[i] = active ? 1 : 0;
  }
}

void Sleep::forget_rest(int i, PairList& pairs) {
  for (int p = pairs.begin(i); p < pairs.end(i); ++p) pairs.rest_known[p] = 0;
  for (int k = pairs.incoming_begin[i]; k < pairs.incoming_begin[i + 1]; ++k)
    pairs.rest_known[pairs.incoming_pair[k]] = 0;
}

void Sleep::look(Spheres& s, PairList& pairs, const std::vector<std::uint8_t>& awake, const ContactLaw& law,
                 double time, const Vec3& gravity) {
  if (!on_ || time < window_end_) return;
  window_end_ = time + window_;
  const double g = gravity.norm();
  bool any = false;
  for (int i = 0; i < s.movable; ++i) {
    if (s.lost[i] || s.asleep[i]) continue;
    const Vec3 x = s.place[i].vec();
    const double radius = s.place[i].w, weight = s.velocity[i].w * g;
    const double travel = (x - window_start_[i]).norm();
    window_start_[i] = x;
    const double pull = (s.force[i].vec() + s.velocity[i].w * gravity).norm();
    const bool quiet = !awake[i] && s.force[i].w > 0 && travel < kQuietTravel * radius &&
                       pull < kQuietPull * weight &&
                       s.velocity[i].vec().norm() * window_ < 2.0 * kQuietTravel * radius;
    quiet_windows_[i] = quiet ? static_cast<std::uint8_t>(quiet_windows_[i] + 1) : std::uint8_t{0};
    if (quiet_windows_[i] < kQuietWindows) continue;

    tolerance2_[i] = wake_limit2(i, s, pairs, law, g);
    s.asleep[i] = 1;
    s.velocity[i].set(Vec3::Zero());
    s.spin[i].set(Vec3::Zero());
    forget_rest(i, pairs);
    ++asleep_;
    any = true;
  }
  if (any) mark_rows(s, pairs);
}

void Sleep::wake(int i, Spheres& s, PairList& pairs) {
  s.asleep[i] = 0;
  quiet_windows_[i] = 0;
  window_start_[i] = s.place[i].vec();
  forget_rest(i, pairs);
  row_active_[i] = 1;
  for (int k = pairs.incoming_begin[i]; k < pairs.incoming_begin[i + 1]; ++k)
    row_active_[pairs.owner(pairs.incoming_pair[k])] = 1;
  --asleep_;
}

void Sleep::wake_disturbed(Spheres& s, PairList& pairs) {
  if (!any_disturbed_) return;
  any_disturbed_ = false;
  for (int i = 0; i < s.movable; ++i)
    if (disturbed_[i]) {
      disturbed_[i] = 0;
      if (s.asleep[i]) wake(i, s, pairs);
    }
}

}  // namespace scree
