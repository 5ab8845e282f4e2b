#pragma once
// Passing curves of many pictures together.
#include <string>
#include <vector>

#include "sim/material/grading.h"

namespace scree {

/// Shares passing at a diameter, over pictures.
struct EnvelopePoint {
  double diameter = 0;                                                                 ///< m
  double mean = 0, std = 0, median = 0, low68 = 0, high68 = 0, low95 = 0, high95 = 0;  ///< shares, 0 to 1
};

/// At diameters evenly spaced in log d, from the smallest of all curves to the largest. Throws
/// std::invalid_argument without curves.
std::vector<EnvelopePoint> envelope(const std::vector<Grading>& curves);

/// The curve of medians (or means) of the shares passing. Throws std::invalid_argument if it has no two
/// points.
Grading median_curve(const std::vector<EnvelopePoint>& envelope, const std::string& name);
Grading mean_curve(const std::vector<EnvelopePoint>& envelope, const std::string& name);

/// The curve of the means of the diameters at equal shares passing: other than mean_curve(), it is not
/// widened by pictures that differ in size. Throws std::invalid_argument without curves.
Grading mean_diameter_curve(const std::vector<Grading>& curves, const std::string& name);

/// The same curve below `limit` (m) replaced by that of a sieved sample: its mass below the limit is
/// distributed as the sample's mass below it is. A curve with nothing below the limit stays as it is. Throws
/// std::invalid_argument if the sample has nothing below the limit, or the curve nothing above it.
Grading with_sieved_fines(const Grading& curve, const Grading& sieved, double limit);

}  // namespace scree
