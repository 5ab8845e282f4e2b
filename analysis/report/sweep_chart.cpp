#include "analysis/report/sweep_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/report/pictures.h"
#include "analysis/report/section_canvas.h"

namespace scree {
namespace {

constexpr int kWidth = 640, kHeight = 480;

std::string titles(const std::string& title, const std::string& x, const std::string& y) {
  return fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n", gnuplot_quoted(title), gnuplot_quoted(x),
                     gnuplot_quoted(y));
}

}  // namespace

void draw(const LineChart& chart, const std::filesystem::path& file) {
  std::string script = chart_terminal(kWidth, kHeight) + titles(chart.title, chart.x_label, chart.y_label);
  script += "$data << END\n";
  bool printed = false;
  for (const LineChart::Point& p : chart.points)
    if (p.y.n > 0) script += fmt::format("{} {} {}\n", p.x, p.y.mean, p.y.n > 1 ? p.y.std : 0.0);
  script += "END\n$printed << END\n";
  for (const LineChart::Point& p : chart.points)
    if (std::isfinite(p.printed)) script += fmt::format("{} {}\n", p.x, p.printed), printed = true;
  script +=
      "END\nset offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\n"
      "plot $data using 1:2 with lines lc rgb '#0072b2' notitle, '' using 1:2:3 with yerrorbars pt 7 ps 0.6 "
      "lc rgb '#0072b2' title 'mean and deviation between seeds'";
  if (printed) script += ", $printed with points pt 6 lw 1.5 lc rgb '#d55e00' title 'printed'";
  run_gnuplot(script + "\n", file);
}

namespace {

/// Data blocks of one map of a picture: values at its nodes, contours, the target's line, the numbers.
std::string blocks_of(const ParameterMap& map, const std::string& name, double spacing, double low,
                      double high, std::optional<double> target, int decimals) {
  std::string script = fmt::format("$grid{} << END\n", name), labels;
  for (std::size_t j = 0; j < map.y.size(); ++j, script += "\n")
    for (std::size_t i = 0; i < map.x.size(); ++i) {
      const double v = map.value[j][i];
      script +=
          fmt::format("{} {} {}\n", map.x[i], map.y[j], std::isfinite(v) ? fmt::format("{}", v) : "NaN");
      if (std::isfinite(v)) labels += fmt::format("{} {} {:.{}f}\n", map.x[i], map.y[j], v, decimals);
    }
  script += fmt::format("END\n$labels{} << END\n{}END\n", name, labels);
  const auto contours = [&](const std::string& block, const std::string& levels) {
    return fmt::format(
        "set contour base\nset cntrparam levels {}\nunset surface\nset table ${}{}\n"
        "splot $grid{} using 1:2:3 with lines\nunset table\nunset contour\nset surface\n",
        levels, block, name, name);
  };
  if (target) script += contours("target", fmt::format("discrete {}", *target));
  return script + contours("lines", fmt::format("incremental {},{},{}", spacing * std::floor(low / spacing),
                                                spacing, high));
}

}  // namespace

void draw(const ContourMap& picture, const std::filesystem::path& file) {
  const ParameterMap& map = picture.map;
  double low = INFINITY, high = -INFINITY;
  for (const ParameterMap* each : {&map, picture.beside ? &*picture.beside : nullptr})
    if (each != nullptr)
      for (const auto& row : each->value)
        for (const double v : row)
          if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (!(low < high)) throw std::invalid_argument("a contour map needs two different numbers");
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10((high - low) / 10))));
  const std::size_t nodes = map.x.size() * map.y.size();
  const bool few = nodes <= 100;  // the numbers have room
  const double spacing = round_number_above((high - low) / 18);
  std::string script = blocks_of(map, "1", spacing, low, high, picture.target, decimals);
  if (picture.beside) script += blocks_of(*picture.beside, "2", spacing, low, high, picture.target, decimals);

  const int fine = nodes < 400 ? 10 : 1;  // pieces of a cell
  script += chart_terminal(picture.beside ? 2 * kWidth - 60 : kWidth, kHeight);
  script += viridis_palette();
  script += fmt::format(
      "set cblabel {}\nset cbrange [{}:{}]\nset view map\nset pm3d interpolate "
      "{},{}\nunset key\nunset grid\n"
      "set style textbox opaque fillcolor '#ffffff' noborder margins 0.6,0.4\nset xrange [{}:{}]\nset yrange "
      "[{}:{}]\n",
      gnuplot_quoted(picture.value_label), low, high, fine, fine, map.x.front(), map.x.back(), map.y.front(),
      map.y.back());
  const auto panel = [&](const char* name, const std::string& title) {
    script += titles(title, picture.x_label, picture.y_label);
    script += fmt::format(
        "splot $grid{0} using 1:2:3 with pm3d, $lines{0} using 1:2:(0) with lines lc rgb '#ffffff' lw 1",
        name);
    if (map.x == map.y)
      script += fmt::format(", [t={}:{}] '+' using 1:1:(0) with lines dt 2 lc rgb '#ffffff' lw 1.5",
                            map.x.front(), map.x.back());
    if (picture.target)
      script += fmt::format(", $target{} using 1:2:(0) with lines lc rgb '#d55e00' lw 3", name);
    if (few)
      script +=
          fmt::format(", $labels{} using 1:2:(0):3 with labels boxed tc rgb '#000000' font ',10'", name);
    script += "\n";
  };
  if (picture.beside)
    script += "set multiplot layout 1,2 margins 0.07,0.92,0.18,0.92 spacing 0.09\nunset colorbox\n";
  panel("1", picture.beside ? picture.title + ": simulated" : picture.title);
  if (picture.beside) {
    script += "set colorbox\n";
    panel("2", picture.title + ": printed");
    script += "unset multiplot\n";
  }
  run_gnuplot(script, file);
}

void draw(const CalibrationChart& chart, const std::filesystem::path& file) {
  std::string script = "$runs << END\n";
  for (const auto& [x, y] : chart.runs) script += fmt::format("{} {}\n", x, y);
  script += "END\n$band << END\n";
  for (std::size_t k = 0; k < chart.x.size(); ++k)
    script += fmt::format("{} {} {} {}\n", chart.x[k], chart.mean[k], chart.low[k], chart.high[k]);
  script += "END\n" + chart_terminal(kWidth, kHeight) + titles(chart.title, chart.x_label, chart.y_label);
  const double half = kDeviations90 * chart.uncertainty;
  script += fmt::format(
      "set key top left\nset xrange [{0}:{1}]\n"
      "set object 1 rectangle from graph 0, first {2} to graph 1, first {3} fs solid 0.25 noborder fc rgb "
      "'#d55e00' behind\n"
      "set object 2 rectangle from first {4}, graph 0 to first {5}, graph 1 fs solid 0.2 noborder fc rgb "
      "'#009e73' behind\n"
      "set arrow 1 from first {6}, graph 0 to first {6}, graph 1 nohead lc rgb '#009e73' lw 2\n"
      "plot $band using 1:3:4 with filledcurves fs solid 0.25 lc rgb '#0072b2' title 'emulator, 90 %', "
      "'' using 1:2 with lines lc rgb '#0072b2' notitle, {7} with lines lc rgb '#d55e00' lw 2 title "
      "'target', "
      "$runs using 1:2 with points pt 7 ps 0.5 lc rgb '#333333' title 'simulations'\n",
      chart.x.front(), chart.x.back(), chart.target - half, chart.target + half, chart.interval[0],
      chart.interval[1], chart.best, chart.target);
  run_gnuplot(script, file);
}

}  // namespace scree
