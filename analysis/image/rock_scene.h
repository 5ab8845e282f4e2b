#pragma once
// What a virtual photograph is taken of: spheres as a camera sees them, with known sizes.
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/io/snapshot.h"
#include "sim/material/grading.h"

namespace scree {

/// Spheres in the frame of a camera without perspective: x to the right, y down the picture, z towards the
/// camera, m; the picture's corner at the top left is the origin and the ground is at z = 0.
struct RockScene {
  double width = 0, height = 0;  ///< of what is seen, m
  std::vector<Grain> grains;
  std::vector<Grain> ground;  ///< spheres that belong to the ground: seen, not counted
  double slope_deg = 0;       ///< of a pile: the slope at right angles to which it is seen
  double origin_down = 0;     ///< of a pile: its origin, m down the picture
};

/// How grains of a made-up scene lie: each for itself; outline against outline; on top of one another.
enum class GrainLayout { apart, touching, overlapping };

struct SceneSettings {
  double width = 12, height = 9;  ///< m
  GrainLayout layout = GrainLayout::apart;
  double coverage = 0.35;    ///< area of all grains' outlines over that of the picture
  double segregation = 0;    ///< -1 to 1: how much coarser the foot is than the top, see graded_heights()
  double density = 2760;     ///< kg/m3
  double target_margin = 0;  ///< m: the square at the top right corner that stays free for a scale target
  std::uint64_t seed = 1;
};

/// That a scene's coverage is more than its grains find room for.
struct NoRoom : std::invalid_argument {
  NoRoom(const std::string& what, double laid) : invalid_argument(what), coverage(laid) {}
  double coverage;  ///< of those that found it
};

/// A scene whose grains follow a grading; all lie wholly within the picture. Throws std::invalid_argument if
/// the largest grain does not fit, NoRoom if the coverage cannot be reached.
RockScene make_scene(const Grading& grading, const SceneSettings& settings);

/// The same where settings.coverage is what is wished: as long as the grains find no room it is lowered to
/// that of those which did, in hundredths. Throws as make_scene; NoRoom where a hundredth is too much.
RockScene make_scene_with_room(const Grading& grading, SceneSettings& settings);

/// A pile seen at right angles to its slope. `slope_deg`: of the slope, falling towards +x. Grains and ground
/// are turned into the camera's frame, the crest at the top; the picture ends where the rock does, with
/// `margin` (m) around it. Throws std::invalid_argument without grains.
RockScene view_of_slope(const std::vector<Grain>& pile, const std::vector<Grain>& ground, double slope_deg,
                        double margin);

}  // namespace scree
