#pragma once
// Virtual photographs: a scene of spheres as a picture, and the truth about every grain that can be seen.
#include <cstdint>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "analysis/image/rock_scene.h"

namespace scree {

/// Camera, light and rock of a virtual photograph.
struct PhotoSettings {
  double m_per_px = 0.012;        ///< of the thesis's pictures
  double sun_azimuth_deg = 135;   ///< where the light comes from: 0 the right of the picture, 90 its top
  double sun_elevation_deg = 45;  ///< above the plane of the picture
  double ambient = 0.3;           ///< share of the light that reaches shadows too
  double rock_albedo = 0.55;      ///< mean; grains differ by a fifth of it
  double ground_albedo = 0.18;
  double texture = 0.15;         ///< deviation of brightness within a grain, share of its own
  double blur_px = 0.8;          ///< standard deviation of the lens's blur
  double noise = 0.01;           ///< standard deviation, share of white
  double target_diameter = 0.5;  ///< m, of the magenta disc; 0: none
  std::uint64_t seed = 1;        ///< of texture and noise
};

/// A grain of which something can be seen.
struct VisibleGrain {
  std::int64_t id = 0;
  double x = 0, y = 0;                  ///< px, middle of what is seen of it
  double diameter = 0;                  ///< m
  double mass = 0;                      ///< kg
  double visible_area = 0;              ///< m2
  double visible_share = 0;             ///< of its outline
  double visible_a = 0, visible_b = 0;  ///< axes of the ellipse fitted to what is seen of it (GrainShape), m
};

/// What a virtual photograph shows.
struct PhotoTruth {
  double m_per_px = 0;
  double scene_d50 = 0;              ///< m, by mass of all grains of the scene, seen or not
  std::string region;                ///< of a pile: its slope, as `scree image --region` takes it; or empty
  std::vector<VisibleGrain> grains;  ///< by rising id
};

struct Photo {
  cv::Mat picture;  ///< 8 bit, three channels
  PhotoTruth truth;
};

/// Renders by a height buffer: the highest sphere of each pixel, Lambert's law, shadows by marching over the
/// buffer towards the sun, gamma 2.2. The same arguments give the same picture. Throws std::invalid_argument
/// for more pixels than kLargestPicture (picture_file.h), or none.
Photo render_photo(const RockScene& scene, const PhotoSettings& settings);

/// The truth as CSV: `id,x_px,y_px,diameter_m,mass_kg,visible_cm2,visible_share,visible_a_m,visible_b_m`, and
/// in comment lines `# m_per_px = ...`, `# scene_d50_m = ...`, and `# region = ...` where there is one.
std::string truth_csv(const PhotoTruth& truth);
/// Reads it. Throws FileError.
PhotoTruth read_truth(const std::filesystem::path& file);

}  // namespace scree
