#pragma once
// A chart of a number along a slope, or over another one, of several runs and printed values together.
#include <array>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace scree {

/// Points of one run or of one printed case.
struct ChartSeries {
  enum class Kind { ours, pfc3d, measured, at_least, at_most };
  struct Point {
    double x = 0, y = 0;
    double std = std::numeric_limits<double>::quiet_NaN();  ///< none: no bar
  };
  std::string name;
  Kind kind = Kind::ours;  ///< ours: dots and a line; pfc3d: squares; measured: triangles; bounds: dashes
  int colour = 0;          ///< index, -1 grey; series of one case share it; a chart of one case leaves its
                           ///< name out
  std::vector<Point> points;
  std::string label{};  ///< in the key; empty: made of the name and the kind
};

struct ProfileChart {
  std::string title, x_label, y_label;
  bool zero_line = false;  ///< a line at y = 0
  std::vector<ChartSeries> series;
  std::array<double, 2> x_range{0, 1};  ///< of a slope from crest to toe
};

/// Draws it as SVG. Throws std::runtime_error, see run_gnuplot.
void draw(const ProfileChart& chart, const std::filesystem::path& file);

}  // namespace scree
