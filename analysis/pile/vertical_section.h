#pragma once
// A vertical section through a pile, and the ground below it.
#include <optional>

namespace scree {

/// Outline of a bench in the section: top at z = height for x < 0, crest at x = 0, a straight slope to the
/// toe, floor at z = 0.
struct BenchOutline {
  double height = 10;     ///< m
  double slope_deg = 45;  ///< initial slope

  double toe() const;             ///< x, m
  double ground(double x) const;  ///< z of top, slope or floor, m
};

/// The band |y - y0| <= half_width, cut into square cells of `cell` in x and z; cells begin at multiples of
/// their size.
struct VerticalSection {
  double y0 = 0;                      ///< m
  double half_width = 2;              ///< m
  double cell = 1;                    ///< m; several times the median diameter for numbers that mean a place
  std::optional<BenchOutline> bench;  ///< without it the pile lies on a floor at z = 0

  double ground(double x) const { return bench ? bench->ground(x) : 0.0; }  ///< m
};

/// Throws std::invalid_argument naming what is wrong: lengths must be above 0, a slope between 0 and 90
/// degrees.
void check(const BenchOutline& bench);
void check(const VerticalSection& section);

}  // namespace scree
