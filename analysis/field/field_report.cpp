#include "analysis/field/field_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/field/field_charts.h"
#include "analysis/field/field_tables.h"
#include "analysis/report/report_page.h"
#include "analysis/report/report_text.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

constexpr double kSignificant = 0.05;
constexpr double kChiDiffers = 0.1;  // above what tables printed to two digits can make

std::string table(const std::string& head, const std::string& rows) {
  return fmt::format(
      "<div class=\"wide\"><table><thead><tr>{}</tr></thead><tbody>\n{}</tbody></table></div>\n", head, rows);
}

/// Three digits, or powers of ten where they would not show.
std::string any_size(double value) {
  if (!std::isfinite(value)) return "–";
  return value != 0 && (std::abs(value) < 1e-3 || std::abs(value) >= 1e5) ? fmt::format("{:.1e}", value)
                                                                          : number_text(value);
}

std::string section_table(const FieldAnalysis& field) {
  constexpr const char* shown[] = {"d10",       "d50",     "d80",     "cu",     "chi",
                                   "chi_given", "d10_rel", "d50_rel", "d80_rel"};
  std::string head = "<th class=\"word\">Section</th><th>x/L</th>", rows;
  for (const char* name : shown)
    if (field.sections.front().has(name))
      head += fmt::format("<th>{}</th>", html_escaped(field_quantity(name)->words));
  const auto row = [&](const FieldSection& section) {
    rows += fmt::format("<tr><td class=\"word\">{}</td><td>{}</td>", section.name,
                        decimals_text(section.x_over_l, 2));
    for (const char* name : shown) {
      if (!field.sections.front().has(name)) continue;
      if (!section.has(name)) {
        rows += "<td>–</td>";
        continue;
      }
      const Spread s = section.spread(name);
      rows += fmt::format("<td>{}<small>median {}</small></td>",
                          value_cell(name, s.moments, field_quantity(name)->unit), number_text(s.median));
    }
    rows += "</tr>\n";
  };
  if (field.whole.has("d50")) row(field.whole);
  for (const FieldSection& section : field.sections) row(section);
  return "<h2>Sections</h2>\n<p>Mean and standard deviation over the pictures, and the median.</p>\n" +
         table(head, rows);
}

std::string normality_table(const FieldAnalysis& field) {
  constexpr const char* shown[] = {"d10", "d50", "d80", "cu", "chi"};
  std::string head = "<th class=\"word\">Section</th>", rows;
  for (const char* name : shown)
    head += fmt::format("<th>{}</th>", html_escaped(field_quantity(name)->words));
  const auto cell = [](const NormalityTest& test) {
    return test.known
               ? fmt::format("<span class=\"{}\">{}</span>", test.p < kSignificant ? "differs" : "agrees",
                             html_escaped(p_text(test.p)))
               : std::string("–");
  };
  for (const FieldSection& section : field.sections) {
    rows += fmt::format("<tr><td class=\"word\">{}</td>", section.name);
    for (const char* name : shown) {
      const Spread s = section.spread(name);
      rows += fmt::format("<td>{}<small>logarithms {}</small></td>", cell(s.normal), cell(s.lognormal));
    }
    rows += "</tr>\n";
  }
  return "<h2>Gaussian or not</h2>\n<p>p of Anderson and Darling's test that the values scatter like a "
         "normal distribution, and that their "
         "logarithms do; below 0.05 they do not.</p>\n" +
         table(head, rows);
}

std::string fit_table(const FieldAnalysis& field) {
  std::string rows;
  for (const FieldSection& section : field.sections)
    for (const bool given : {false, true}) {
      const OriginFit& fit = given ? section.chi_given_fit : section.chi_fit;
      if (fit.n < 2) continue;
      rows += fmt::format(
          "<tr><td class=\"word\">{}</td><td class=\"word\">{}</td><td>{}</td><td>{}<small>± "
          "{}</small></td><td>{}</td><td>{}</td></tr>\n",
          section.name, given ? "given" : "of gradings", fit.n, decimals_text(fit.slope, 3),
          decimals_text(fit.error, 3), decimals_text(fit.r2, 2), decimals_text(fit.r2_of_mean, 2));
    }
  return "<h2>χ against D90 / D15</h2>\n<p>Lines through the origin. R² of such a line counts from zero, and "
         "is large wherever the values "
         "have one sign; R² about the mean is below 0 where a constant fits better than the line.</p>\n" +
         table(
             "<th class=\"word\">Section</th><th "
             "class=\"word\">χ</th><th>Pictures</th><th>Slope</th><th>R²</th><th>R² about the mean</th>",
             rows);
}

