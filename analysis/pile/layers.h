#pragma once
// Stratification: the layers that successive dumps leave along a slope.
#include <vector>

#include "analysis/pile/vertical_section.h"
#include "sim/io/snapshot.h"

namespace scree {

/// The rock of one dump along the middle of the slope. NaN where it has too few grains.
struct Layer {
  int dump = 0;
  int grains = 0;    ///< along the middle of the slope
  double mass = 0;   ///< kg, of these
  double thickness;  ///< m normal to the slope: volume of the rock over area of slope and 1 - porosity, mean
                     ///< over the stretches that it covers
  double chi;        ///< segregation degree, see tabulate()
  double chi_lower, chi_upper;  ///< of its half next to the ground and of its half next to the surface
  /// chi_lower - chi_upper. Above 0: the layer coarsens towards its bottom (normal grading of the
  /// sedimentologists); below 0: towards its top (their inverse grading, as sieving in a flow leaves it).
  double coarsening_down;
};

/// Layers of a pile and how much of the scatter of grain sizes they account for.
struct Layers {
  double slope_deg = 0;         ///< of the pile's surface, to which thickness is normal
  std::vector<Layer> layers;    ///< by rising dump number
  double mean_coarsening_down;  ///< by mass of the layers that have it; NaN without one
  /// Share (0 to 1) of the variance of log10 d, by mass and about the mean of each stretch of the slope, that
  /// lies between the means of the layers; the rest lies within layers. NaN without any scatter.
  double variance_between;
  /// The same share where the dumps are dealt to the grains of each stretch by chance, as many grains to each
  /// as it has (mean of 20 deals, the same in every call). A few blocks carry most of the mass, so it is far
  /// from 0: layers differ by what variance_between is above it.
  double variance_by_chance;
};

/// Layers between one and five sixths of the slope's length, within the band of `section`; the slope is cut
/// along its surface into stretches of one cell, so that the coarsening from crest to toe does not count as
/// layering. In each stretch a dump's rock is halved by the plane along the slope that has half of its mass
/// on either side; a grain across it counts in both halves with its parts, so one block as thick as the layer
/// is no grading. The slope is that of the pile's profile (slope_line()), the bench's where the profile is
/// too short. A dump covers a stretch when it has at least `fewest_grains` centres there; thickness and
/// halves are of these, mass and chi of all its rock. `original`: every grain as dumped; `porosity` of the
/// pile, for example Inside::mean_porosity.
///
/// Throws std::invalid_argument without a bench in the section, for a section that check() refuses, a
/// porosity outside 0 to 1 (1 excluded), an empty original or fewest_grains below 2.
Layers analyse_layers(const std::vector<Grain>& pile, const std::vector<Grain>& original,
                      const VerticalSection& section, double porosity, int fewest_grains = 4);

}  // namespace scree
