#pragma once
// Surface of a pile along its dumping direction.
#include <array>
#include <optional>
#include <vector>

#include "sim/io/snapshot.h"

namespace scree {

/// Highest point of the grains (m) in bins of `bin` m along x, within `half_band` m of the axis y = 0; bins
/// without grains are left out. Each row is x, z.
std::vector<std::array<double, 2>> slope_profile(const std::vector<Grain>& pile, double half_band = 2.0,
                                                 double bin = 0.5);

/// Angle (degrees) of the straight line fitted to the profile between 15 % and 85 % of `height`; none with
/// fewer than four points there.
std::optional<double> slope_angle(const std::vector<std::array<double, 2>>& profile, double height);

}  // namespace scree
