#pragma once
// Where the slope of a pile lies in a picture of it.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "analysis/image/rock_scene.h"

namespace scree {

/// The slope of a pile that was dumped towards +x, as a straight line from crest to toe.
struct PileSlope {
  double angle = 0;                 ///< degrees
  double crest_x = 0, crest_z = 0;  ///< m
  double toe_x = 0;                 ///< m; the floor is z = 0
};

/// The line fitted to its surface (slope_line()), from the crest's height to the floor. The height is
/// `bench_height` (m), as for a run; where that is not known, or gives no line, it is that of the pile's
/// surface at its highest. None where no slope falls towards +x.
std::optional<PileSlope> slope_of_pile(const std::vector<Grain>& pile, std::optional<double> bench_height);

/// Its corners in a picture of the scene (view_of_slope), px, as wide as the picture: top left and bottom
/// right. Heights of a run's sections, equal parts from the crest to the floor, are equal parts of it. None
/// where it is less than 10 pixels high.
std::optional<std::array<int, 4>> slope_region(const RockScene& scene, const PileSlope& slope,
                                               double m_per_px);

/// The same as an option of `scree image`: "x,y x,y".
std::string region_text(const std::array<int, 4>& corners);

}  // namespace scree
