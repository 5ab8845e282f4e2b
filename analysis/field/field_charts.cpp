#include "analysis/field/field_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "analysis/field/field_tables.h"
#include "analysis/report/profile_chart.h"
#include "analysis/report/report_text.h"
#include "analysis/report/section_canvas.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBlue = "#0072b2";
constexpr const char* kOrange = "#d55e00";
constexpr const char* kGreen = "#009e73";
constexpr int kColumns = 3, kWidth = 900, kPanelHeight = 250;

int rows_for(std::size_t panels) {
  return static_cast<int>((panels + kColumns - 1) / kColumns);
}

/// A page of panels, a section each; `panel` gives what is drawn in one, nothing where a section has no
/// values. False, and no page, if none has.
template <class Panel>
bool draw_panels(const std::vector<FieldSection>& sections, const std::string& common, Panel panel,
                 const fs::path& file) {
  std::string data;
  std::vector<std::string> panels;
  for (const FieldSection& section : sections)
    if (std::string drawn = panel(section, data); !drawn.empty()) panels.push_back(std::move(drawn));
  if (panels.empty()) return false;
  const int rows = rows_for(panels.size()),
            columns = std::min<int>(kColumns, static_cast<int>(panels.size()));
  run_gnuplot(fmt::format("{}{}{}set multiplot layout {},{} spacing 0.07,0.12\n{}unset multiplot\n",
                          chart_terminal(kWidth, rows * kPanelHeight + 40), common, data, rows, columns,
                          fmt::join(panels, "")),
              file);
  return true;
}

std::string range_of(const FieldAnalysis& field) {
  double low = INFINITY, high = 0;
  for (const FieldSection& section : field.sections)
    for (const EnvelopePoint& p : section.envelope) {
      if (p.high95 > 0.005) low = std::min(low, p.diameter);
      if (p.low95 < 0.995) high = std::max(high, p.diameter);
    }
  return fmt::format("set xrange [{:.4g}:{:.4g}]\nset logscale x\nset xtics ({})\n", low, high,
                     log_ticks(low, high));
}

Picture draw_envelopes(const FieldAnalysis& field, const fs::path& folder) {
  const fs::path file = folder / "envelopes.svg";
  std::string common = range_of(field) + "set yrange [0:100]\nunset key\n";
  common += "$whole << END\n";
  if (const Grading* whole = field.whole.curve(CurveKind::medians, false))
    for (const Grading::Point& p : whole->points())
      common += fmt::format("{} {}\n", p.diameter, 100 * p.passing);
  common += "END\n";
  const auto panel = [&](const FieldSection& section, std::string& blocks) {
    if (section.envelope.empty()) return std::string();
    blocks += fmt::format("${} << END\n", section.name);
    bool median_ended = false, mean_ended = false;  // a curve ends where it comes to 100 %
    for (const EnvelopePoint& p : section.envelope) {
      const auto curve = [](double share, bool& ended) {
        const std::string value = ended ? "NaN" : fmt::format("{}", 100 * share);
        ended = ended || share >= 1;
        return value;
      };
      blocks +=
          fmt::format("{} {} {} {} {} {} {}\n", p.diameter, 100 * p.low95, 100 * p.high95, 100 * p.low68,
                      100 * p.high68, curve(p.median, median_ended), curve(p.mean, mean_ended));
    }
    blocks += "END\n";
    return fmt::format(
        "set title '{0}' offset 0,-0.6\nset xlabel 'diameter (m)' offset 0,0.6\nset ylabel 'passing (%)' "
        "offset 1.5,0\n"
        "plot ${0} using 1:2:3 with filledcurves fs solid 0.15 lc rgb '{1}', '' using 1:4:5 with "
        "filledcurves "
        "fs solid 0.35 lc rgb '{1}', '' using 1:6 with lines lw 1.8 lc rgb '{1}', '' using 1:7 with lines lw "
        "1.2 dt 2 lc rgb '#333333', $whole using 1:2 with lines lw 1.2 lc rgb '{2}'\n",
        section.name, kBlue, kOrange);
  };
  draw_panels(field.sections, common, panel, file);
  return {
      "Passing curves of the sections", file,
      "The dark band holds 68 %, the light one 95 % of the pictures at each diameter; blue is their median, "
      "dashed their mean, orange the median of the whole slopes."};
}

std::string p_words(const NormalityTest& test) {
  return test.known ? fmt::format(", p {}", p_text(test.p)) : "";
}

/// Share of values that a bin at the middle of a normal distribution has.
double normal_peak(double width, double std) {
  return width / (std * std::sqrt(2 * std::numbers::pi));
}

