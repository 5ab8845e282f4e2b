#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "analysis/cases/reproduction.h"
#include "analysis/cases/reproduction_figures.h"
#include "analysis/report/report_page.h"
#include "analysis/report/report_text.h"
#include "analysis/results/outputs.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

// Whether fine rock lies at the crest and coarse rock at the toe, in how many cases.
std::string signs_sentence(const std::vector<CaseResult>& cases) {
  int all = 0, as_expected = 0;
  for (const SegregationSigns& each : segregation_signs(cases))
    ++all, as_expected += each.as_expected == each.crest.n;
  if (all == 0) return "";
  return fmt::format(" In every seed of {} the crest is finer than the rock as dumped and the toe coarser.",
                     as_expected == all ? counted_text(static_cast<std::size_t>(all), "case") +
                                              ", all that have six sections,"
                                        : fmt::format("{} of {} cases", as_expected, all));
}

// The answer: how much of what is printed comes out again.
std::string lead(const ReproductionWords& words, const std::vector<CaseResult>& cases) {
  std::string items;
  for (const std::string& line : words.counts) items += fmt::format("<li>{}</li>\n", html_escaped(line));
  return fmt::format(
      "<p class=\"lead\"><strong>Of {} printed values and bounds {} agree</strong> within two standard "
      "deviations.{}</p>\n<ul>\n{}</ul>\n",
      words.judged, words.agreeing, html_escaped(signs_sentence(cases)), items);
}

std::string limits(const ReproductionWords& words, const std::vector<CaseResult>& cases) {
  double overlap = 0, lost = 0;
  for (const CaseResult& each : cases)
    overlap = std::max(overlap, each.largest_overlap), lost += each.lost_mass;
  std::string items;
  for (const std::string& line : words.runs) items += fmt::format("<li>{}</li>\n", html_escaped(line));
  if (overlap > 0.1)
    items += fmt::format(
        "<li>The largest overlap was {:.0f} % of the smaller radius: small spheres under large blocks, at "
        "the thesis's modulus.</li>\n",
        100 * overlap);
  if (lost > 0)
    items += fmt::format("<li>{} t in all runs together left the model.</li>\n", number_text(lost));
  if (items.empty()) return items;
  return "<div class=\"notes\" role=\"note\"><strong>Read with care</strong><ul>\n" + items + "</ul></div>\n";
}

std::string not_agreeing(const std::vector<CaseResult>& cases) {
  std::vector<Comparison> apart;
  for (const CaseResult& each : cases)
    std::copy_if(each.comparison.begin(), each.comparison.end(), std::back_inserter(apart),
                 [](const Comparison& row) { return verdict(row) == Verdict::differs; });
  if (apart.empty()) return "";
  return "<h2>What does not agree</h2>\n" + comparison_explained() + comparison_table(apart);
}

// Links to the cases below.
std::string contents(const std::vector<CaseResult>& cases) {
  std::string links;
  for (const CaseResult& each : cases)
    if (!each.runs.seeds.empty())
      links += fmt::format("{0}<a href=\"#{1}\">{1}</a>", links.empty() ? "" : ", ", html_escaped(each.name));
  return links.empty() ? links : fmt::format("<p>{}.</p>\n", links);
}

std::string signs_table(const std::vector<CaseResult>& cases) {
  std::string rows;
  for (const SegregationSigns& each : segregation_signs(cases)) {
    const auto p = [](const MeanStd& chi, double value) {
      return chi.n == 1 ? std::string("one seed") : html_escaped(p_text(value));
    };
    rows += fmt::format(
        "<tr><td class=\"word\">{}<small>{}</small></td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{} "
        "of "
        "{}</td><td>{}</td><td>{}</td></tr>\n",
        html_escaped(each.case_name), html_escaped(each.title), value_cell("chi", each.crest, ""),
        p(each.crest, each.p_crest), value_cell("chi", each.toe, ""), p(each.toe, each.p_toe),
        each.as_expected, each.crest.n, value_cell("chi", each.zero, ""),
        each.printed_zero ? number_text(*each.printed_zero, 2) : "–");
  }
  if (rows.empty()) return rows;
  return "<h2>Fine at the crest, coarse at the toe</h2>\n<p>p is the probability that seeds alone make so "
         "clear "
         "a sign, if chi is 0 (Student's t test over the seeds, one-sided: t = mean √n / deviation with n − "
         "1 "
         "degrees of freedom).</p>\n<div class=\"wide\"><table><thead><tr><th class=\"word\">Case</th><th>χ "
         "of "
         "S1</th><th>p of χ &lt; 0</th><th>χ of S6</th><th>p of χ &gt; 0</th><th>seeds with both "
         "signs</th><th>x/L where χ changes sign</th><th>printed</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string printed_interval(const PrintedHalf& by, bool relative) {
  if (!(by.half > 0)) return "no scatter printed";
  return (by.at_most ? "± at most " : "± ") +
         (relative ? decimals_text(100 * by.half, 0) + " %" : decimals_text(by.half, 2));
}

