#include "sim/world/motion.h"

#include <algorithm>
#include <cassert>

namespace scree {

Motion::Motion(std::vector<Key> keys) : keys_(std::move(keys)) {
  assert(!keys_.empty());
  for (std::size_t k = 1; k < keys_.size(); ++k) assert(keys_[k].time > keys_[k - 1].time);
}

BodyState Motion::at(double time) const {
  BodyState state;
  if (time < keys_.front().time || keys_.size() == 1) {
    state.pose = keys_.front().pose;
    return state;
  }
  if (time >= keys_.back().time) {
    state.pose = keys_.back().pose;
    return state;
  }
  const auto next =
      std::upper_bound(keys_.begin(), keys_.end(), time, [](double t, const Key& k) { return t < k.time; });
  const Key &a = *(next - 1), &b = *next;
  const double span = b.time - a.time, share = (time - a.time) / span;
  state.pose.position = a.pose.position + share * (b.pose.position - a.pose.position);
  state.velocity = (b.pose.position - a.pose.position) / span;
  const Eigen::AngleAxisd turn(b.pose.rotation * a.pose.rotation.conjugate());
  state.pose.rotation = Quaternion(Eigen::AngleAxisd(share * turn.angle(), turn.axis())) * a.pose.rotation;
  state.spin = turn.axis() * (turn.angle() / span);
  return state;
}

}  // namespace scree
