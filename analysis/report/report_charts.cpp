// Charts of a run: what was simulated beside what was printed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>

#include "analysis/pile/slope_profile.h"
#include "analysis/report/pictures.h"
#include "analysis/report/report_text.h"
#include "analysis/results/summary.h"

namespace scree {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Point {
  double x = 0, y = 0, std = kNone;
};

/// One line of a chart. Colours of Okabe and Ito (2008), told apart by people who see colours differently.
struct Series {
  std::string label, colour;
  int mark = 7;  // gnuplot's point type
  bool joined = false;
  std::vector<Point> points;
};

/// Section centres along the slope: S1..Sn, or top, middle, bottom.
double place_on_slope(const std::string& section, std::size_t n) {
  static const std::map<std::string, int> thirds{{"top", 1}, {"middle", 2}, {"bottom", 3}};
  if (const auto found = thirds.find(section); found != thirds.end()) return (2.0 * found->second - 1) / 6.0;
  if (section.size() < 2 || section[0] != 'S' ||
      section.find_first_not_of("0123456789", 1) != std::string::npos)
    return kNone;
  const double k = std::stod(section.substr(1));
  return k <= static_cast<double>(n) ? (2 * k - 1) / (2 * static_cast<double>(n)) : kNone;
}

/// Number of sections that a case speaks of: the smallest table of the run that has its last section.
std::size_t sections_of_case(const RunResult& result, const std::string& case_name) {
  std::size_t last = 0;
  for (const Comparison& row : result.comparison) {
    const std::string& section = row.reference.section;
    if (row.reference.case_name == case_name && !std::isnan(place_on_slope(section, 1000)) &&
        section[0] == 'S')
      last = std::max(last, static_cast<std::size_t>(std::stoul(section.substr(1))));
  }
  std::size_t best = 0;
  for (std::size_t table = 0; section_layout(result, table); ++table) {
    const std::size_t n = section_layout(result, table)->sections.size();
    if (n >= last && (best == 0 || n < best)) best = n;
  }
  return std::max(best, last);
}

Series simulated(const RunResult& result, const std::function<double(const Section&)>& value) {
  Series series{"this run", "#0072b2", 7, true, {}};
  const SectionTable* layout = section_layout(result, 0);
  for (std::size_t i = 0; layout && i < layout->sections.size(); ++i) {
    const MeanStd both = mean_std(over_seeds(result, 0, i, value));
    if (both.n > 0)
      series.points.push_back({layout->sections[i].x_over_l, both.mean, both.n > 1 ? both.std : kNone});
  }
  return series;
}

/// Printed values of one quantity, a series for each case and kind.
std::vector<Series> printed(const RunResult& result, const std::string& quantity) {
  std::map<std::pair<std::string, std::string>, Series> by_source;
  for (const Comparison& row : result.comparison) {
    const ReferenceValue& reference = row.reference;
    if (reference.quantity != quantity || meaning_of(reference) != Meaning::value) continue;
    const double x = place_on_slope(reference.section, sections_of_case(result, reference.case_name));
    if (std::isnan(x)) continue;
    Series& series = by_source[{reference.kind, reference.case_name}];
    series.points.push_back({x, reference.value, reference.std.value_or(kNone)});
  }
  // Measured values are black, calculated ones in warm colours; a second case of a kind gets the next look.
  struct Look {
    const char* colour;
    int mark;
  };
  static const Look measured[] = {{"#000000", 9}, {"#777777", 11}},
                    calculated[] = {{"#d55e00", 5}, {"#cc79a7", 13}};
  std::size_t seen[2] = {0, 0};
  std::vector<Series> out;
  for (auto& [source, series] : by_source) {
    const bool by_hand = source.first == "measured";
    const Look& look = (by_hand ? measured : calculated)[seen[by_hand ? 0 : 1]++ % 2];
    series.label = fmt::format("{} ({})", kind_in_words(source.first), source.second);
    series.colour = look.colour;
    series.mark = look.mark;
    out.push_back(std::move(series));
  }
  return out;
}

/// Data blocks of the series, moved apart a little so that error bars do not hide each other.
std::string data_blocks(const std::vector<Series>& all, const std::string& prefix, double apart) {
  std::string out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    out += fmt::format("${}{} << END\n", prefix, i);
    const double shift = apart * (static_cast<double>(i) - (static_cast<double>(all.size()) - 1) / 2);
    for (const Point& point : all[i].points)
      out += fmt::format("{:.6g} {:.6g} {:.6g}\n", point.x + shift, point.y,
                         std::isnan(point.std) ? 0 : point.std);
    out += "END\n";
  }
  return out;
}

