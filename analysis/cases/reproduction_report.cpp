#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "analysis/cases/reproduction.h"
#include "analysis/report/profile_chart.h"
#include "analysis/report/report_page.h"
#include "analysis/report/report_text.h"
#include "analysis/results/outputs.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

// A figure of the thesis: a quantity along the slope, of several cases.
struct FigureSpec {
  const char *figure, *file, *title;
  const char *quantity, *label;
  int sections;
  int dumps;  // after which the pile is looked at; 0: at the end
  std::vector<const char*> cases;
};

const std::vector<FigureSpec>& figure_specs() {
  static const char* const kChi = "segregation degree χ";
  static const char* const kD50 = "D50 over that as dumped";
  static const std::vector<FigureSpec> specs{
      {"5.8", "lab_d10", "Laboratory, D10 of the surface cells", "d10", "D10 (m)", 3, 0, {"lab_segregation"}},
      {"5.9", "lab_d50", "Laboratory, D50 of the surface cells", "d50", "D50 (m)", 3, 0, {"lab_segregation"}},
      {"5.9", "lab_d80", "Laboratory, D80 of the surface cells", "d80", "D80 (m)", 3, 0, {"lab_segregation"}},
      {"5.10", "lab_chi", "Laboratory, segregation degree", "chi", kChi, 3, 0, {"lab_segregation"}},
      {"5.11", "cm_d50", "Canadian Malartic, D50, three sections", "d50", "D50 (m)", 3, 3, {"c1"}},
      {"5.12", "cm_chi", "Canadian Malartic, three sections", "chi", kChi, 3, 3, {"c1"}},
      {"5.12", "cm_chi6", "Canadian Malartic, six sections", "chi", kChi, 6, 0, {"c1"}},
      {"5.13", "qb_d50", "Quebrada Blanca, D50, nine sections", "d50", "D50 (m)", 9, 0, {"a3"}},
      {"5.14", "qb_d80", "Quebrada Blanca, D80, nine sections", "d80", "D80 (m)", 9, 0, {"a3"}},
      {"6.5", "height_chi", "Height of the bench", "chi", kChi, 6, 0, {"a1", "a2", "a3", "a4"}},
      {"6.5", "height_d50", "Height of the bench", "d50_rel", kD50, 6, 0, {"a1", "a2", "a3", "a4"}},
      {"6.6", "grading_chi", "Grading of the rock", "chi", kChi, 6, 0, {"a1", "c1"}},
      {"6.6", "grading_d50", "Grading of the rock", "d50_rel", kD50, 6, 0, {"a1", "c1"}},
      {"6.7", "payload_chi", "Payload", "chi", kChi, 6, 0, {"a1", "b1"}},
      {"6.7", "payload_d50", "Payload", "d50_rel", kD50, 6, 0, {"a1", "b1"}},
      {"6.8", "method_chi", "End dumping and push dumping", "chi", kChi, 6, 0, {"a1", "d2"}},
      {"6.8", "method_d50", "End dumping and push dumping", "d50_rel", kD50, 6, 0, {"a1", "d2"}},
      {"6.9", "push_chi", "Velocity of the blade", "chi", kChi, 6, 0, {"d1", "d2", "d3", "d4", "d5", "d6"}},
      {"6.9",
       "push_d50",
       "Velocity of the blade",
       "d50_rel",
       kD50,
       6,
       0,
       {"d1", "d2", "d3", "d4", "d5", "d6"}},
      {"6.10",
       "push_speed",
       "Mean speed of moving rock",
       "flow_speed",
       "speed (m/s)",
       6,
       0,
       {"a1", "d1", "d6"}},
      {"6.12",
       "lateral_chi",
       "Distance of the dump points",
       "chi",
       kChi,
       6,
       0,
       {"a1", "lateral_s4", "lateral_s8", "lateral_s12"}},
      {"6.13",
       "lateral_std",
       "Deviation of χ across the slope",
       "lateral_chi_std",
       "deviation of χ over strips",
       6,
       0,
       {"a1", "lateral_s4", "lateral_s8", "lateral_s12"}},
  };
  return specs;
}

