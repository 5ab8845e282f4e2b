#pragma once
// Prescribed motion of a mesh body.
#include <vector>

#include "sim/material/vector.h"

namespace scree {

/// Pose and velocity of a body at one time.
struct BodyState {
  Pose pose;
  Vec3 velocity = Vec3::Zero();  ///< of the body's origin, m/s
  Vec3 spin = Vec3::Zero();      ///< rad/s, world axes
  Vec3 velocity_at(const Vec3& point) const { return velocity + spin.cross(point - pose.position); }
};

/// Poses at times; linear in position and spherical-linear in rotation between them, held outside. Velocity
/// is the exact derivative of the pose, so that contacts drag what the body carries.
class Motion {
 public:
  struct Key {
    double time;  ///< s
    Pose pose;
  };
  Motion() : Motion({{0.0, Pose{}}}) {}
  /// At least one key, times strictly rising.
  explicit Motion(std::vector<Key> keys);
  static Motion fixed(const Pose& pose) { return Motion({{0.0, pose}}); }
  BodyState at(double time) const;
  bool moves() const { return keys_.size() > 1; }
  double last_time() const { return keys_.back().time; }

 private:
  std::vector<Key> keys_;
};

}  // namespace scree
