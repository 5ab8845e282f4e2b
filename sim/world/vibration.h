#pragma once
// A platform that shakes: in its own frame gravity swings.
#include <cmath>
#include <numbers>

namespace scree {

/// Vertical, sinusoidal. Places and velocities are those seen from the platform.
struct Vibration {
  double amplitude = 0;   ///< acceleration over gravity
  double frequency = 10;  ///< Hz

  bool on() const { return amplitude != 0; }
  /// Gravity over its mean at a time (s): 1 + amplitude sin(2 pi frequency t).
  double factor(double time) const {
    return 1 + amplitude * std::sin(2 * std::numbers::pi * frequency * time);
  }
  /// Longest step (s) that follows the swing.
  double longest_step() const { return 0.02 / frequency; }
};

}  // namespace scree