double x_over_l(int section, int sections) {
  return (2.0 * section - 1) / (2.0 * sections);
}

// S4 -> 4, bottom -> 3; 0 for none.
int section_number(const std::string& name) {
  if (name == "top") return 1;
  if (name == "middle") return 2;
  if (name == "bottom") return 3;
  return name.size() == 2 && name[0] == 'S' ? name[1] - '0' : 0;
}

ChartSeries ours(const CaseResult& result, const FigureSpec& spec, int colour) {
  ChartSeries series{result.name, ChartSeries::Kind::ours, colour, {}};
  static const char* const kCells[] = {"top", "middle", "bottom"};
  for (int k = 1; k <= spec.sections; ++k) {
    const PileValue what{spec.quantity, spec.sections == 3 ? kCells[k - 1] : fmt::format("S{}", k),
                         spec.sections, spec.dumps};
    const MeanStd both =
        spread_of(result.runs.seeds, [&](const Outputs& seed) { return output_for(what, seed); });
    if (both.n > 0) series.points.push_back({x_over_l(k, spec.sections), both.mean, both.std});
  }
  return series;
}

ChartSeries printed(const CaseResult& result, const FigureSpec& spec, ChartSeries::Kind kind, int colour) {
  ChartSeries series{result.name, kind, colour, {}};
  for (const Comparison& row : result.comparison) {
    const ReferenceValue& r = row.reference;
    if (r.quantity != spec.quantity || meaning_of(r) != Meaning::value || section_count(r) != spec.sections)
      continue;
    if ((r.kind == "measured") != (kind == ChartSeries::Kind::measured)) continue;
    if (const int k = section_number(r.section); k > 0)
      series.points.push_back({x_over_l(k, spec.sections), r.value, r.std.value_or(std::nan(""))});
  }
  std::sort(series.points.begin(), series.points.end(),
            [](const auto& a, const auto& b) { return a.x < b.x; });
  return series;
}

std::vector<Picture> draw_figures(const std::vector<CaseResult>& cases, const std::filesystem::path& folder) {
  std::vector<Picture> pictures;
  for (const FigureSpec& spec : figure_specs()) {
    ProfileChart chart{spec.title,
                       std::string_view(spec.file).starts_with("lab")
                           ? "place on the cone (0 top, 1 bottom)"
                           : "place along the slope x/L (0 crest, 1 toe)",
                       spec.label,
                       std::string_view(spec.quantity) == "chi",
                       {}};
    int colour = 0;
    for (const char* name : spec.cases) {
      const auto found =
          std::find_if(cases.begin(), cases.end(), [&](const CaseResult& each) { return each.name == name; });
      if (found != cases.end()) {
        ChartSeries here = ours(*found, spec, colour);
        if (!here.points.empty()) {
          chart.series.push_back(std::move(here));
          for (const auto kind : {ChartSeries::Kind::pfc3d, ChartSeries::Kind::measured})
            if (ChartSeries theirs = printed(*found, spec, kind, colour); !theirs.points.empty())
              chart.series.push_back(std::move(theirs));
        }
      }
      ++colour;
    }
    if (chart.series.empty()) continue;
    const auto file = folder / fmt::format("{}.svg", spec.file);
    add_picture(pictures, [&] {
      draw(chart, file);
      return Picture{
          fmt::format("{}: {} (figure {} of the thesis)", spec.title, spec.label, spec.figure), file,
          "Dots with a line: mean and standard deviation of the seeds simulated here. Squares: PFC3D; "
          "triangles: measured; both where the thesis prints numbers." +
              std::string(spec.dumps > 0 ? fmt::format(" Simulated after load {}.", spec.dumps) : "")};
    });
  }
  return pictures;
}

std::string limits(const std::vector<CaseResult>& cases) {
  double overlap = 0, lost = 0;
  for (const CaseResult& each : cases)
    overlap = std::max(overlap, each.largest_overlap), lost += each.lost_mass;
  std::string items;
  if (overlap > 0.1)
    items += fmt::format(
        "<li>The largest overlap was {:.0f} % of the smaller radius: small spheres under large blocks, at "
        "the "
        "thesis's modulus.</li>\n",
        100 * overlap);
  if (lost > 0)
    items += fmt::format("<li>{} t in all runs together left the model.</li>\n", number_text(lost));
  if (items.empty()) return items;
  return "<div class=\"notes\" role=\"note\"><strong>Read with care</strong><ul>\n" + items + "</ul></div>\n";
}

