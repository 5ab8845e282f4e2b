#pragma once
// Grains that touch, told apart: distance transform and watershed.
#include <opencv2/core.hpp>

namespace scree {

/// Labels from 1 up; 0 is no grain.
struct Labels {
  cv::Mat1i of;   ///< label of each pixel
  int count = 0;  ///< labels are 1 to count
};

/// Cuts rock at its necks. Every pixel of rock gets its distance to the nearest gap or edge (exact
/// Euclidean); the heights that this makes are flooded from the top down (Vincent & Soille, IEEE Trans. PAMI
/// 13 (1991) 583). Where two floods meet they are one grain if the pass is at least `neck` times as high as
/// the lower of their summits, else a border: a neck narrower than that share of the smaller part's width
/// separates. `edges` (may be empty) are borders too, and afterwards belong to the grain beside them.
Labels split_grains(const cv::Mat1b& rock, const cv::Mat1b& edges, double neck);

/// Moves the borders of grains to the steps of brightness near them: a watershed of the grey picture from the
/// insides of the grains and from what is surely none (Meyer & Beucher, J. Vis. Commun. Image Represent. 1
/// (1990) 21). A grain's side that the sun does not reach is as dark as lit ground, so a threshold cuts it
/// off; its brightness falls smoothly to there, and steps down to the shadow that it throws. What is nowhere
/// three pixels wide goes to its neighbours. `reach`: how far a border may move outwards, in radii of the
/// grain.
Labels settle_borders(const Labels& labels, const cv::Mat1b& grey, const cv::Mat1b& ignore, double reach);

}  // namespace scree