std::string ksat_table(const FieldAnalysis& field) {
  std::string rows;
  for (const ConductivityRow& r : conductivity_rows(field))
    rows += fmt::format(
        "<tr><td class=\"word\">{}</td><td class=\"word\">{}, "
        "{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>"
        "<td>{}</td><td>{}</td></tr>\n",
        r.section, curve_in_words(r.kind), r.filled ? "with fines" : "as seen", any_size(r.d10),
        any_size(r.d50), number_text(r.cu), any_size(r.kozeny_carman_rel), any_size(r.taylor_rel),
        any_size(r.taylor_rel_square), any_size(100 * r.kozeny_carman), any_size(r.kozeny_carman),
        any_size(r.taylor));
  return fmt::format(
             "<h2>Hydraulic conductivity</h2>\n<p>Of the curves that can stand for a section in all pictures "
             "(medians or means of the shares passing, means of the diameters), over that of the rock as "
             "dumped, {}, at equal void ratio; and as numbers at a void ratio of {}. The modified "
             "Kozeny-Carman formula gives cm/s for D10 in cm and the unit weight in kN/m³ (C_G 0.1; in SI "
             "units 0.01). Taylor's formula has the square of D50; the thesis's ratios follow from a power "
             "of "
             "1.5, with which its constant of 0.004 would need the unit of a root of a length. Both hold for "
             "laminar flow in soils: for blocks only ratios mean something.</p>\n",
             field.options.original ? "the original grading given" : "the same curve of the whole slopes",
             number_text(field.options.void_ratio)) +
         table(
             "<th class=\"word\">Section</th><th class=\"word\">Curve</th><th>D10 m</th><th>D50 "
             "m</th><th>Cu</th><th>Kozeny-Carman over rock as dumped</th><th>Taylor, D50<sup>1.5</sup>, over "
             "rock as dumped</th><th>Taylor, D50², over rock as dumped</th><th>Kozeny-Carman "
             "cm/s</th><th>m/s</th><th>Taylor, D50², m/s</th>",
             rows);
}

std::string given_table(const FieldAnalysis& field) {
  if (!field.sections.front().has("chi_given")) return "";
  std::string rows;
  for (std::size_t i = 0; i < field.pictures.size(); ++i) {
    double largest = 0;
    std::string cells;
    for (const FieldSection& section : field.sections) {
      const double given = section.values.at("chi_given")[i], ours = section.values.at("chi")[i];
      if (std::isfinite(ours - given)) largest = std::max(largest, std::abs(ours - given));
      const bool differs = std::abs(ours - given) > kChiDiffers;
      cells += fmt::format("<td{}>{}<small>given {}</small></td>", differs ? " class=\"differs\"" : "",
                           decimals_text(ours, 2), decimals_text(given, 2));
    }
    rows += fmt::format("<tr><td class=\"word\">{}</td>{}<td>{}</td></tr>\n", html_escaped(field.pictures[i]),
                        cells, decimals_text(largest, 2));
  }
  std::string head = "<th class=\"word\">Picture</th>";
  for (const FieldSection& section : field.sections) head += fmt::format("<th>{}</th>", section.name);
  return fmt::format(
             "<h2>χ of the gradings beside χ as given</h2>\n<p>Differences above {} are shaded.</p>\n",
             kChiDiffers) +
         table(head + "<th>largest difference</th>", rows);
}

std::string verdict_style(PrintedVerdict verdict) {
  switch (verdict) {
    case PrintedVerdict::as_printed:
      return "close";
    case PrintedVerdict::within_reach:
      return "agrees";
    case PrintedVerdict::differs:
      return "differs";
    case PrintedVerdict::not_computable:
      break;
  }
  return "unknown";
}

