#include "sim/effects/registry.h"

namespace scree {

Effect vibration() {
  return {
      .name = "vibration",
      .title = "ground that shakes",
      .doc = "Trucks, crushers and blasts shake the ground; a laboratory's platform is never still.",
      .equation =
          "Gravity is g (1 + acceleration sin(2 pi frequency t)) along the vertical during the whole run: "
          "the "
          "frame of a platform that shakes up and down. Rock does not sleep meanwhile, and may move until "
          "stop.max_time_s.",
      .source =
          "Jaeger, Nagel & Behringer, Rev. Mod. Phys. 68 (1996); Evesque & Rajchenbach, Phys. Rev. Lett. 62 "
          "(1989): piles flow when the acceleration passes gravity.",
      .parameters = {{.key = "acceleration_g",
                      .unit = "g",
                      .low = 0,
                      .high = 5,
                      .standard = 0.3,
                      .prior_low = 0,
                      .prior_high = 0.8,
                      .doc = "Largest acceleration of the ground over that of gravity."},
                     {.key = "frequency_hz",
                      .unit = "Hz",
                      .low = 0.1,
                      .high = 200,
                      .standard = 10,
                      .prior_low = 10,
                      .prior_high = 10,
                      .doc = "Of the swing."}},
      .absent = 0,
      .experiments = {},
      .apply =
          [](std::span<const double> v, const EffectContext&, Modifications& model) {
            model.vibration = {v[0], v[1]};
          },
  };
}

}  // namespace scree
