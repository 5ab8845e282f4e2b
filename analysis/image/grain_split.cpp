#include "analysis/image/grain_split.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace scree {
namespace {

// Heights are sorted in steps of an eighth of a pixel: finer than the distance transform of a jagged outline.
constexpr int kSteps = 8;

// Floods with their summits; a flood that was joined to another points to it.
class Floods {
 public:
  int begin(int summit) {
    parent_.push_back(static_cast<int>(parent_.size()));
    summit_.push_back(summit);
    return parent_.back();
  }
  int root(int flood) {
    while (parent_[flood] != flood) flood = parent_[flood] = parent_[parent_[flood]];
    return flood;
  }
  int summit(int root) const { return summit_[root]; }
  // The earlier one, which is the higher one, goes on.
  void join(int a, int b) { parent_[std::max(a, b)] = std::min(a, b); }
  std::size_t size() const { return parent_.size(); }

 private:
  std::vector<int> parent_, summit_;
};

// Pixels of a height above 0, the highest first, in rows within a height: a counting sort.
std::vector<int> from_the_top(const cv::Mat1i& height) {
  const int* h = height[0];
  const int n = height.rows * height.cols;
  const int top = *std::max_element(h, h + n);
  std::vector<int> begin(static_cast<std::size_t>(top) + 2, 0);
  for (int i = 0; i < n; ++i)
    if (h[i] > 0) ++begin[top - h[i] + 1];
  for (std::size_t k = 1; k < begin.size(); ++k) begin[k] += begin[k - 1];
  std::vector<int> order(begin.back());
  for (int i = 0; i < n; ++i)
    if (h[i] > 0) order[begin[top - h[i]]++] = i;
  return order;
}

// Pixels of rock without a label take that of a neighbour, ring after ring, `rings` times.
void grow(cv::Mat1i& labels, const cv::Mat1b& rock, int rings) {
  for (int ring = 0; ring < rings; ++ring) {
    const cv::Mat1i before = labels.clone();
    for (int y = 1; y + 1 < labels.rows; ++y)
      for (int x = 1; x + 1 < labels.cols; ++x) {
        if (before(y, x) != 0 || rock(y, x) == 0) continue;
        for (const int near : {before(y - 1, x), before(y, x - 1), before(y, x + 1), before(y + 1, x)})
          if (near != 0) labels(y, x) = near;
      }
  }
}

// Label of the grain nearest to each pixel that is none, and how far it is.
struct Nearest {
  cv::Mat1f distance;
  cv::Mat1i label;
};

Nearest nearest_grains(const cv::Mat1i& labels) {
  Nearest nearest;
  cv::Mat1i index;
  cv::distanceTransform(labels == 0, nearest.distance, index, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  std::vector<int> label_of;
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (labels(y, x) > 0) {
        label_of.resize(std::max<std::size_t>(label_of.size(), index(y, x) + 1));
        label_of[index(y, x)] = labels(y, x);
      }
  nearest.label = cv::Mat1i(labels.size(), 0);
  for (int y = 0; y < labels.rows; ++y)
    for (int x = 0; x < labels.cols; ++x)
      if (index(y, x) < static_cast<int>(label_of.size())) nearest.label(y, x) = label_of[index(y, x)];
  return nearest;
}

// Pixels of the lines that OpenCV draws between its basins, and of the frame, go to the neighbour that is as
// bright as they are.
void close_lines(cv::Mat1i& basins, const cv::Mat1b& grey) {
  const cv::Mat1i before = basins.clone();
  for (int y = 0; y < basins.rows; ++y)
    for (int x = 0; x < basins.cols; ++x) {
      if (before(y, x) > 0) continue;
      int best = 256;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const int ny = y + dy, nx = x + dx;
          if (ny < 0 || nx < 0 || ny >= basins.rows || nx >= basins.cols || before(ny, nx) <= 0) continue;
          const int apart = std::abs(grey(ny, nx) - grey(y, x));
          if (apart < best) {
            best = apart;
            basins(y, x) = before(ny, nx);
          }
        }
    }
}

}  // namespace