std::string curves(const std::vector<Series>& all, const std::string& prefix, bool titled) {
  std::string out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Series& series = all[i];
    const std::string title = titled ? "title " + gnuplot_quoted(series.label) : "notitle";
    if (series.joined)
      out += fmt::format("{}${}{} using 1:2 with lines lw 1.5 lc rgb '{}' notitle", out.empty() ? "" : ", ",
                         prefix, i, series.colour);
    // Not gnuplot's error bars: those leave a gap around each point, in which a short bar is lost.
    out += fmt::format(
        "{0}${1}{2} using 1:($2-$3):(0):(2*$3) with vectors nohead lw 1.2 lc rgb '{3}' notitle, "
        "${1}{2} using 1:2 with points pt {4} ps 0.6 lc rgb '{3}' {5}",
        out.empty() ? "" : ", ", prefix, i, series.colour, series.mark, title);
  }
  return "plot " + out + "\n";
}

std::vector<Series> with_printed(const RunResult& result, const char* quantity,
                                 const std::function<double(const Section&)>& value) {
  std::vector<Series> all{simulated(result, value)};
  for (Series& series : printed(result, quantity)) all.push_back(std::move(series));
  return all;
}

constexpr const char* kAlongSlope =
    "set xrange [0:1]\nset xtics 0.25\nset xtics add ('crest 0' 0, 'toe 1' 1)\nset xlabel 'x/L along the "
    "slope'\n";

Picture chi_chart(const RunResult& result, const std::filesystem::path& folder) {
  const std::vector<Series> all = with_printed(result, "chi", [](const Section& s) { return s.chi; });
  run_gnuplot(chart_terminal(760, 430) + kAlongSlope +
                  "set ylabel 'segregation degree χ'\nset key top left reverse Left samplen 2\n"
                  "set xzeroaxis lc rgb '#888888' lw 1 lt 1\nset offsets 0,0,graph 0.18,graph 0.05\n" +
                  data_blocks(all, "d", 0.008) + curves(all, "d", true),
              folder / "chi.svg");
  return {"Segregation degree", folder / "chi.svg",
          "Above zero a section is coarser than the rock as dumped, below zero finer; bars are one standard "
          "deviation."};
}

Picture diameters_chart(const RunResult& result, const std::filesystem::path& folder) {
  struct Panel {
    const char* name;
    const char* quantity;
    double Section::*value;
  };
  static const Panel panels[] = {{"D10", "d10_rel", &Section::d10_rel},
                                 {"D50", "d50_rel", &Section::d50_rel},
                                 {"D80", "d80_rel", &Section::d80_rel},
                                 {"D90", "d90_rel", &Section::d90_rel}};
  std::string text = chart_terminal(760, 620) + kAlongSlope;
  text += "set key top left reverse Left samplen 1.5 font ',11'\nset multiplot layout 2,2 spacing 0.1,0.1\n";
  for (const Panel& panel : panels) {
    const std::vector<Series> all =
        with_printed(result, panel.quantity, [&](const Section& s) { return s.*panel.value; });
    if (std::all_of(all.begin(), all.end(), [](const Series& one) { return one.points.empty(); })) continue;
    text += data_blocks(all, panel.name, 0.012);
    text +=
        fmt::format("set ylabel '{0} / {0} as dumped'\nset offsets 0,0,graph 0.3,graph 0.08\n", panel.name);
    text += "set arrow 1 from graph 0,first 1 to graph 1,first 1 nohead back lc rgb '#888888'\n";
    text += curves(all, panel.name, all.size() > 1 || &panel == panels);
  }
  run_gnuplot(text + "unset multiplot\n", folder / "diameters.svg");
  return {"Diameters along the slope", folder / "diameters.svg",
          "Characteristic diameters of each section over those of the rock as dumped; one means unchanged."};
}

/// Mean over seeds of the shares at the sieves of the first table.
std::vector<double> mean_passing(const RunResult& result, std::size_t section, std::size_t sieves) {
  std::vector<double> out;
  for (std::size_t sieve = 0; sieve < sieves; ++sieve)
    out.push_back(mean_std(over_seeds(result, 0, section, [&](const Section& s) {
                    return sieve < s.passing.size() ? s.passing[sieve] : kNone;
                  })).mean);
  return out;
}

