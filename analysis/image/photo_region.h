#pragma once
// The part of a picture that is looked at, and how often its border cuts a grain.
#include <opencv2/core.hpp>
#include <vector>

namespace scree {

class PhotoRegion {
 public:
  PhotoRegion() = default;  ///< of no picture
  /// `polygon` in px, as far as it lies within the picture; empty: the whole picture. Throws
  /// std::runtime_error for less than 10 x 10 pixels.
  PhotoRegion(const cv::Size& picture, const std::vector<cv::Point>& polygon);

  const cv::Rect& box() const { return box_; }
  double middle_y() const { return box_.y + box_.height / 2.0; }  ///< px
  /// 255 within, of the picture's size.
  const cv::Mat1b& mask() const { return mask_; }
  bool has(double x, double y) const;  ///< the pixel nearest to a place, px

  /// Of a grain, px.
  struct Extent {
    cv::Size box;
    double widest, narrowest;
  };
  /// A grain that the border cuts is not counted, a large one more often than a small one; so those that are
  /// whole count for area / places where one of this size is whole (Miles, Adv. Appl. Probab. 6 (1974) 243).
  /// Of a rectangle these are its sides less the grain's height and width. In any other region they are the
  /// mean of those of discs as wide as the grain is at most and at least: on the mean over directions as
  /// much of it reaches over a border (Cauchy; Serra, Image Analysis and Mathematical Morphology, 1982).
  /// `within_frame`: rock ends at the picture's frame, so places where the frame would cut it do not count.
  double weight(const Extent& grain, bool within_frame) const;

 private:
  // Middles of grains of these sides in the region, as far as the frame does not cut them.
  double middles(double width, double height) const;
  double places_of_disc(double diameter) const;
  bool is_rectangle() const { return area_ == static_cast<double>(box_.width) * box_.height; }

  cv::Rect box_;
  cv::Mat1b mask_;
  double area_ = 0;             // px2
  cv::Mat1i pixels_;            // of the region above and to the left of a corner; of no rectangle only
  std::vector<float> to_edge_;  // distances of its pixels to its border, px, rising; of no rectangle only
};

}  // namespace scree
