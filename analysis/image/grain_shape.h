#pragma once
// Size and shape of one region of a picture.
#include <opencv2/core.hpp>
#include <string>

namespace scree {

/// Measured in pixels. Descriptors are those of the thesis's table 2.2 by their usual definitions (Cox, J.
/// Paleontology 1 (1927) 179; Ferreira & Rasband, ImageJ user guide, section 30.7).
struct GrainShape {
  double x = 0, y = 0;   ///< centre of area
  double area = 0;       ///< px2
  double perimeter = 0;  ///< by Crofton's formula over four directions, as a pixel staircase is too long
  double major = 0, minor = 0;  ///< axes of the ellipse of equal second moments, scaled to equal area
  double angle_deg = 0;         ///< of the major axis, anticlockwise from the picture's x axis, 0 to 180
  double feret_max = 0;         ///< largest distance of parallel tangents
  double feret_min = 0;         ///< smallest one: the width that a slot must have
  double equal_area_diameter() const;
  double circularity() const;  ///< 4 pi area / perimeter^2; 1 for a disc
  double elongation() const;   ///< minor / major; 1 for a disc
  double roundness() const;    ///< 4 area / (pi feret_max^2); 1 for a disc
};

/// Shape of the pixels of a mask that are not 0; the mask may be a cut-out. At least one pixel.
GrainShape shape_of(const cv::Mat1b& region);

}  // namespace scree