Picture passing_chart(const RunResult& result, const std::filesystem::path& folder) {
  const SectionTable& table = *section_layout(result, 0);
  std::string blocks, plots;
  const auto add = [&](const std::string& label, const std::vector<double>& passing,
                       const std::string& look) {
    const std::string name = fmt::format("$p{}", std::count(plots.begin(), plots.end(), '$'));
    blocks += name + " << END\n";
    for (std::size_t i = 0; i < std::min(passing.size(), table.sieves.size()); ++i)
      if (std::isfinite(passing[i]))
        blocks += fmt::format("{:.6g} {:.6g}\n", table.sieves[i], 100 * passing[i]);
    blocks += "END\n";
    plots += fmt::format("{}{} using 1:2 with lines {} title {}", plots.empty() ? "" : ", ", name, look,
                         gnuplot_quoted(label));
  };
  const std::size_t n = table.sections.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (mean_std(over_seeds(result, 0, i, [](const Section& s) { return s.d50; })).n == 0) continue;  // empty
    // The yellow end of the scale is too pale for a line on white.
    const unsigned colour = viridis(n > 1 ? 0.88 * static_cast<double>(i) / static_cast<double>(n - 1) : 0);
    const std::string place = i == 0 ? " (crest)" : i + 1 == n ? " (toe)" : "";
    add(table.sections[i].name + place, mean_passing(result, i, table.sieves.size()),
        fmt::format("lw 1.5 lc rgb '#{:06x}'", colour));
  }
  add("as dumped", table.original_passing, "lw 2 dt 2 lc rgb '#000000'");
  run_gnuplot(chart_terminal(760, 430) +
                  "set logscale x\nset xlabel 'grain diameter (m)'\nset ylabel 'passing by mass (%)'\n"
                  "set yrange [0:100]\nset grid\nset key outside right Left "
                  "reverse samplen 2\n" +
                  fmt::format("set xrange [{:.6g}:{:.6g}]\nset xtics ({})\n", table.sieves.front(),
                              table.sieves.back(), log_ticks(table.sieves.front(), table.sieves.back())) +
                  blocks + "plot " + plots + "\n",
              folder / "passing.svg");
  return {"Passing curves", folder / "passing.svg",
          "A curve to the right of the dashed one is a section coarser than the rock as dumped; means over "
          "the seeds."};
}

/// A single place makes no line, and its x no range.
bool has_profile_line(const SeedResult& seed) {
  return seed.profile.size() > 1;
}

Picture profile_chart(const RunResult& result, const SceneFacts& scene, const std::filesystem::path& folder) {
  std::string blocks, plots;
  std::vector<double> angles;
  double x = 0, z = 0, left = kNone, right = kNone, top = result.bench_height, count = 0;
  for (std::size_t i = 0; i < result.seeds.size(); ++i) {
    const SeedResult& seed = result.seeds[i];
    if (seed.slope_angle) angles.push_back(*seed.slope_angle);
    if (!has_profile_line(seed)) continue;
    blocks += fmt::format("$s{} << END\n", i);
    if (const auto line = slope_line(seed.profile, result.bench_height)) x += line->x, z += line->z, ++count;
    for (const auto& point : seed.profile) {
      blocks += fmt::format("{:.5g} {:.5g}\n", point[0], point[1]);
      left = std::fmin(left, point[0]);
      right = std::fmax(right, point[0]);
      top = std::max(top, point[1]);
    }
    blocks += "END\n";
    plots += fmt::format("{}$s{} using 1:2 with lines lw 1.2 lc rgb '#0072b2' {}", plots.empty() ? "" : ", ",
                         i, plots.empty() ? "title 'surface, each seed'" : "notitle");
  }
  const MeanStd angle = mean_std(angles);
  if (angle.n > 0 && count > 0) {
    const double slope = std::tan(angle.mean * std::numbers::pi / 180), xc = x / count, zc = z / count;
    blocks += fmt::format("$fit << END\n{:.5g} {:.5g}\n{:.5g} {:.5g}\nEND\n", xc - (top - zc) / slope, top,
                          xc + zc / slope, 0.0);
    plots += fmt::format(", $fit using 1:2 with lines lw 1.5 dt 2 lc rgb '#d55e00' title 'fitted: {:.1f}°'",
                         angle.mean);
  }
  if (scene.bench_slope && result.bench_height > 0) {
    const double toe = result.bench_height / std::tan(*scene.bench_slope * std::numbers::pi / 180);
    blocks += fmt::format("$bench << END\n{:.5g} {:.5g}\n0 {:.5g}\n{:.5g} 0\nEND\n", std::min(left, 0.0),
                          result.bench_height, result.bench_height, toe);
    plots += fmt::format(
        ", $bench using 1:2 with lines lw 1.2 lc rgb '#888888' title 'bench before dumping: {:.1f}°'",
        *scene.bench_slope);
  }
  const int height =
      std::clamp(static_cast<int>(120 + 620 * 1.25 * top / std::max(right - left, 1e-9)), 260, 620);
  run_gnuplot(
      chart_terminal(760, height) +
          "set size ratio -1\nset xlabel 'distance from the crest, x (m)'\nset ylabel 'height, z (m)'\n"
          "set key top right samplen 2\n" +
          fmt::format("set yrange [0:{:.5g}]\nset xrange [{:.5g}:{:.5g}]\n", 1.12 * top, left, right) +
          blocks + "plot " + plots + "\n",
      folder / "profile.svg");
  return {"Slope profile", folder / "profile.svg",
          "Surface of the pile along the dump axis with the straight line fitted to its middle."};
}

