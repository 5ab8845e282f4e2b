#pragma once
// Surface of a pile along its dumping direction.
#include <array>
#include <optional>
#include <vector>

#include "analysis/pile/vertical_section.h"
#include "sim/io/snapshot.h"

namespace scree {

/// Height of the surface (m) along x, in a band about the y that halves the mass: of each twentieth of
/// `height`, the crest's above the floor, or of a tenth of the largest grain if that is more, the height that
/// half of the band reaches (SurfaceHeight). The band is a fifth of `height` wide on either side, at most
/// 4 m, at least three radii of the largest grain: a block alone does not make a surface. Places where rock
/// covers less than half of the band are left out. Each row is x, z. Throws std::invalid_argument unless
/// height > 0.
std::vector<std::array<double, 2>> slope_profile(const std::vector<Grain>& pile, double height);

/// Between which shares of its height a slope is fitted.
inline constexpr double kSlopeLow = 0.15, kSlopeHigh = 0.85;

/// The straight line fitted to a slope.
struct SlopeLine {
  double angle = 0;     ///< degrees, positive where it falls along x
  double x = 0, z = 0;  ///< the middle of the places fitted, m; on the line
};

/// Of the places of a profile between kSlopeLow and kSlopeHigh of `height`, from where it leaves the crest to
/// where it first ends or sinks below kSlopeLow: what has rolled on does not count. None with fewer than four
/// such places.
std::optional<SlopeLine> slope_line(const std::vector<std::array<double, 2>>& profile, double height);

/// How thick (m) rock of this profile lies on the face of a bench, normal to it: the mean over places on the
/// face between kSlopeLow and kSlopeHigh of the height. NaN without one.
double cover_on_face(const std::vector<std::array<double, 2>>& profile, const BenchOutline& bench);

}  // namespace scree
