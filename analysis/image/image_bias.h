#pragma once
// What image analysis makes of known grains, as a function of size.
#include <optional>
#include <string>
#include <vector>

#include "analysis/image/photo_analysis.h"
#include "analysis/image/render_photo.h"

namespace scree {

/// Known grains of a class of sizes.
struct BiasClass {
  double low = 0, high = 0;  ///< m
  int visible = 0;           ///< grains of which something can be seen
  int detected = 0;          ///< those that an outline was found for
  double ratio = 0;          ///< measured over true diameter, geometric mean; NaN without any
  double deviation = 0;      ///< standard deviation of ln ratio; NaN with fewer than two
};

/// Measured against known grains, in the form of the effects detection_limit, image_blur and
/// image_shape_bias.
struct ImageBias {
  std::vector<BiasClass> classes;  ///< a factor of sqrt 2 wide each
  double reference = 0;            ///< D50 of the scene, m
  /// Share detected = 1 / (1 + (limit / d)^steepness), greatest likelihood; limit 0 m: every grain is
  /// detected; none: no known grain is, or it lies beyond the known diameters. Steepness is kept within 1
  /// to 50.
  std::optional<double> limit;
  double steepness = 6;
  double exponent = 0;  ///< slope of ln(measured / true) over ln d, least squares
  double width = 0;     ///< standard deviation of ln(measured / true) about that line
  int outlines = 0;     ///< found
  int matched = 0;      ///< of which belong to a known grain

  /// Enough for a line and a deviation about it.
  bool says_something() const { return matched >= 3; }
};

/// Known (true_gradings) and measured values side by side.
struct TruthCheck {
  std::vector<ImageGrading> known, measured;  ///< whole, then sections
  /// Of perfect outlines of what can be seen, by the size model (ellipses for Feret's). What remains against
  /// `known` is rock that lies on rock, which no analysis of a picture can tell.
  std::vector<ImageGrading> ideal;
  double scene_d50 = 0;  ///< m, of all grains, hidden ones too

  /// Mass measured over that of the known grains.
  double mass_seen() const { return measured[0].mass / known[0].mass; }
};

/// How masses are meant that are not those of spheres, which virtual rock is: " (bodies of c/b = 0.53)".
std::string bodies_in_words(const PhotoAnalysisSettings& settings);

/// Grains found in one picture and its truth. A known grain belongs to the outline that has the middle of
/// what is seen of it; where an outline has several, the one of which most is seen. Those that do not lie
/// wholly within the region are left out, detected or not, and those whose outline its border cuts: others
/// count for them.
struct CheckedPhoto {
  const PhotoAnalysis* found;
  const PhotoTruth* truth;
};
ImageBias measure_bias(const std::vector<CheckedPhoto>& photos, SizeModel model);

/// What size has to do with detection, as a sentence without its stop.
std::string detection_in_words(const ImageBias& bias);

/// Gradings of the grains of which more than the detection limit can be seen, by their true diameters and
/// masses: the whole region, then its sections. A grain belongs to the region that has the middle of what is
/// seen of it.
std::vector<ImageGrading> true_gradings(const PhotoTruth& truth, const PhotoRegion& region,
                                        const PhotoAnalysisSettings& settings);

TruthCheck check_against_truth(const PhotoAnalysis& found, const PhotoTruth& truth,
                               const PhotoAnalysisSettings& settings);

}  // namespace scree
