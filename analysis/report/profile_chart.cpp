#include "analysis/report/profile_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "analysis/report/pictures.h"

namespace scree {
namespace {

// Okabe and Ito's colours, without yellow.
constexpr std::array<const char*, 7> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                              "#e69f00", "#56b4e9", "#333333"};

// Shares of the chart's width. Series are shifted sideways so that bars do not hide each other: by as much,
// all together at most; a bound is a dash of this width.
constexpr double kDodge = 0.014, kWidestDodge = 0.06, kDash = 0.09;

struct Look {
  const char* name;
  int point;
  double size;
};

Look look(ChartSeries::Kind kind) {
  switch (kind) {
    case ChartSeries::Kind::pfc3d:
      return {"PFC3D", 4, 0.9};
    case ChartSeries::Kind::measured:
      return {"measured", 8, 1.0};
    case ChartSeries::Kind::at_least:
      return {"PFC3D at least", 0, 0};
    case ChartSeries::Kind::at_most:
      return {"PFC3D at most", 0, 0};
    case ChartSeries::Kind::ours:
      break;
  }
  return {"here", 7, 0.5};
}

std::string in_key(const ChartSeries& series, bool one_case) {
  if (!series.label.empty()) return series.label;
  const char* kind = look(series.kind).name;
  return one_case ? kind : fmt::format("{}, {}", series.name, kind);
}

// Pixels. Gnuplot leaves no room of its own for a key below the label of the axis, and lets long rows run out
// of the picture: place and rows are counted out here.
constexpr int kWidth = 760, kPlotAndAxes = 434, kKeyRow = 18, kAxisLabels = 70;
constexpr double kCharacter = 7.8, kKeyPoint = 55, kKeyWidth = 720;

/// Rows and columns of the key.
struct KeyShape {
  int rows = 1, columns = 1;
};

KeyShape key_shape(const std::vector<std::string>& labels) {
  std::size_t longest = 1;
  for (const std::string& label : labels)
    longest = std::max(longest, static_cast<std::size_t>(std::count_if(
                                    label.begin(), label.end(), [](char c) { return (c & 0xC0) != 0x80; })));
  const int n = std::max(1, static_cast<int>(labels.size()));
  const int fit =
      std::clamp(static_cast<int>(kKeyWidth / (kKeyPoint + kCharacter * static_cast<double>(longest))), 1, n);
  const int rows = (n + fit - 1) / fit;
  return {rows, (n + rows - 1) / rows};
}

}  // namespace

void draw(const ProfileChart& chart, const std::filesystem::path& file) {
  const double count = static_cast<double>(chart.series.size()), middle = 0.5 * (count - 1);
  const double width = chart.x_range[1] - chart.x_range[0];
  const double dodge = count > 1 ? width * std::min(kDodge, kWidestDodge / (count - 1)) : 0;
  std::set<std::string> cases;
  for (const ChartSeries& series : chart.series) cases.insert(series.name);
  std::string script, plots;
  std::vector<std::string> labels;
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    const ChartSeries& series = chart.series[k];
    script += fmt::format("$s{} << END\n", k);
    for (const auto& p : series.points)
      script += fmt::format("{} {} {}\n", p.x + dodge * (static_cast<double>(k) - middle), p.y,
                            std::isfinite(p.std) ? p.std : 0.0);
    script += "END\n";
    const Look shown = look(series.kind);
    const char* colour =
        series.colour < 0 ? "#777777" : kColours[static_cast<std::size_t>(series.colour) % kColours.size()];
    labels.push_back(in_key(series, cases.size() == 1));
    if (series.kind == ChartSeries::Kind::at_least || series.kind == ChartSeries::Kind::at_most) {
      plots += fmt::format(
          "{}$s{} using ($1-{}):2:({}):(0) with vectors nohead lw 1.6 dt (6,3) lc rgb '{}' title {}",
          plots.empty() ? "" : ", ", k, width * kDash / 2, width * kDash, colour,
          gnuplot_quoted(labels.back()));
      continue;
    }
    if (series.kind == ChartSeries::Kind::ours)
      plots += fmt::format("{}$s{} using 1:2 with lines lc rgb '{}' lw 1.6 notitle",
                           plots.empty() ? "" : ", ", k, colour);
    // Bars by hand: gnuplot's own clear a disc around each point, which hides short ones.
    plots += fmt::format(
        "{0}$s{1} using 1:($2-$3):(0):(2*$3) with vectors nohead lw 1 lc rgb '{2}' notitle, "
        "$s{1} using 1:2 with points pt {3} ps {4} lw 1 lc rgb '{2}' title {5}",
        plots.empty() ? "" : ", ", k, colour, shown.point, shown.size, gnuplot_quoted(labels.back()));
  }
  const KeyShape key = key_shape(labels);
  const int key_height = kKeyRow * key.rows, height = kPlotAndAxes + key_height;
  script += chart_terminal(kWidth, height);
  script += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\nset xrange [{}:{}]\n",
                        gnuplot_quoted(chart.title), gnuplot_quoted(chart.x_label),
                        gnuplot_quoted(chart.y_label), chart.x_range[0], chart.x_range[1]);
  script += fmt::format(
      "set bmargin at screen {:.4f}\nset key at screen 0.5, screen {:.4f} center top horizontal Left reverse "
      "maxcols {} samplen 1.5\n",
      static_cast<double>(kAxisLabels + key_height) / height, (key_height + 4.0) / height, key.columns);
  if (chart.zero_line)
    script += "set arrow 1 from graph 0, first 0 to graph 1, first 0 nohead lc rgb '#888888'\n";
  script += "set offsets 0, 0, graph 0.06, graph 0.06\nplot " + plots + "\n";
  run_gnuplot(script, file);
}

}  // namespace scree
