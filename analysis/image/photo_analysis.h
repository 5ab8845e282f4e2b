#pragma once
// A photograph of a slope as grains, and grains as gradings of its sections.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "analysis/image/foreground.h"
#include "analysis/image/grain_size.h"
#include "analysis/image/grain_split.h"
#include "analysis/image/photo_region.h"
#include "analysis/image/scale_target.h"
#include "analysis/pile/passing_curve.h"

namespace scree {

struct PhotoAnalysisSettings {
  std::optional<double> m_per_px;  ///< given; none: from targets in the picture
  double target_diameter = 0.5;    ///< m, of the magenta discs
  int sections = 6;                ///< equal parts of the region from its top, S1, to its foot
  std::vector<cv::Point> region;   ///< polygon, px; empty: the whole picture
  bool rock_within_frame = false;  ///< the frame cuts no grain: a virtual photograph
  double detection_area = 25e-4;   ///< m2: smaller outlines are not counted
  SizeModel model = SizeModel::ellipsoid;
  double shape_factor = kShapeFactor;
  double density = 2760;  ///< kg/m3
  double neck = 0.75;     ///< see split_grains
  Threshold threshold = Threshold::otsu;
  bool edges = true;
  int local_window_px = 101;  ///< see ForegroundSettings
  double border_reach = 0.6;  ///< see settle_borders; 0: borders stay where the threshold puts them
};

/// One grain of a picture.
struct ImageGrain {
  int label = 0;     ///< its pixels in PhotoAnalysis::labels
  int section = 0;   ///< from 0
  GrainShape shape;  ///< px; x and y in the whole picture
  double m_per_px = 0;
  std::array<GrainSize, std::size(kSizeModels)> size;  ///< as kSizeModels
  double weight = 1;  ///< for those that the border cut, see PhotoRegion::weight
};

/// Grading of a section, or of the whole region.
struct ImageGrading {
  std::string name;  ///< whole, S1 ...
  int grains = 0;
  double mass = 0;                                                                ///< kg, weighted
  double d10 = 0, d15 = 0, d30 = 0, d50 = 0, d60 = 0, d80 = 0, d90 = 0, d95 = 0;  ///< m; NaN when empty
  double cu = 0, cc = 0;  ///< D60 / D10, D30^2 / (D10 D60)
  double chi = 0;         ///< segregation degree against the whole region; NaN when empty or of one size
  std::optional<PassingCurve> curve;
};

struct PhotoAnalysis {
  ImageScale scale;
  std::vector<ScaleTarget> targets;
  std::vector<ImageGrain> grains;
  int below_limit = 0;  ///< outlines that are too small to be counted
  std::vector<int>
      cut;  ///< labels of those that are not counted as the frame or the region's border cuts them
  double rock_share = 0;  ///< of the region's area
  Labels labels;          ///< of the whole picture
  PhotoRegion region;
  std::vector<std::string> notes;  ///< what a reader must know
};

/// Grains are looked for in the whole picture, so that those are known which reach over the region's border;
/// how bright rock is, the region alone says. Throws std::runtime_error that says what is wrong: no target
/// and no scale, a region outside the picture, no grain above the detection limit.
PhotoAnalysis analyse_photo(const cv::Mat3b& picture, const PhotoAnalysisSettings& settings);

/// The whole region first, then its sections.
std::vector<ImageGrading> gradings_of(const std::vector<ImageGrain>& grains, int sections, SizeModel model);

/// The same of any diameters (m), masses (kg) and sections (from 0) of the same length.
std::vector<ImageGrading> gradings_of(const std::vector<double>& diameters, const std::vector<double>& masses,
                                      const std::vector<int>& section, int sections);

/// Of every section, and of the whole where it has several, more than half of whose mass is one grain: that
/// it is, for a reader. `gradings`: those of the grains.
std::vector<std::string> single_grain_notes(const std::vector<ImageGrain>& grains,
                                            const std::vector<ImageGrading>& gradings, SizeModel model);

/// Section of a height within the region (px), 0 to sections - 1.
int section_of(double y, const PhotoRegion& region, int sections);

}  // namespace scree
