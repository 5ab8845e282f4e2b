#include "sim/world/sleep.h"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr double kWindow = 3.0;         // times sqrt(smallest radius / g)
constexpr double kQuietTravel = 0.005;  // of the radius, in as many windows as make one of the sphere's own
constexpr double kQuietPull = 0.1;      // of the weight
constexpr double kQuietWindows = 2;     // of the sphere's own, 3 sqrt(radius / g)
constexpr double kMostWindows = 255;    // that are counted

double overlap_of(const Spheres& s, int i, int j) {
  return s.place[i].w + s.place[j].w - (s.place[i].vec() - s.place[j].vec()).norm();
}

// Square of the change of a contact force that wakes sphere i (N^2).
double wake_limit2(int i, const Spheres& s, const PairList& pairs, const ContactLaw& law, double gravity,
                   double tolerance) {
  double sum = 0;
  int contacts = 0;
  for (const Neighbour& n : pairs.neighbours(i)) {
    const double overlap = overlap_of(s, i, n.sphere);
    if (overlap <= 0) continue;
    sum += ball_ball(law, s.place[i].w, s.place[n.sphere].w).kn * overlap;
    ++contacts;
  }
  const double limit = tolerance * (s.velocity[i].w * gravity + (contacts > 0 ? sum / contacts : 0.0));
  return limit * limit;
}

}  // namespace

void Sleep::renumber(const std::vector<int>& order, Spheres& s, PairList& pairs,
                     const std::vector<std::uint8_t>& stay_awake, double time, double gravity) {
  const int n = s.movable;
  double smallest = 1e300;
  for (int i = 0; i < n; ++i) smallest = std::min(smallest, s.place[i].w);
  smallest_radius_ = smallest;
  window_ = gravity > 0 && n > 0 ? kWindow * std::sqrt(smallest / gravity) : 1e300;
  if (window_start_.empty()) window_end_ = time + window_;

  const int known = static_cast<int>(window_start_.size());
  std::vector<Vec3> start(n);
  std::vector<std::uint8_t> quiet(n, 0);
  std::vector<double> tolerance2(n, 0.0);
  asleep_ = 0;
  awake_.clear();
  for (int i = 0; i < n; ++i) {
    const int old = order[i];
    start[i] = old < known ? window_start_[old] : s.place[i].vec();
    if (old < known) quiet[i] = quiet_windows_[old], tolerance2[i] = tolerance2_[old];
    if (s.asleep[i] && stay_awake[i]) {
      s.asleep[i] = 0;
      quiet[i] = 0;
      forget_rest(i, s, pairs);
    }
    if (s.asleep[i])
      ++asleep_;
    else if (!s.lost[i])
      awake_.push_back(i);
  }
  window_start_.swap(start);
  quiet_windows_.swap(quiet);
  tolerance2_.swap(tolerance2);
}

void Sleep::lose(int i, Spheres& s) {
  if (i < static_cast<int>(quiet_windows_.size()) && s.asleep[i]) --asleep_;
  s.asleep[i] = 0;
  std::erase(awake_, i);
}

// A contact that is open now has a rest force of nothing; that of a closed one is learnt at the next step.
void Sleep::forget_rest(int i, const Spheres& s, PairList& pairs) {
  for (const Neighbour& n : pairs.neighbours(i)) {
    pairs.rest(n.memory()) = {0, 0, 0, overlap_of(s, i, n.sphere) > 0 ? 0 : 1};
  }
}

void Sleep::look(Spheres& s, std::span<const ForceSum> sums, PairList& pairs,
                 const std::vector<std::uint8_t>& stay_awake, const ContactLaw& law, double time,
                 const Vec3& gravity) {
  fallen_asleep_.clear();
  put_to_sleep_ = 0;
  if (!on_ || time < window_end_) return;
  window_end_ = time + window_;
  const double g = gravity.norm();
  const auto still = [&](int i) {
    const double travel = kQuietTravel * s.place[i].w / own_windows(s.place[i].w);
    return !stay_awake[i] && (s.place[i].vec() - window_start_[i]).norm() < travel &&
           s.velocity[i].vec().norm() * window_ < 2.0 * travel;
  };
  // A clump is quiet as a whole: its spheres hold each other.
  std::vector<std::uint8_t> quiet_ones(awake_.size());
  for (std::size_t a = 0; a < awake_.size(); ++a) {
    const int i = awake_[a], other = s.partner.empty() ? -1 : s.partner[i];
    Vec3 force = sums[i].force.vec();
    double contacts = sums[i].force.w, mass = s.velocity[i].w;
    if (other >= 0)
      force += sums[other].force.vec(), contacts += sums[other].force.w, mass += s.velocity[other].w;
    const double pull = (force + mass * gravity).norm();
    quiet_ones[a] = contacts > 0 && pull < kQuietPull * (mass * g) && still(i) && (other < 0 || still(other));
  }
  std::size_t kept = 0;
  for (std::size_t a = 0; a < awake_.size(); ++a) {
    const int i = awake_[a];
    const bool quiet = quiet_ones[a] != 0;
    window_start_[i] = s.place[i].vec();
    quiet_windows_[i] =
        quiet ? static_cast<std::uint8_t>(std::min(quiet_windows_[i] + 1, 255)) : std::uint8_t{0};
    if (quiet_windows_[i] < std::min(kQuietWindows * own_windows(s.place[i].w), kMostWindows)) {
      awake_[kept++] = i;
      continue;
    }
    tolerance2_[i] = wake_limit2(i, s, pairs, law, g, wake_tolerance_);
    s.asleep[i] = 1;
    put_to_sleep_ += s.kinetic_energy(i);
    s.velocity[i].set(Vec3::Zero());
    s.spin[i].set(Vec3::Zero());
    if (!s.angular.empty()) s.angular[i].set(Vec3::Zero());
    forget_rest(i, s, pairs);
    fallen_asleep_.push_back(i);
    ++asleep_;
  }
  awake_.resize(kept);
}

bool Sleep::wake(std::vector<int>& disturbed, Spheres& s, PairList& pairs) {
  if (!s.partner.empty())  // a clump wakes as one
    for (std::size_t k = 0, count = disturbed.size(); k < count; ++k)
      if (const int other = s.partner[disturbed[k]]; other >= 0) disturbed.push_back(other);
  std::sort(disturbed.begin(), disturbed.end());
  disturbed.erase(std::unique(disturbed.begin(), disturbed.end()), disturbed.end());
  std::erase_if(disturbed, [&](int i) { return !s.asleep[i]; });
  const auto before = static_cast<std::ptrdiff_t>(awake_.size());
  for (const int i : disturbed) {
    s.asleep[i] = 0;
    quiet_windows_[i] = 0;
    window_start_[i] = s.place[i].vec();
    forget_rest(i, s, pairs);
    awake_.push_back(i);
    --asleep_;
  }
  if (disturbed.empty()) return false;
  std::inplace_merge(awake_.begin(), awake_.begin() + before, awake_.end());
  return true;
}

}  // namespace scree