std::optional<Picture> draw_histogram(const FieldAnalysis& field, const char* quantity,
                                      const fs::path& folder) {
  const fs::path file = folder / fmt::format("histogram_{}.svg", quantity);
  const FieldQuantity& what = *field_quantity(quantity);
  const bool length = what.unit[0] == 'm';
  double most = 0, low = INFINITY, high = 0;
  for (const FieldSection& section : field.sections) {
    if (!section.has(quantity)) continue;
    const Histogram bins = histogram(section.values.at(quantity), field.bin_of(quantity));
    const MeanStd both = mean_std(section.values.at(quantity));
    most = std::max(most, bins.shares[bins.mode()]);
    if (both.n > 1 && both.std > 0) most = std::max(most, normal_peak(bins.width, both.std));
    low = std::min(low, bins.middle(0) - bins.width / 2);
    high = std::max(high, bins.middle(bins.shares.size() - 1) + bins.width / 2);
  }
  const std::string common = fmt::format(
      "set yrange [0:{:.3g}]\nset xrange [{:.4g}:{:.4g}]\nset xtics {:.4g}\nunset key\nset style fill solid "
      "0.5\n",
      1.1 * most, low, high, round_number_above((high - low) / 6));
  const auto panel = [&](const FieldSection& section, std::string& blocks) {
    if (!section.has(quantity)) return std::string();
    const Histogram bins = histogram(section.values.at(quantity), field.bin_of(quantity));
    const Spread spread = section.spread(quantity);
    blocks += fmt::format("${} << END\n", section.name);
    for (std::size_t k = 0; k < bins.shares.size(); ++k)
      blocks += fmt::format("{} {}\n", bins.middle(k), bins.shares[k]);
    blocks += "END\n";
    // The normal distribution of the same mean and deviation, as the share that a bin would have.
    std::string normal;
    if (spread.moments.n > 1 && spread.moments.std > 0)
      normal = fmt::format(", {}*exp(-0.5*((x-{})/{})**2) with lines lw 1.4 lc rgb '{}'",
                           normal_peak(bins.width, spread.moments.std), spread.moments.mean,
                           spread.moments.std, kOrange);
    return fmt::format(
        "set title '{0}: n {1}{2}' offset 0,-0.6\nset xlabel '{3}' offset 0,0.6\nset ylabel 'share of "
        "pictures' "
        "offset 1.5,0\nset samples 400\n"
        "plot ${0} using 1:2:({4}) with boxes lc rgb '{5}'{6}\n",
        section.name, spread.moments.n, p_words(spread.normal),
        fmt::format("{}{}", length ? what.words : "Cu", length ? " (m)" : ""), bins.width, kBlue, normal);
  };
  if (!draw_panels(field.sections, common, panel, file)) return std::nullopt;
  return Picture{
      fmt::format("How {} differs from picture to picture", what.words), file,
      "Orange: the normal distribution of the same mean and deviation; p by Anderson and Darling: below "
      "0.05 the values do not "
      "scatter like one."};
}

