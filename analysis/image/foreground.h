#pragma once
// From a photograph to where rock is: pre-processing, threshold, morphology.
#include <opencv2/core.hpp>
#include <string>

namespace scree {

/// How rock is told from what lies between it.
enum class Threshold {
  otsu,  ///< one for the picture (Otsu, IEEE Trans. SMC 9 (1979) 62)
  local  ///< the mean of what is around, where light is uneven
};

struct ForegroundSettings {
  Threshold threshold = Threshold::otsu;
  int local_window_px = 151;    ///< side of the square around a pixel
  double local_offset = 8;      ///< of 255: how much darker than its surroundings a gap is
  bool edges = true;            ///< sharp steps of brightness are borders too: for rock that lies on rock
  int opening_px = 1;           ///< radius of erosion, then dilation: removes specks and thin bridges
  int closing_px = 1;           ///< radius of dilation, then erosion: mends cracks
  double largest_hole_px = 25;  ///< area; dark spots within rock up to this are filled
};

/// What of a picture is rock.
struct Foreground {
  cv::Mat1b grey;   ///< after denoising and stretching of contrast
  cv::Mat1b rock;   ///< 255 where rock is
  cv::Mat1b edges;  ///< 255 on sharp steps of brightness; empty without `edges`
};

/// Grey values, median filter of 3 x 3 and a slight blur against noise, contrast stretched between the
/// percentiles 0.5 and 99.5; threshold; opening, closing, filling of holes; edges by Canny (IEEE Trans. PAMI
/// 8 (1986) 679). `ignore` (255) are pixels that are neither: a scale target. `region` (255) are those
/// that say how bright rock is. The numbers do not depend on the number of threads.
Foreground find_rock(const cv::Mat3b& picture, const cv::Mat1b& ignore, const cv::Mat1b& region,
                     const ForegroundSettings& settings);

}  // namespace scree
