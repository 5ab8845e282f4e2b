#pragma once
// How a finished pile is measured, where that differs from the truth (analysis/pile/counted_grains.h). With
// the defaults grains are counted as they are.

namespace scree {

struct Measurement {
  /// Of the mass of grains of diameter d the share 1 / (1 + (limit / d)^steepness) is seen; 0: all.
  double detection_limit = 0;      ///< m
  double detection_steepness = 6;  ///< the higher, the sharper
  double blur = 0;                 ///< standard deviation of the error of ln d
  /// A grain is seen with the diameter d (d / reference_diameter)^bias_exponent.
  double bias_exponent = 0;
  double reference_diameter = 1;  ///< m
  /// Borders between sections, rings and cells lie this share of a section's length too far down.
  double border_shift = 0;
  /// Share (0 to 1) of the surface (analysis/pile/seen_surface.h) in the grading of a slope's section.
  double surface_share = 0;
  /// Share (0 to 1) of the pile itself in the grading that its parts are compared with, beside the rock as
  /// dumped.
  double own_reference = 0;

  /// Grains that are measured through and through are counted as they are.
  bool exact() const { return detection_limit == 0 && blur == 0 && bias_exponent == 0; }
  /// The whole measurement is.
  bool truthful() const { return exact() && border_shift == 0 && surface_share == 0 && own_reference == 0; }
};

}  // namespace scree
