#pragma once
// The settings of Bullet's solver that give the repose angles of rrlinear.
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// A table over mu, mu_r and local damping of rrlinear, linear in between: assets/impulse/equivalent.csv,
/// made by `scree calibrate` (docs/calibration.md).
class Equivalence {
 public:
  struct Settings {
    double friction = 0;  ///< Bullet's friction coefficient
    double rolling = 0;   ///< Bullet's rolling friction over the effective radius
    /// Largest difference of the repose angles at the nodes around, degrees; none when set by hand.
    std::optional<double> error_deg;
  };

  /// Reads CSV, `#` comment lines, header `mu,mu_r,local_damping,friction,rolling,angle_rrlinear_deg,
  /// angle_impulse_deg`; the rows form a grid, `friction` and `rolling` are empty where Bullet cannot follow.
  /// Throws std::runtime_error, one line `file:line: what is wrong`.
  static Equivalence read(const std::filesystem::path& file);

  /// None outside of the grid, and beside a node where Bullet cannot follow.
  std::optional<Settings> at(double mu, double mu_r, double local_damping) const;

  /// "mu 0.1 to 0.4, mu_r 0.1 to 0.4, local_damping 0.4".
  std::string range() const;

 private:
  std::array<std::vector<double>, 3> axes_;     // mu, mu_r, local damping, rising
  std::vector<std::optional<Settings>> nodes_;  // the last axis fastest
};

}  // namespace scree