/// A line of the chart of repose angles.
struct AngleRow {
  std::string label;
  Point value;
  const char* colour;
};

std::vector<AngleRow> angle_rows(const RunResult& result) {
  std::vector<AngleRow> rows;
  const auto reading = [&](const char* label, double ReposeAngle::*field) {
    std::vector<double> values;
    for (const SeedResult& seed : result.seeds)
      if (seed.repose) values.push_back((*seed.repose).*field);
    const MeanStd both = mean_std(values);
    if (both.n > 0) rows.push_back({label, {both.mean, 0, both.n > 1 ? both.std : 0}, "#0072b2"});
  };
  reading("this run: slope of the flank", &ReposeAngle::angle);
  reading("this run: height over radius", &ReposeAngle::height_over_radius);
  reading("this run: height over half-covered radius", &ReposeAngle::half_coverage);
  for (const Comparison& row : result.comparison) {
    const ReferenceValue& reference = row.reference;
    if (reference.quantity != "angle") continue;
    rows.push_back({fmt::format("{} ({})", kind_in_words(reference.kind), reference.case_name),
                    {reference.value, 0, reference.std.value_or(0)},
                    reference.kind == "measured" ? "#000000" : "#d55e00"});
  }
  return rows;
}

Picture repose_chart(const std::vector<AngleRow>& rows, const std::filesystem::path& folder) {
  std::string blocks = "$a << END\n", ticks;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    blocks += fmt::format("{:.5g} {} {:.5g} {}\n", rows[i].value.x, -static_cast<int>(i), rows[i].value.std,
                          std::stoi(std::string(rows[i].colour).substr(1), nullptr, 16));
    ticks += fmt::format("{}{} {}", i ? ", " : "", gnuplot_quoted(rows[i].label), -static_cast<int>(i));
  }
  run_gnuplot(chart_terminal(760, 120 + 34 * static_cast<int>(rows.size())) +
                  fmt::format("set yrange [{}:0.6]\nset ytics ({})\n", 0.4 - static_cast<double>(rows.size()),
                              ticks) +
                  "set xlabel 'repose angle (degrees)'\nset offsets graph 0.08,graph 0.08,0,0\nunset key\n" +
                  blocks +
                  "END\nplot $a using ($1-$3):2:(2*$3):(0):4 with vectors nohead lw 1.2 lc rgb variable, "
                  "$a using 1:2:4 with points pt 7 ps 0.7 lc rgb variable\n",
              folder / "repose.svg");
  return {"Repose angle", folder / "repose.svg",
          "Readings of the heap beside printed ones; bars are one standard deviation."};
}

}  // namespace

std::vector<Picture> draw_charts(const RunResult& result, const SceneFacts& scene,
                                 const std::filesystem::path& folder) {
  const auto any = [&](auto has) { return std::any_of(result.seeds.begin(), result.seeds.end(), has); };
  std::vector<Picture> pictures;
  if (!simulated(result, [](const Section& s) { return s.chi; }).points.empty()) {
    add_picture(pictures, [&] { return chi_chart(result, folder); });
    add_picture(pictures, [&] { return diameters_chart(result, folder); });
    if (section_layout(result, 0)->sieves.size() > 1)
      add_picture(pictures, [&] { return passing_chart(result, folder); });
  }
  if (any(has_profile_line)) add_picture(pictures, [&] { return profile_chart(result, scene, folder); });
  if (const auto rows = angle_rows(result); !rows.empty())
    add_picture(pictures, [&] { return repose_chart(rows, folder); });
  return pictures;
}

}  // namespace scree
