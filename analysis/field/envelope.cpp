#include "analysis/field/envelope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/field/spread.h"

namespace scree {
namespace {

constexpr int kPoints = 600;
constexpr int kShares = 200;  // steps of half a percent: D10, D15 ... are points

Grading curve_of(const std::vector<EnvelopePoint>& envelope, double EnvelopePoint::*share,
                 const std::string& name) {
  std::vector<Grading::Point> points;
  for (const EnvelopePoint& at : envelope) {
    const double passing = at.*share;
    if (!points.empty() && passing < points.back().passing) continue;  // by its rounding
    points.push_back({at.diameter, passing});
  }
  return Grading(name, std::move(points));
}

}  // namespace

std::vector<EnvelopePoint> envelope(const std::vector<Grading>& curves) {
  if (curves.empty()) throw std::invalid_argument("an envelope needs curves");
  double low = curves.front().min_diameter(), high = curves.front().max_diameter();
  for (const Grading& curve : curves) {
    low = std::min(low, curve.min_diameter());
    high = std::max(high, curve.max_diameter());
  }
  std::vector<EnvelopePoint> out;
  for (int k = 0; k <= kPoints; ++k) {
    EnvelopePoint point;
    point.diameter = k == kPoints ? high : low * std::pow(high / low, static_cast<double>(k) / kPoints);
    std::vector<double> shares;
    for (const Grading& curve : curves) shares.push_back(curve.passing(point.diameter));
    const MeanStd both = mean_std(shares);
    point.mean = k == kPoints ? 1 : both.mean;  // a sum of ones over n may miss 1 by its rounding
    point.std = both.std;
    point.median = sample_quantile(shares, 0.5);
    point.low68 = sample_quantile(shares, 0.16);
    point.high68 = sample_quantile(shares, 0.84);
    point.low95 = sample_quantile(shares, 0.025);
    point.high95 = sample_quantile(shares, 0.975);
    out.push_back(point);
  }
  return out;
}

Grading median_curve(const std::vector<EnvelopePoint>& envelope, const std::string& name) {
  return curve_of(envelope, &EnvelopePoint::median, name);
}

Grading mean_curve(const std::vector<EnvelopePoint>& envelope, const std::string& name) {
  return curve_of(envelope, &EnvelopePoint::mean, name);
}

Grading mean_diameter_curve(const std::vector<Grading>& curves, const std::string& name) {
  if (curves.empty()) throw std::invalid_argument("a mean curve needs curves");
  std::vector<Grading::Point> points;
  for (int k = 0; k <= kShares; ++k) {
    const double share = static_cast<double>(k) / kShares;
    double sum = 0;
    for (const Grading& curve : curves) sum += curve.diameter(share);
    points.push_back({sum / static_cast<double>(curves.size()), share});
  }
  return Grading(name, std::move(points));
}

Grading with_sieved_fines(const Grading& curve, const Grading& sieved, double limit) {
  const double share = curve.passing(limit), of_sample = sieved.passing(limit);
  if (!(of_sample > 0))
    throw std::invalid_argument(fmt::format("the sieved sample has nothing below {} m", limit));
  if (share >= 1) throw std::invalid_argument(fmt::format("a curve has nothing above {} m", limit));
  if (share == 0) return curve;
  std::vector<Grading::Point> points;
  for (const Grading::Point& point : sieved.points())
    if (point.diameter < limit) points.push_back({point.diameter, share * point.passing / of_sample});
  points.push_back({limit, share});
  for (const Grading::Point& point : curve.points())
    if (point.diameter > limit) points.push_back(point);
  return Grading(curve.name() + ", with fines", std::move(points));
}

}  // namespace scree