std::string printed_table(const std::vector<HeldValue>& printed) {
  if (printed.empty()) return "";
  std::string rows;
  for (const HeldValue& held : printed) {
    const PrintedValue& p = held.printed;
    const std::string unit = p.unit == "-" ? "" : fmt::format(" {}", html_escaped(p.unit));
    rows += fmt::format(
        "<tr><td class=\"word\">{}</td><td>{}{}{}</td><td>{}{}<small>{}</small></td><td class=\"word "
        "{}\">{}</td><td class=\"word\">{}</td></tr>\n",
        html_escaped(p.what),
        p.bound_below   ? "&gt; "
        : p.bound_above ? "&lt; "
                        : "",
        number_text(p.value), unit, held.ours ? number_text(*held.ours) : "–", held.ours ? unit : "",
        held.ours && held.high > held.low
            ? fmt::format("{} to {}", number_text(held.low), number_text(held.high))
            : "",
        verdict_style(held.verdict), verdict_in_words(held.verdict), html_escaped(p.source));
  }
  return "<h2>Beside what was printed</h2>\n<p>Below ours: what it can be, given the rounding of the "
         "diameters in the table.</p>\n" +
         table(
             "<th class=\"word\">Number</th><th>Printed</th><th>Here</th><th class=\"word\">Verdict</th><th "
             "class=\"word\">Source</th>",
             rows);
}

/// Over pictures, as `format` has it; a dash where none has it.
std::string mean_in_words(const FieldSection& section, const std::string& quantity, const char* format) {
  const double mean = mean_std(section.values.at(quantity)).mean;
  return std::isfinite(mean) ? fmt::format(fmt::runtime(format), mean) : "–";
}

}  // namespace

std::vector<std::string> field_in_words(const FieldAnalysis& field, const std::vector<HeldValue>& printed) {
  std::vector<std::string> lines;
  const FieldSection &crest = field.sections.front(), &toe = field.sections.back();
  lines.push_back(fmt::format("{} pictures in {} sections: chi from {} ({}) to {} ({}), D50 from {} to {} m",
                              field.pictures.size(), field.sections.size(),
                              mean_in_words(crest, "chi", "{:.2f}"), crest.name,
                              mean_in_words(toe, "chi", "{:.2f}"), toe.name,
                              mean_in_words(crest, "d50", "{:.3g}"), mean_in_words(toe, "d50", "{:.3g}")));
  for (const auto& [name, words] :
       {std::pair{"ksat_kcm_rel", "Kozeny-Carman"}, std::pair{"ksat_taylor_rel", "Taylor"}}) {
    const Spread s = spread_over(ratio_over_pictures(toe, crest, name));
    if (s.moments.n == 0) continue;
    const std::string filled = std::string(name) + "_filled";
    const Spread with =
        field.options.sieved ? spread_over(ratio_over_pictures(toe, crest, filled)) : Spread{};
    lines.push_back(fmt::format(
        "conductivity of {} over {} by {}, as seen: {:.2g} to {:.3g}, median {:.2g}{}", toe.name, crest.name,
        words, s.min, s.max, s.median,
        with.moments.n > 0 ? fmt::format("; with the fines that pictures miss: median {:.3g}", with.median)
                           : std::string()));
  }
  const Grading *seen = field.whole.curve(CurveKind::medians, false),
                *filled = field.whole.curve(CurveKind::medians, true);
  if (seen != nullptr && filled != nullptr)
    lines.push_back(fmt::format(
        "fines: Cu of the whole slope {:.1f} as seen, {:.1f} with what is below {:.3g} m; D10 {:.3g} and "
        "{:.2g} m",
        seen->cu(), filled->cu(), field.options.limit, seen->diameter(0.1), filled->diameter(0.1)));
  if (!printed.empty()) {
    std::map<PrintedVerdict, int> count;
    for (const HeldValue& held : printed) ++count[held.verdict];
    lines.push_back(
        fmt::format("of {} printed values {} come out as printed, {} within the rounding of the table, {} "
                    "differ, {} are not in the table",
                    printed.size(), count[PrintedVerdict::as_printed], count[PrintedVerdict::within_reach],
                    count[PrintedVerdict::differs], count[PrintedVerdict::not_computable]));
  }
  return lines;
}

std::vector<std::string> write_field_report(const std::string& title, const FieldAnalysis& field,
                                            const std::vector<HeldValue>& printed,
                                            const std::filesystem::path& folder) {
  const std::filesystem::path pictures = folder / "pictures";
  std::filesystem::create_directories(pictures);
  write_field_tables(field, printed, folder);
  PageFigures shown;
  std::string body = "<ul>\n";
  for (const std::string& line : field_in_words(field, printed))
    body += fmt::format("<li>{}</li>\n", html_escaped(line));
  body += "</ul>\n" + section_table(field) + shown.figures("Pictures", draw_field(field, pictures)) +
          normality_table(field) + fit_table(field) + ksat_table(field) + printed_table(printed) +
          given_table(field);
  write_text_file(folder / "report.html", html_page(title, "gradings of sections, picture by picture", body));
  return shown.missing();
}

}  // namespace scree
