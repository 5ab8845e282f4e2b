#pragma once
// Grains that touch, told apart: distance transform and watershed.
#include <opencv2/core.hpp>

namespace scree {

/// Labels from 1 up; 0 is no grain.
struct Labels {
  cv::Mat1i of;   ///< label of each pixel
  int count = 0;  ///< labels are 1 to count
};

/// Cuts rock at its necks. Every pixel of rock gets its distance to the nearest gap or edge (exact Euclidean);
/// the heights that this makes are flooded from the top down (Vincent & Soille, IEEE Trans. PAMI 13 (1991)
/// 583). Where two floods meet they are one grain if the pass is at least `neck` times as high as the lower
/// of their summits, else a border: a neck narrower than that share of the smaller part's width separates.
/// `edges` (may be empty) are borders too, and afterwards belong to the grain beside them.
Labels split_grains(const cv::Mat1b& rock, const cv::Mat1b& edges, double neck);

}  // namespace scree
