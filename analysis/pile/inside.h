#pragma once
// The inside of a pile: porosity, grading, segregation and conductivity of cells of a vertical section.
#include <optional>
#include <vector>

#include "analysis/pile/vertical_section.h"
#include "sim/io/snapshot.h"

namespace scree {

/// Where a cell lies in the pile.
enum class CellPlace {
  empty,     ///< no rock in it
  ground,    ///< bench, floor or fixed balls take a part of its box
  surface,   ///< its box reaches out of the pile
  interior,  ///< its whole box lies inside the pile: only here porosity means something
};

/// One cell: the box of the section's cell size in x and z, the band's width in y. A grain across a wall
/// counts with the part of its volume, and so of its mass, that lies inside. NaN stands where a number has no
/// meaning: gradings of cells with too few grains, porosity and conductivity outside the interior.
struct InsideCell {
  CellPlace place = CellPlace::empty;
  int grains = 0;           ///< that reach into the box
  double mass = 0;          ///< kg
  double solid_volume = 0;  ///< m3 of grains; where soft grains overlap, both count, as the rock is there
  double porosity;          ///< 1 - solid volume / box; below 0 where overlaps are larger than the voids
  double chi;               ///< segregation degree, see tabulate()
  double d10, d50, cu;      ///< m, m, D60 / D10
  double dump;              ///< mean dump number, by mass
  /// Conductivity over the original's by the modified Kozeny-Carman formula at equal void ratio: what the
  /// grading alone does. Given wherever the grading is.
  double ksat_grading;
  /// The same with the cell's own porosity, see Inside::original_void_ratio; NaN where overlaps leave no
  /// void.
  double ksat_kozeny_carman;
  double ksat_taylor;  ///< the same by Taylor's formula
};

/// A section through a pile. Cell (i, k) reaches from x0 + i cell to x0 + (i + 1) cell, and from z0 + k cell.
struct Inside {
  VerticalSection section;
  double x0 = 0, z0 = 0;  ///< corner of cell (0, 0), m
  int nx = 0, nz = 0;
  std::vector<InsideCell> cells;  ///< nx * nz, a row along x after the other

  double mean_porosity;        ///< of all interior cells together; NaN without one
  double original_void_ratio;  ///< the void ratio that conductivities are relative to; NaN when not known
  double mean_abs_chi;         ///< mean of |chi| by mass, over cells of all places that have it
  /// 90th over 10th percentile, over cells of equal weight: of ksat_grading over cells of all places that
  /// have it, of ksat_kozeny_carman over interior cells.
  double ksat_grading_contrast, ksat_contrast;

  const InsideCell& at(int i, int k) const;  ///< throws std::out_of_range
};

/// What analyse_inside() may be told besides.
struct InsideOptions {
  /// Cells with fewer grains, or with rock in less than a tenth of their box, have no grading.
  int fewest_grains = 5;
  /// Void ratio of the original material; by default that of the mean porosity inside, so ratios tell the
  /// effect of where the grain sizes went and of local looseness.
  std::optional<double> original_void_ratio;
};

/// Cells of the section through `pile` (moveable grains; `fixed` balls may be empty) against `original`
/// (every grain as dumped, diameters and masses).
///
/// A cell is in the ground when ground or fixed balls take more than 1 % of its box; otherwise at the surface
/// when rock stands up to its top over less than 95 % of its plan (looked at on a lattice of an eighth of the
/// cell; a grain closes the gaps between its neighbours and itself up to sqrt(2) of its radius at the height
/// of its centre). Solid volumes are sums of sphere_in_box().
///
/// Throws std::invalid_argument for a section that check() refuses, an empty original, fewest_grains below 1
/// or a void ratio not above 0. A pile without grains in the band gives no cells and NaN totals.
Inside analyse_inside(const std::vector<Grain>& pile, const std::vector<Grain>& fixed,
                      const std::vector<Grain>& original, const VerticalSection& section,
                      const InsideOptions& options = {});

}  // namespace scree
