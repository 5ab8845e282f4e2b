#pragma once
// Segregation across a slope: how much a section differs from place to place along the crest.
#include <string>
#include <vector>

#include "analysis/pile/segregation.h"

namespace scree {

/// One section of a slope, cut into strips across it.
struct LateralSection {
  std::string name;                        ///< S1 at the crest
  std::vector<double> y;                   ///< middles of its strips, m
  std::vector<double> chi, d50_rel, mass;  ///< of each strip; mass in kg
  double chi_std = 0, chi_range = 0;       ///< over strips; NaN with fewer than two
  double d50_rel_std = 0;                  ///< over strips; NaN with fewer than two
};

/// A slope, strip by strip.
struct Lateral {
  double strip_width = 0;  ///< m
  std::vector<LateralSection> sections;
  /// Width (m) at the toe of what the first dump point brought: between the 2.5 and 97.5 % quantiles by mass
  /// of y in the lowest section; NaN without such rock.
  double point1_toe_width = 0;
};

/// Least number of grains in a strip that counts.
inline constexpr std::size_t kLeastStripGrains = 20;

/// Cuts each of the `n` sections of a slope (slice_of) into strips of `strip_width` m, the middle one around
/// y = 0. `points`: number of dump points, visited in turn from the first. Throws std::invalid_argument for a
/// width of 0, no section, no point or no original.
Lateral analyse_lateral(const std::vector<Grain>& pile, const std::vector<Grain>& original,
                        double crest_height, int n, int points, double strip_width = 4,
                        const Measurement& measured = {});

}  // namespace scree