Labels split_grains(const cv::Mat1b& rock, const cv::Mat1b& edges, double neck) {
  cv::Mat1b open = rock.clone();
  if (!edges.empty()) open.setTo(0, edges);
  // A frame of gap, so that no neighbour lies outside.
  cv::Mat1b framed;
  cv::copyMakeBorder(open, framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, 0);
  cv::Mat1f distance;
  cv::distanceTransform(framed, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Mat1i height(distance.size(), 0);
  for (int y = 1; y + 1 < height.rows; ++y)
    for (int x = 1; x + 1 < height.cols; ++x)
      height(y, x) = static_cast<int>(std::lround(distance(y, x) * kSteps));

  const int row = height.cols;
  const int around[8] = {-row - 1, -row, -row + 1, -1, 1, row - 1, row, row + 1};
  cv::Mat1i flood(height.size(), -1);
  int* of = flood[0];
  const int* h = height[0];
  Floods floods;
  for (const int pixel : from_the_top(height)) {
    int mine = -1;
    for (const int step : around) {
      if (of[pixel + step] < 0) continue;
      const int other = floods.root(of[pixel + step]);
      if (mine < 0 || mine == other) {
        mine = other;
        continue;
      }
      const int lower = std::min(floods.summit(mine), floods.summit(other));
      if (h[pixel] >= neck * lower) floods.join(mine, other);
      // The pixel on a border goes to the flood with the higher summit.
      mine = floods.root(std::min(mine, other));
    }
    of[pixel] = mine < 0 ? floods.begin(h[pixel]) : mine;
  }

  Labels labels;
  std::vector<int> name(floods.size(), 0);
  labels.of = cv::Mat1i(rock.size(), 0);
  for (int y = 0; y < rock.rows; ++y)
    for (int x = 0; x < rock.cols; ++x) {
      if (flood(y + 1, x + 1) < 0) continue;
      int& label = name[floods.root(flood(y + 1, x + 1))];
      if (label == 0) label = ++labels.count;
      labels.of(y, x) = label;
    }
  // An edge is two pixels wide at most.
  if (!edges.empty()) grow(labels.of, rock, 2);
  return labels;
}

Labels settle_borders(const Labels& labels, const cv::Mat1b& grey, const cv::Mat1b& ignore, double reach) {
  if (labels.count == 0) return labels;
  std::vector<double> radius(labels.count + 1, 0);
  for (int y = 0; y < labels.of.rows; ++y)
    for (int x = 0; x < labels.of.cols; ++x) ++radius[labels.of(y, x)];
  for (double& r : radius) r = std::sqrt(r / std::numbers::pi);

  // Basin 1 is what is no grain, label + 1 the inside of a grain; 0 is open.
  const Nearest nearest = nearest_grains(labels.of);
  cv::Mat1i basins(labels.of.size(), 0);
  for (int y = 0; y < basins.rows; ++y)
    for (int x = 0; x < basins.cols; ++x) {
      const int label = labels.of(y, x);
      if (label == 0) {
        const bool far = nearest.distance(y, x) > 1.5 + reach * radius[nearest.label(y, x)];
        if (far || ignore(y, x)) basins(y, x) = 1;
        continue;
      }
      bool inside = true;
      for (int dy = -1; dy <= 1 && inside; ++dy)
        for (int dx = -1; dx <= 1 && inside; ++dx) {
          const int ny = y + dy, nx = x + dx;
          inside = ny < 0 || nx < 0 || ny >= basins.rows || nx >= basins.cols || labels.of(ny, nx) == label;
        }
      // What is nowhere three pixels wide, a sliver between an edge and the rim, goes to its neighbours.
      if (inside) basins(y, x) = label + 1;
    }
  // Steps stay, noise within a grain does not: it would let any basin through.
  cv::Mat1b smooth;
  cv::bilateralFilter(grey, smooth, 7, 25, 3);
  cv::Mat3b colours;
  cv::cvtColor(smooth, colours, cv::COLOR_GRAY2BGR);
  cv::watershed(colours, basins);
  close_lines(basins, grey);
  Labels out{cv::Mat1i(labels.of.size(), 0), labels.count};
  for (int y = 0; y < basins.rows; ++y)
    for (int x = 0; x < basins.cols; ++x) out.of(y, x) = std::max(basins(y, x) - 1, 0);
  return out;
}

}  // namespace scree
