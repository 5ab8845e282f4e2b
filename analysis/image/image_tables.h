#pragma once
// What photographs say, as CSV and as pictures.
#include <string>
#include <vector>

#include "analysis/image/image_bias.h"
#include "analysis/image/photo_analysis.h"

namespace scree {

/// A photograph and what was made of it.
struct AnalysedPhoto {
  std::string name;
  PhotoAnalysis found;
  std::vector<ImageGrading> gradings;  ///< of the chosen model; the whole region, then sections
};

/// A row a grain: `image,section,x_px,y_px,diameter_m,mass_kg` of the model, both axes, both Ferets, area and
/// descriptors, and `weight`.
std::string grains_csv(const std::vector<AnalysedPhoto>& photos, SizeModel model, double shape_factor);

/// A row a section, with the columns of the thesis's tables: `image,section,d100_cm,d95_cm ...
/// d10_cm,d0_cm,cu,cc, chi,grains,mass_kg,picture`; section 0 is the whole region. Empty sections have no
/// row.
std::string gradings_csv(const std::vector<AnalysedPhoto>& photos);

/// The same of all three models, `model` first.
std::string models_csv(const std::vector<AnalysedPhoto>& photos, int sections);

/// Passing curves at 24 diameters a decade of ten: `image,section,diameter_mm,passing_pct`.
std::string passing_csv(const std::vector<AnalysedPhoto>& photos);

/// `diameter_low_m,diameter_high_m,visible,detected,detected_share,size_ratio,ln_ratio_std`.
std::string bias_csv(const ImageBias& bias);

/// The picture with outlines of what was counted, borders of sections and targets, at most `longest_side`
/// pixels long.
cv::Mat3b overlay(const cv::Mat3b& picture, const PhotoAnalysis& found, int sections, int longest_side);

}  // namespace scree
