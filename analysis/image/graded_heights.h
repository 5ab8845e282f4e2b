#pragma once
// Where down a picture grains lie that is to be coarser at its foot.
#include <vector>

#include "analysis/image/rock_scene.h"

namespace scree {

/// A height in the picture, m down from its top, and how far about it a grain keeps to its band.
struct GradedHeight {
  double wanted = 0, low = 0, high = 0;
};

/// Heights of the grains' middles. Mass of which a share p of the grading is finer lies at a share t of the
/// height with the density 1 + segregation (2p - 1)(2t - 1) (Farlie, Biometrika 47 (1960) 307), so that the
/// mean of log d changes evenly from top to foot. Few grains hold much of the mass: each is laid so that
/// twelve bands of the picture keep to that density in what has been laid, in mass and in mean log d, which
/// holds in one picture what draws independent of each other hold in many. `diameters`: m, largest first.
std::vector<GradedHeight> graded_heights(const std::vector<double>& diameters, const Grading& grading,
                                         const SceneSettings& settings);

}  // namespace scree
