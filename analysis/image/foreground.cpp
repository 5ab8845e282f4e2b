#include "analysis/image/foreground.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace scree {
namespace {

cv::Mat1b disc(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
}

using Histogram = std::array<std::int64_t, 256>;

Histogram histogram_of(const cv::Mat1b& grey, const cv::Mat1b& of) {
  Histogram counts{};
  for (int y = 0; y < grey.rows; ++y)
    for (int x = 0; x < grey.cols; ++x)
      if (of(y, x) != 0) ++counts[grey(y, x)];
  return counts;
}

int percentile(const Histogram& counts, double share) {
  std::int64_t all = 0, below = 0;
  for (const std::int64_t n : counts) all += n;
  int value = 0;
  while (value < 255 && static_cast<double>(below += counts[value]) < share * static_cast<double>(all))
    ++value;
  return value;
}

void stretch(cv::Mat1b& grey, const cv::Mat1b& of) {
  const Histogram counts = histogram_of(grey, of);
  const double low = percentile(counts, 0.005), high = std::max<double>(percentile(counts, 0.995), low + 1);
  cv::Mat1b table(1, 256);
  for (int value = 0; value < 256; ++value)
    table(0, value) = cv::saturate_cast<uchar>(255 * (value - low) / (high - low));
  cv::LUT(grey, table, grey);
}

// Otsu's threshold: the largest variance between both classes.
int otsu(const Histogram& counts) {
  double all = 0, sum = 0;
  for (int value = 0; value < 256; ++value) {
    all += static_cast<double>(counts[value]);
    sum += value * static_cast<double>(counts[value]);
  }
  double below = 0, sum_below = 0, best = -1;
  int threshold = 127;
  for (int value = 0; value < 255; ++value) {
    below += static_cast<double>(counts[value]);
    sum_below += value * static_cast<double>(counts[value]);
    if (below == 0 || below == all) continue;
    const double apart = sum_below / below - (sum - sum_below) / (all - below);
    const double between = below * (all - below) * apart * apart;
    if (between > best) {
      best = between;
      threshold = value;
    }
  }
  return threshold;
}

// Dark spots that rock encloses; larger ones are gaps between grains.
void fill_holes(cv::Mat1b& rock, double largest) {
  cv::Mat1i labels, stats;
  cv::Mat1d centroids;
  const int n = cv::connectedComponentsWithStats(~rock, labels, stats, centroids, 4, CV_32S);
  std::vector<char> fill(n, 0);
  for (int label = 1; label < n; ++label) fill[label] = stats(label, cv::CC_STAT_AREA) <= largest;
  for (int y = 0; y < rock.rows; ++y)
    for (int x = 0; x < rock.cols; ++x)
      if (fill[labels(y, x)]) rock(y, x) = 255;
}

}  // namespace

Foreground find_rock(const cv::Mat3b& picture, const cv::Mat1b& ignore, const cv::Mat1b& region,
                     const ForegroundSettings& settings) {
  Foreground found;
  const cv::Mat1b telling = region & ~ignore;
  cv::Mat1b denoised;
  cv::cvtColor(picture, denoised, cv::COLOR_BGR2GRAY);
  cv::medianBlur(denoised, denoised, 3);
  cv::GaussianBlur(denoised, found.grey, {3, 3}, 0);
  stretch(found.grey, telling);

  if (settings.threshold == Threshold::otsu) {
    found.rock = found.grey > otsu(histogram_of(found.grey, telling));
  } else {
    cv::adaptiveThreshold(found.grey, found.rock, 255, cv::ADAPTIVE_THRESH_MEAN_C, cv::THRESH_BINARY,
                          settings.local_window_px | 1, settings.local_offset);
  }
  found.rock.setTo(0, ignore);
  if (settings.opening_px > 0)
    cv::morphologyEx(found.rock, found.rock, cv::MORPH_OPEN, disc(settings.opening_px));
  if (settings.closing_px > 0)
    cv::morphologyEx(found.rock, found.rock, cv::MORPH_CLOSE, disc(settings.closing_px));
  fill_holes(found.rock, settings.largest_hole_px);
  if (settings.edges) {
    // Steps of a sixth of the range over the pixels of the blur begin an edge; half of that continues it.
    cv::Mat1b smooth;
    cv::GaussianBlur(found.grey, smooth, {}, 1.2);
    cv::Canny(smooth, found.edges, 60, 120, 3, true);
  }
  return found;
}

}  // namespace scree