std::string velocity_table(const std::vector<CaseResult>& cases) {
  std::string rows;
  for (const VelocityTrend& each : velocity_trends(cases))
    rows += fmt::format(
        "<tr><td class=\"word\">{}</td><td class=\"word\">{}</td><td>{}</td><td>{}<small>{} to "
        "{}</small></td><td>{}</td><td>{}</td><td>{}<small>{} {} cases</small></td><td class=\"word "
        "{}\">{}</td></tr>\n",
        html_escaped(quantity_in_words(each.value.quantity)), each.value.section, each.runs,
        decimals_text(each.here.slope, 2), decimals_text(each.here.low, 2), decimals_text(each.here.high, 2),
        html_escaped(p_text(each.here.p)), html_escaped(p_text(each.order.p)),
        decimals_text(each.printed_slope, 2),
        std::isfinite(each.printed_slope) ? printed_interval(each.printed_slope_half, false) + "," : "",
        each.printed.size(), look(each.verdict).style, look(each.verdict).words);
  if (rows.empty()) return rows;
  return "<h2>Velocity of the blade</h2>\n<p>Least squares over all seeds of all cases of push dumping, "
         "with the 95 % interval of the slope and p of no slope (t, n − 2 degrees of freedom); p of no "
         "order by the test of Jonckheere and Terpstra (normal approximation with ties). Both are "
         "two-sided. PFC3D's slope is that of its printed means; ± is half of its 95 % interval, by the "
         "printed scatter of its repeats; a case without one takes the mean of the others'.</p>\n<div "
         "class=\"wide\"><table><thead><tr><th class=\"word\">Quantity</th><th "
         "class=\"word\">Section</th><th>Runs</th><th>Slope per m/s</th><th>p of the slope</th><th>p of the "
         "order</th><th>PFC3D's slope</th><th class=\"word\">Verdict</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string trends_table(const std::vector<TrendComparison>& trends) {
  if (trends.empty()) return "";
  std::string out =
      "<h2>Differences between cases</h2>\n<p>p is the probability that seeds alone differ so much (Welch's "
      "t test); below 0.05 a difference is taken to be beyond their scatter, which one in twenty is by "
      "chance. Percentages are over the magnitude of the second case's value. ± is half of the 95 % "
      "interval of a printed difference, by the printed scatter of PFC3D's repeats; a case without one "
      "takes the other's, and where only a bound of it is printed that stands for it. A printed size is "
      "excluded when the two differ by more than the root of the sum of the squares of both halves. Bounds "
      "(≤) are taken as exact.</p>\n<div class=\"wide\"><table><thead><tr><th class=\"word\">Case</th><th "
      "class=\"word\">against</th><th class=\"word\">Quantity</th><th "
      "class=\"word\">Section</th><th>Printed</th><th>Here</th><th>p</th><th class=\"word\">Verdict</th><th "
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
        "class=\"word\">{}</td><td>{}{}<small>{}</small></td><td>{}<small>{} to "
        "{}</small></td><td>{}</td><td class=\"word "
        "{}\">{}</td><td class=\"word\">{}</td></tr>\n",
        html_escaped(t.case_name), html_escaped(t.against), html_escaped(quantity_in_words(t.quantity)),
        html_escaped(t.section), t.bound ? "|·| ≤ " : "", text(t.difference),
        t.bound ? "" : printed_interval(row.printed, t.relative), text(row.difference), text(row.low),
        text(row.high), html_escaped(p_text(row.p)), look(row.verdict).style, look(row.verdict).words,
        html_escaped(t.source));
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::vector<std::string> write_reproduction(const std::vector<CaseResult>& cases,
                                            const std::vector<TrendComparison>& trends,
                                            const std::filesystem::path& folder) {
  const std::filesystem::path pictures = folder / "pictures";
  std::filesystem::create_directories(pictures);
  const ReproductionWords words = reproduction_in_words(cases, trends);
  std::string body = lead(words, cases) + limits(words, cases) + not_agreeing(cases);
  PageFigures shown;
  body += signs_table(cases) + velocity_table(cases);
  for (const Picture& picture : draw_velocity_trends(cases, pictures)) body += shown.figure(picture);
  body += trends_table(trends) + shown.figures("Figures", draw_figures(cases, pictures));
  body += "<h2>Every printed value</h2>\n" + contents(cases) + comparison_explained();
  double seconds = 0;
  std::size_t runs = 0;
  for (const CaseResult& each : cases) {
    seconds += each.runs.wall_seconds;
    runs += each.runs.seeds.size();
    if (each.runs.seeds.empty()) continue;
    body += fmt::format("<h3 id=\"{0}\">{0}: {1}, {2}</h3>\n", html_escaped(each.name),
                        html_escaped(each.title), counted_text(each.runs.seeds.size(), "seed"));
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