std::optional<Picture> draw_chi(const FieldAnalysis& field, const fs::path& folder) {
  const fs::path file = folder / "chi.svg";
  ProfileChart chart{"Segregation along the slope",
                     "place along the slope x/L (0 crest, 1 toe)",
                     "segregation degree χ",
                     true,
                     {}};
  const auto add = [&](const char* quantity, const char* name, ChartSeries::Kind kind, int colour) {
    ChartSeries series{name, kind, colour, {}, name};
    for (const FieldSection& section : field.sections) {
      const MeanStd both = mean_std(section.values.at(quantity));
      if (both.n > 0) series.points.push_back({section.x_over_l, both.mean, both.std});
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  };
  add("chi", "of the gradings", ChartSeries::Kind::ours, 0);
  add("chi_given", "as given in the table", ChartSeries::Kind::measured, 1);
  if (chart.series.empty()) return std::nullopt;
  draw(chart, file);
  return Picture{"Segregation along the slope", file, "Mean and standard deviation over the pictures."};
}

std::optional<Picture> draw_chi_fit(const FieldAnalysis& field, const fs::path& folder) {
  const fs::path file = folder / "chi_fit.svg";
  // Of the degrees that the table gives, where it gives them.
  const bool given = std::any_of(field.sections.begin(), field.sections.end(),
                                 [](const FieldSection& s) { return s.chi_given_fit.n > 1; });
  const char* quantity = given ? "chi_given" : "chi";
  const auto& x = field.d90_over_d15;
  const double right = 1.05 * sample_quantile(x, 1);
  const std::string common = fmt::format("set xrange [0:{:.4g}]\nset xtics autofreq\nunset key\n", right);
  double low = 0, high = 0;
  for (const FieldSection& section : field.sections) {
    const Spread spread = section.spread(quantity);
    if (spread.moments.n > 0) low = std::min(low, spread.min), high = std::max(high, spread.max);
  }
  const auto panel = [&](const FieldSection& section, std::string& blocks) {
    const OriginFit& fit = given ? section.chi_given_fit : section.chi_fit;
    if (fit.n < 2) return std::string();
    blocks += fmt::format("${} << END\n", section.name);
    for (std::size_t i = 0; i < x.size(); ++i)
      if (std::isfinite(section.values.at(quantity)[i]) && std::isfinite(x[i]))
        blocks += fmt::format("{} {}\n", x[i], section.values.at(quantity)[i]);
    blocks += "END\n";
    return fmt::format(
        "set title '{0}: {1:.3f} x, R² {2:.2f}, about the mean {3:.2f}' offset 0,-0.6 font ',10'\n"
        "set xlabel 'D90 / D15 of the rock as dumped' offset 0,0.6\nset ylabel 'χ' offset 0.4,0\nset yrange "
        "[{4}:{5}]\n"
        "plot 0 with lines lc rgb '#888888', ${0} using 1:2 with points pt 7 ps 0.5 lc rgb '{6}', {1}*x with "
        "lines lw 1.6 lc rgb '{7}'\n",
        section.name, fit.slope, fit.r2, fit.r2_of_mean, low - 0.1, high + 0.1, kBlue, kOrange);
  };
  if (!draw_panels(field.sections, common, panel, file)) return std::nullopt;
  return Picture{
      "Segregation degree against D90 / D15", file,
      fmt::format("χ {}, with the line through the origin. R² of such a line is about zero; where R² "
                  "about the mean is below 0, the "
                  "mean alone says more than the line.",
                  given ? "as given in the table" : "of the gradings")};
}

std::optional<Picture> draw_ksat(const FieldAnalysis& field, const fs::path& folder) {
  const fs::path file = folder / "ksat.svg";
  const std::string of = field.options.sieved ? "_filled" : "";
  std::string data;
  struct Formula {
    const char *name, *words, *colour;
    double shift;
  };
  constexpr Formula formulae[] = {{"ksat_kcm_rel", "Kozeny-Carman", kBlue, -0.012},
                                  {"ksat_taylor_rel", "Taylor", kOrange, 0.012}};
  bool along = false, over = false;  // there is something to be drawn
  for (const Formula& formula : formulae) {
    data += fmt::format("${} << END\n", formula.name);
    for (const FieldSection& section : field.sections) {
      const Spread s = section.spread(formula.name + of);
      if (s.moments.n == 0) continue;
      along = true;
      data += fmt::format("{} {} {} {} {} {}\n", section.x_over_l + formula.shift, s.median, s.low68,
                          s.high68, s.low95, s.high95);
    }
    data += fmt::format("END\n$ratio_{} << END\n", formula.name);
    std::vector<double> ratios =
        ratio_over_pictures(field.sections.back(), field.sections.front(), formula.name);
    std::erase_if(ratios, [](double r) { return !std::isfinite(r); });
    std::sort(ratios.begin(), ratios.end());
    over = over || !ratios.empty();
    for (std::size_t i = 0; i < ratios.size(); ++i)
      data += fmt::format("{} {}\n", ratios[i],
                          (static_cast<double>(i) + 0.5) / static_cast<double>(ratios.size()));
    data += "END\n";
  }
  if (!along) return std::nullopt;
  std::string script =
      chart_terminal(over ? kWidth : kWidth / 2, 430) + data +
      fmt::format(
          "set multiplot layout 1,{} margins {},0.98,0.15,0.9 spacing 0.12\nset logscale y\nset format y "
          "'%g'\nset grid\n",
          over ? 2 : 1, over ? 0.11 : 0.2);
  script += fmt::format(
      "set title {}\nset xlabel 'x/L along the slope (0 crest, 1 toe)'\nset ylabel 'over that of the rock as "
      "dumped'\nset xrange [0:1]\nset key top left reverse Left\n",
      gnuplot_quoted(field.options.sieved ? "Conductivity of the sections, with fines"
                                          : "Conductivity of the sections"));
  std::string plots;
  for (const Formula& f : formulae)
    plots += fmt::format(
        "{0}${1} using 1:3:(0):($4-$3) with vectors nohead lw 3 lc rgb '{2}' notitle, '' using "
        "1:5:(0):($6-$5) with "
        "vectors nohead lw 1 lc rgb '{2}' notitle, '' using 1:2 with linespoints pt 7 ps 0.6 lc rgb '{2}' "
        "title '{3}'",
        plots.empty() ? "plot 1 with lines lc rgb '#888888' notitle, " : ", ", f.name, f.colour, f.words);
  script += plots + "\n";
  if (over) {
    script += fmt::format(
        "unset logscale y\nset logscale x\nset format y\nset format x '%g'\nset xrange [*:*]\nset yrange "
        "[0:1]\nset title {}\nset xlabel '{} over {}'\nset ylabel 'share of the pictures below'\nset key top "
        "left\n",
        gnuplot_quoted("Toe over crest, picture by picture, as seen"), field.sections.back().name,
        field.sections.front().name);
    plots.clear();
    for (const Formula& f : formulae)
      plots += fmt::format("{}$ratio_{} using 1:2 with points pt 7 ps 0.5 lc rgb '{}' title '{}'",
                           plots.empty() ? "plot " : ", ", f.name, f.colour, f.words);
    script += plots + "\n";
  }
  run_gnuplot(script + "unset multiplot\n", file);
  return Picture{
      "Hydraulic conductivity", file,
      fmt::format("At equal void ratio. {}edian of the pictures, thick bars hold 68 %, thin ones 95 "
                  "%.{}",
                  over ? "Left: m" : "M", over ? " Right: every picture." : "")};
}

Picture draw_correction(const FieldAnalysis& field, const fs::path& folder) {
  const fs::path file = folder / "correction.svg";
  const Grading &seen = *field.whole.curve(CurveKind::medians, false),
                &filled = *field.whole.curve(CurveKind::medians, true), &sieved = *field.options.sieved;
  std::string script = chart_terminal(760, 430);
  const auto block = [&](const char* name, const Grading& grading) {
    script += fmt::format("${} << END\n", name);
    for (const Grading::Point& p : grading.points())
      script += fmt::format("{} {}\n", p.diameter, 100 * p.passing);
    script += "END\n";
  };
  block("seen", seen), block("filled", filled), block("sieved", sieved);
  const double low = filled.diameter(0.0), high = filled.max_diameter();
  script += fmt::format(
      "set logscale x\nset format x '%g'\nset xrange [{0:.4g}:{1:.4g}]\nset yrange [0:100]\nset xlabel "
      "'diameter (m)'\n"
      "set ylabel 'passing (%)'\nset key top left reverse Left\n"
      // A curve, not an arrow: gnuplot draws arrows of an SVG solid.
      "$limit << END\n{2:.6g} 0\n{2:.6g} 100\nEND\n",
      low, high, field.options.limit);
  script += fmt::format(
      "plot $limit using 1:2 with lines lw 1.6 dt 3 lc rgb '#555555' notitle, $sieved using 1:2 with lines "
      "lw 1.4 lc rgb '{}' title 'sieved sample', $seen using 1:2 with "
      "lines lw 1.6 lc "
      "rgb '{}' title 'as seen, Cu {:.1f}', $filled using 1:2 with lines lw 2 lc rgb '{}' title 'with fines, "
      "Cu {:.1f}'\n",
      kGreen, kBlue, seen.cu(), kOrange, filled.cu());
  run_gnuplot(script, file);
  return {"Fines that pictures do not see", file,
          fmt::format("Whole slope, medians of the pictures; below {:.3g} m (dotted) its share of {:.0f} % "
                      "is distributed as the sieved sample.",
                      field.options.limit, 100 * seen.passing(field.options.limit))};
}

}  // namespace

std::vector<Picture> draw_field(const FieldAnalysis& field, const fs::path& folder) {
  std::vector<Picture> pictures;
  add_picture(pictures, [&] { return draw_envelopes(field, folder); });
  for (const char* quantity : kHistogramQuantities)
    add_picture(pictures, [&] { return draw_histogram(field, quantity, folder); });
  add_picture(pictures, [&] { return draw_chi(field, folder); });
  add_picture(pictures, [&] { return draw_chi_fit(field, folder); });
  if (field.whole.curve(CurveKind::medians, true) != nullptr)
    add_picture(pictures, [&] { return draw_correction(field, folder); });
  add_picture(pictures, [&] { return draw_ksat(field, folder); });
  return pictures;
}

}  // namespace scree
