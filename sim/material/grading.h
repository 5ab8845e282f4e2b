#pragma once
// Gradings (particle size distributions) and spheres that honour them.
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/material/material.h"

namespace scree {

/// A passing curve: share of the mass finer than a diameter, linear in log10(diameter) between points.
class Grading {
 public:
  struct Point {
    double diameter;  ///< m
    double passing;   ///< share of mass, 0 to 1
  };

  /// Points with strictly rising diameters and passing that does not fall, from 0 to 1; throws
  /// std::invalid_argument otherwise. Where passing stays the rock has a gap. Points that say
  /// nothing are left out: within a gap, and of passing 0 or 1 beyond the first at either end.
  Grading(std::string name, std::vector<Point> points);

  /// Passing share at a diameter (m).
  double passing(double diameter) const;
  /// Diameter (m) at a passing share in [0, 1]; the D_x of soil mechanics is diameter(x / 100).
  double diameter(double passing) const;
  double cu() const;  ///< Coefficient of uniformity D60 / D10.
  double cc() const;  ///< Coefficient of curvature D30^2 / (D10 D60).
  double min_diameter() const { return points_.front().diameter; }
  double max_diameter() const { return points_.back().diameter; }
  /// Mean over mass of log10(diameter in m).
  double mean_log_diameter() const;
  const std::string& name() const { return name_; }
  const std::vector<Point>& points() const { return points_; }

  /// The same curve with a `share` of the mass added below its smallest diameter, down to that over `ratio`,
  /// evenly in log d.
  Grading with_fines(double share, double ratio) const;
  /// The same curve without what lies outside [low, high] (m), rescaled to 0..1.
  Grading scalped(double low, double high) const;

 private:
  std::string name_;
  std::vector<Point> points_;
};

/// Reads a grading file: a table (input_text.h) with the columns `diameter_mm` (or `_cm`, `_m`) and
/// `passing_pct`, fine or coarse first, `#` comment lines (source, how it was rebuilt), at most 10,000 points
/// between 1 micrometre and 1 km. What is finer than `from` (m; a scenario's grading_from_m) is left out and
/// the rest counts as the whole; the curve need begin with passing 0 only if nothing is. Throws FileError:
/// what is wrong, what is allowed.
Grading read_grading(const std::filesystem::path& file, std::optional<double> from = {});

/// Mean of d^-power (m^-power) over the mass, exact for a curve linear in log d: between two points it is
/// (a^-power - b^-power) / (power ln(b/a)), and 1 for power 0.
double mean_inverse_power(const Grading& grading, double power);

/// Expected number of spheres of a mass (kg), and the volume of their rock (m3): the integrals of dP * mass
/// over the mass of a sphere, and over the density, at each diameter.
double expected_spheres(const Grading& grading, double mass, const RockDensity& density);
double solid_volume(const Grading& grading, double mass, const RockDensity& density);

/// Diameters (m), largest first, of spheres that together weigh `mass` (kg) within 0.5 % and whose passing
/// curve is within 2 points of the grading at every point of it, for any seed, as long as the mass allows it.
/// What is achievable: the error at a diameter is always below the share of the mass that one sphere of about
/// that diameter (in a gap: of its coarse end) has, so the bounds hold for certain from 50 spheres of the
/// largest size but one point (QB0: 225 t), and by choice among draws from about a third of that. Below, the
/// nearest of 200 draws is taken. `seed` and `dump` name the random stream. Throws std::invalid_argument when
/// mass or density is not positive, the mass is less than the smallest sphere, or more than 20 million
/// spheres would be needed.
std::vector<double> generate_diameters(const Grading& grading, double mass, const RockDensity& density,
                                       std::uint64_t seed, std::uint64_t dump);

}  // namespace scree