std::string signs_table(const std::vector<CaseResult>& cases) {
  std::string rows;
  for (const SegregationSigns& each : segregation_signs(cases)) {
    const auto p = [](const MeanStd& chi, double value) {
      return chi.n == 1 ? std::string("one seed") : html_escaped(p_text(value));
    };
    rows += fmt::format(
        "<tr><td class=\"word\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{} of "
        "{}</td><td>{}</td>"
        "<td>{}</td></tr>\n",
        html_escaped(each.case_name), value_cell("chi", each.crest, ""), p(each.crest, each.p_crest),
        value_cell("chi", each.toe, ""), p(each.toe, each.p_toe), each.as_expected, each.signs,
        value_cell("chi", each.zero, ""), each.printed_zero ? number_text(*each.printed_zero, 2) : "–");
  }
  if (rows.empty()) return rows;
  return "<h2>Fine at the crest, coarse at the toe</h2>\n<p>p is the probability that seeds alone make so "
         "clear "
         "a sign, if chi is 0 (Student's t test over the seeds, one-sided: t = mean √n / deviation with n − "
         "1 "
         "degrees of freedom).</p>\n<div class=\"wide\"><table><thead><tr><th class=\"word\">Case</th><th>χ "
         "of "
         "S1</th><th>p of χ &lt; 0</th><th>χ of S6</th><th>p of χ &gt; 0</th><th>signs as expected, of all "
         "seeds</th><th>x/L where χ changes sign</th><th>printed</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string velocity_table(const std::vector<CaseResult>& cases) {
  std::string rows;
  for (const VelocityTrend& each : velocity_trends(cases))
    rows += fmt::format(
        "<tr><td class=\"word\">{}</td><td class=\"word\">{}</td><td>{}</td><td>{}<small>{} to "
        "{}</small></td><td>{}</td><td>{}</td><td>{}<small>{} cases</small></td></tr>\n",
        html_escaped(quantity_in_words(each.value.quantity)), each.value.section, each.runs,
        decimals_text(each.here.slope, 2), decimals_text(each.here.low, 2), decimals_text(each.here.high, 2),
        html_escaped(p_text(each.here.p)), html_escaped(p_text(each.order.p)),
        decimals_text(each.printed_slope, 2), each.printed_cases);
  if (rows.empty()) return rows;
  return "<h2>Velocity of the blade</h2>\n<p>Least squares over all seeds of all cases of push dumping, with "
         "the "
         "95 % interval of the slope and p of no slope (t, n − 2 degrees of freedom); p of no order by the "
         "test "
         "of Jonckheere and Terpstra (normal approximation with ties). Both are two-sided. PFC3D's slope is "
         "that "
         "of its printed means.</p>\n<div class=\"wide\"><table><thead><tr><th "
         "class=\"word\">Quantity</th><th "
         "class=\"word\">Section</th><th>Runs</th><th>Slope per m/s</th><th>p of the slope</th><th>p of the "
         "order</th><th>PFC3D's slope</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

struct TrendLook {
  const char *style, *words;
};

TrendLook look(TrendVerdict verdict) {
  switch (verdict) {
    case TrendVerdict::agrees:
      return {"close", "same direction and size"};
    case TrendVerdict::other_size:
      return {"agrees", "same direction, other size"};
    case TrendVerdict::opposite:
      return {"differs", "opposite direction"};
    case TrendVerdict::within:
      return {"close", "within the bound"};
    case TrendVerdict::beyond:
      return {"differs", "beyond the bound"};
    case TrendVerdict::undecided:
      return {"unknown", "not decided by these seeds"};
    case TrendVerdict::unknown:
      break;
  }
  return {"unknown", "not judged: two seeds of both are needed"};
}

std::string trends_table(const std::vector<TrendComparison>& trends) {
  if (trends.empty()) return "";
  std::string out =
      "<h2>Differences between cases</h2>\n<p>p is the probability that seeds alone differ so much (Welch's "
      "t "
      "test); below 0.05 a difference is taken to be beyond their scatter, which one in twenty is by chance. "
      "Percentages are over the magnitude of the "
      "second "
      "case's value.</p>\n<div class=\"wide\"><table><thead><tr><th class=\"word\">Case</th><th "
      "class=\"word\">against</th><th class=\"word\">Quantity</th><th "
      "class=\"word\">Section</th><th>Printed</th>"
      "<th>Here</th><th>p</th><th class=\"word\">Verdict</th><th "
      "class=\"word\">Source</th></tr></thead><tbody>\n";
  for (const TrendComparison& row : trends) {
    const Trend& t = row.trend;
    const auto text = [&](double value) {
      return !std::isfinite(value) ? std::string("–")
             : t.relative          ? decimals_text(100 * value, 0) + " %"
                                   : decimals_text(value, 2);
    };
    out += fmt::format(
        "<tr><td class=\"word\">{}</td><td class=\"word\">{}</td><td class=\"word\">{}</td><td "
        "class=\"word\">{}</td><td>{}{}</td><td>{}<small>{} to {}</small></td><td>{}</td><td class=\"word "
        "{}\">{}</td><td class=\"word\">{}</td></tr>\n",
        html_escaped(t.case_name), html_escaped(t.against), html_escaped(quantity_in_words(t.quantity)),
        html_escaped(t.section), t.bound ? "|·| ≤ " : "", text(t.difference), text(row.difference),
        text(row.low), text(row.high), html_escaped(p_text(row.p)), look(row.verdict).style,
        look(row.verdict).words, html_escaped(t.source));
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::vector<std::string> write_reproduction(const std::vector<CaseResult>& cases,
                                            const std::vector<TrendComparison>& trends,
                                            const std::filesystem::path& folder) {
  const std::filesystem::path pictures = folder / "pictures";
  std::filesystem::create_directories(pictures);
  const std::vector<std::string> words = reproduction_in_words(cases, trends);
  const auto list = [&](const char* heading, auto&& chosen) {
    std::string items;
    for (const std::string& line : words)
      if (chosen(line)) items += fmt::format("<li>{}</li>\n", html_escaped(line));
    return items.empty() ? items : fmt::format("{}\n<ul>\n{}</ul>\n", heading, items);
  };
  const auto counts = [](const std::string& line) {
    return std::isdigit(static_cast<unsigned char>(line[0])) || line.starts_with("of ");
  };
  const auto against = [](const std::string& line) { return line.starts_with("does not agree"); };
  std::string body = list("<h2>What agrees and what does not</h2>", counts) +
                     list("<h3>Not within two standard deviations</h3>", against) +
                     list("<h3>Signs, trends, runs</h3>",
                          [&](const std::string& line) { return !counts(line) && !against(line); }) +
                     limits(cases) + signs_table(cases) + velocity_table(cases) + trends_table(trends);
  PageFigures shown;
  body += shown.figures("Figures", draw_figures(cases, pictures));
  body += "<h2>Every printed value</h2>\n";
  double seconds = 0;
  std::size_t runs = 0;
  for (const CaseResult& each : cases) {
    seconds += each.runs.wall_seconds;
    runs += each.runs.seeds.size();
    if (each.runs.seeds.empty()) continue;
    body += fmt::format("<h3>{}: {}, {} seed{}</h3>\n", html_escaped(each.name), html_escaped(each.title),
                        each.runs.seeds.size(), each.runs.seeds.size() == 1 ? "" : "s");
    body += each.comparison.empty() ? "<p>Nothing is printed for this case alone.</p>\n"
                                    : comparison_table(each.comparison);
  }
  write_text_file(
      folder / "report.html",
      html_page("The thesis's cases, simulated again",
                fmt::format("{} runs, {} of computing on one core", runs, duration_text(seconds)), body));
  return shown.missing();
}

}  // namespace scree
