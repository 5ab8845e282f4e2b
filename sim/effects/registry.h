#pragma once
// The effects, one line each; each is described in the file of its name.
#include "sim/effects/effect.h"

namespace scree {

Effect cohesion();
Effect restitution();
Effect rolling_by_size();
Effect friction_by_size();
Effect twisting();
Effect weakening();
Effect ground_friction();
Effect sticky_tools();
Effect undamped_flight();
Effect density_by_size();
Effect missing_fines();
Effect release_speed();
Effect breakage();
Effect clumps();
Effect vibration();
Effect detection_limit();
Effect image_blur();
Effect image_shape_bias();
Effect section_borders();
Effect surface_only();
Effect own_reference();

}  // namespace scree
