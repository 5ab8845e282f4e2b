#pragma once
// A number over one or two parameters: a line with deviations, or a contour map.
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "analysis/results/results.h"
#include "analysis/statistics/calibration.h"

namespace scree {

/// One parameter, and the number at each of its values.
struct LineChart {
  std::string title, x_label, y_label;
  struct Point {
    double x;
    MeanStd y;             ///< over seeds
    double printed = NAN;  ///< drawn beside it
  };
  std::vector<Point> points;
};

/// Two parameters on a grid, and the number at each node, with contours.
struct ContourMap {
  std::string title, x_label, y_label, value_label;
  ParameterMap map;
  std::optional<ParameterMap> beside;  ///< printed values on the same grid, drawn as a second map
  std::optional<double> target;        ///< drawn as a thick line
};

/// What a calibration of one parameter found: simulations, the emulator's 90 % band, the target's.
struct CalibrationChart {
  std::string title, x_label, y_label;
  std::vector<std::array<double, 2>> runs;  ///< parameter, number
  std::vector<double> x, mean, low, high;   ///< emulator
  double target = 0, uncertainty = 0;
  double best = 0;                   ///< parameter chosen
  std::array<double, 2> interval{};  ///< that holds 90 % of the probability
};

/// Draws as SVG. Throws std::runtime_error, see run_gnuplot.
void draw(const LineChart& chart, const std::filesystem::path& file);
void draw(const ContourMap& map, const std::filesystem::path& file);
void draw(const CalibrationChart& chart, const std::filesystem::path& file);

}  // namespace scree
