#include "analysis/profile_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/pictures.h"

namespace scree {
namespace {

// Okabe and Ito's colours, without yellow.
constexpr std::array<const char*, 7> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                              "#e69f00", "#56b4e9", "#333333"};

constexpr double kDodge = 0.008;  // of the width, between cases, so that bars do not hide each other

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
    case ChartSeries::Kind::ours:
      break;
  }
  return {"here", 7, 0.5};
}

}  // namespace

void draw(const ProfileChart& chart, const std::filesystem::path& file) {
  double low = INFINITY, high = -INFINITY;
  int colours = 0;
  for (const ChartSeries& series : chart.series) {
    colours = std::max(colours, series.colour + 1);
    for (const auto& p : series.points) low = std::min(low, p.x), high = std::max(high, p.x);
  }
  const double width = high > low ? high - low : 0, middle = 0.5 * (colours - 1);
  std::string script, plots;
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    const ChartSeries& series = chart.series[k];
    script += fmt::format("$s{} << END\n", k);
    for (const auto& p : series.points)
      script += fmt::format("{} {} {}\n", p.x + kDodge * width * (series.colour - middle), p.y,
                            std::isfinite(p.std) ? p.std : 0.0);
    script += "END\n";
    const Look shown = look(series.kind);
    const char* colour = kColours[static_cast<std::size_t>(series.colour) % kColours.size()];
    const std::string name = gnuplot_quoted(fmt::format("{}, {}", series.name, shown.name));
    if (series.kind == ChartSeries::Kind::ours)
      plots += fmt::format("{}$s{} using 1:2 with lines lc rgb '{}' lw 1.6 notitle",
                           plots.empty() ? "" : ", ", k, colour);
    plots += fmt::format("{}$s{} using 1:2:3 with yerrorbars pt {} ps {} lw 1 lc rgb '{}' title {}",
                         plots.empty() ? "" : ", ", k, shown.point, shown.size, colour, name);
  }
  script += chart_terminal(760, 400);
  script +=
      fmt::format("set title {}\nset xlabel {}\nset ylabel {}\nset key outside right top Left reverse\n",
                  gnuplot_quoted(chart.title), gnuplot_quoted(chart.x_label), gnuplot_quoted(chart.y_label));
  if (chart.zero_line)
    script += "set arrow 1 from graph 0, first 0 to graph 1, first 0 nohead lc rgb '#888888'\n";
  script += "set offsets graph 0.04, graph 0.04, graph 0.06, graph 0.06\nplot " + plots + "\n";
  run_gnuplot(script, file);
}

}  // namespace scree
