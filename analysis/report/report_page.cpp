#include "analysis/report/report_page.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "analysis/report/report_text.h"

namespace scree {
namespace {

// Colours of agreement are those of Okabe and Ito in two strengths; each cell also says its verdict in words.
constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --ink: #1c2024; --soft: #5b646d; --paper: #ffffff; --line: #d9dee3; --shade: #f4f6f8;
  --close: #cfe6f5; --agrees: #e6f2d8; --differs: #f9dccb; --unknown: #eceff1; --warn: #fff4d6; --warn-line: #d9a400; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e9ec; --soft: #a0aab4; --paper: #15191d; --line: #353d45;
  --shade: #1e242a; --close: #123f5c; --agrees: #2c451b; --differs: #61301a; --unknown: #2a3036; --warn: #3d3210;
  --warn-line: #b58a00; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2.5rem 1.5rem 4rem; max-width: 62rem; background: var(--paper); color: var(--ink);
  font: 16px/1.55 "Source Sans 3", "Segoe UI", "Helvetica Neue", Arial, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .2rem; }
h2 { font-size: 1.25rem; margin: 2.6rem 0 .7rem; padding-bottom: .3rem; border-bottom: 1px solid var(--line); }
h3 { font-size: 1.02rem; margin: 1.6rem 0 .5rem; }
p { margin: .5rem 0; max-width: 46rem; }
.under { color: var(--soft); margin-bottom: 1.4rem; }
.lead { font-size: 1.16rem; }
.notes { border: 1px solid var(--warn-line); border-left-width: 6px; background: var(--warn); padding: .6rem 1rem;
  margin: 1.2rem 0; border-radius: 4px; }
.notes ul { margin: .3rem 0; padding-left: 1.2rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .88rem; font-variant-numeric: tabular-nums; width: 100%; }
th, td { padding: .35rem .55rem; text-align: right; border-bottom: 1px solid var(--line); vertical-align: top; }
th { font-weight: 600; color: var(--soft); vertical-align: bottom; }
th.word, td.word { text-align: left; }
td:not(.word), td small { white-space: nowrap; }
td small { color: var(--soft); display: block; font-size: .8em; }
tbody tr:nth-child(even) { background: var(--shade); }
.close { background: var(--close); } .agrees { background: var(--agrees); }
.differs, tbody tr.differs:nth-child(n) { background: var(--differs); } .unknown { background: var(--unknown); }
figure { margin: 1.4rem 0; break-inside: avoid; }
figure img { display: block; width: 100%; height: auto; background: #fff; border: 1px solid var(--line);
  border-radius: 4px; padding: .5rem; }
figure.chart img { max-width: 46rem; }
figcaption { color: var(--soft); font-size: .92rem; margin-top: .4rem; max-width: 46rem; }
figcaption b { color: var(--ink); }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .3rem 1.2rem; margin: .6rem 0; }
dt { font-weight: 600; } dd { margin: 0; }
.facts dt { font-weight: 400; color: var(--soft); }
@media print { body { max-width: none; padding: 0; font-size: 10.5pt; } h2, h3 { break-after: avoid; }
  tr { break-inside: avoid; } .wide { overflow: visible; } * { print-color-adjust: exact; } }
)";

const char* style_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::close:
      return "close";
    case Verdict::agrees:
      return "agrees";
    case Verdict::differs:
      return "differs";
    case Verdict::unknown:
      break;
  }
  return "unknown";
}

std::string with_unit(const std::string& number, const std::string& unit) {
  if (unit.empty() || unit == "-" || number == "–") return number;
  if (unit == "deg") return number + "°";
  return fmt::format("{} {}", number, unit == "pct" ? "%" : html_escaped(unit));
}

/// Degrees of segregation have two decimals and angles one, so that a column lines up; sizes have three
/// digits.
int decimals_for(std::string_view quantity, double value) {
  if (quantity.starts_with("chi")) return 2;
  return quantity.ends_with("angle") ? 1 : decimals_of(value);
}

const char* relation_sign(const ReferenceValue& reference) {
  switch (meaning_of(reference)) {
    case Meaning::at_least:
      return "≥ ";
    case Meaning::at_most:
      return "≤ ";
    case Meaning::range:
      return "from ";
    default:
      return reference.relation == "approx" ? "≈ " : "";
  }
}

}  // namespace

std::string html_page(const std::string& title, const std::string& under, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, "
      "initial-scale=1\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n"
      "<h1>{0}</h1>\n<p class=\"under\">{2}</p>\n{3}</body>\n</html>\n",
      html_escaped(title), kStyle, html_escaped(under), body);
}

std::string value_cell(std::string_view quantity, double value, std::optional<double> std,
                       const std::string& unit) {
  const int decimals = decimals_for(quantity, value);
  std::string out = with_unit(decimals_text(value, decimals), unit);
  if (std && std::isfinite(*std)) out += fmt::format("<small>± {}</small>", decimals_text(*std, decimals));
  return out;
}

std::string value_cell(std::string_view quantity, const MeanStd& value, const std::string& unit) {
  return value_cell(quantity, value.mean, value.n > 1 ? std::optional(value.std) : std::nullopt, unit);
}

std::string comparison_explained() {
  return "<p>z is the difference over the standard deviations of both values together (for a bound, how far "
         "it "
         "is passed; where no deviation is printed, that of rounding): below 1 agrees closely, below 2 "
         "agrees, "
         "above does not agree. The source is a table of the thesis, or a line of an extract of its text (an "
         "order, to tell values apart).</p>\n";
}

std::string comparison_table(const std::vector<Comparison>& comparison) {
  if (comparison.empty()) return "";
  std::string out =
      "<div class=\"wide\"><table><thead><tr><th "
      "class=\"word\">Quantity</th>"
      "<th class=\"word\">Section</th><th class=\"word\">Printed "
      "by</th><th>Printed</th><th>Here</th><th>z</th>"
      "<th class=\"word\">Verdict</th><th class=\"word\">Source</th></tr></thead><tbody>\n";
  for (const Comparison& row : comparison) {
    const ReferenceValue& reference = row.reference;
    const Verdict shown = verdict(row);
    out += fmt::format(
        "<tr><td class=\"word\">{}</td><td class=\"word\">{}</td><td "
        "class=\"word\">{}<small>{}</small></td><td>{}{}</td>"
        "<td>{}</td><td>{}</td><td class=\"word {}\">{}</td><td class=\"word\">{}</td></tr>\n",
        html_escaped(quantity_in_words(reference.quantity)), html_escaped(reference.section),
        html_escaped(kind_in_words(reference.kind)), html_escaped(reference.case_name),
        relation_sign(reference),
        value_cell(reference.quantity, reference.value, reference.std, reference.unit) +
            (reference.upper ? " to " + value_cell(reference.quantity, *reference.upper, reference.upper_std,
                                                   reference.unit)
                             : std::string()),
        value_cell(reference.quantity, row.simulated, row.simulated_std, reference.unit),
        row.z ? decimals_text(*row.z, 1) : "–", style_of(shown), in_words(shown),
        html_escaped(reference.source));
  }
  return out + "</tbody></table></div>\n";
}

std::string PageFigures::figure(const Picture& picture) {
  if (!picture.why_missing.empty()) {
    missing_.push_back(picture.why_missing);
    return fmt::format("<p class=\"notes\" role=\"alert\">A picture is missing: {}</p>\n",
                       html_escaped(picture.why_missing));
  }
  std::ifstream in(picture.file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in || bytes.empty())
    throw std::runtime_error(fmt::format("cannot read the picture {}", picture.file.string()));
  const bool svg = picture.file.extension() == ".svg";
  const char* kind = svg ? "svg+xml" : picture.file.extension() == ".jpg" ? "jpeg" : "png";
  return fmt::format(
      "<figure{}><img alt=\"{}\" src=\"data:image/{};base64,{}\"><figcaption><b>{}.</b> "
      "{}</figcaption></figure>\n",
      svg ? " class=\"chart\"" : "", html_escaped(picture.title + ". " + picture.caption), kind,
      base64(bytes), html_escaped(picture.title), html_escaped(picture.caption));
}

std::string PageFigures::figure(const std::function<std::optional<Picture>()>& draw) {
  std::vector<Picture> pictures;
  add_picture(pictures, draw);
  return pictures.empty() ? "" : figure(pictures.front());
}

std::string PageFigures::figures(const char* heading, const std::vector<Picture>& pictures) {
  if (pictures.empty()) return "";
  std::string out = fmt::format("<h2>{}</h2>\n", heading);
  for (const Picture& picture : pictures) out += figure(picture);
  return out;
}

}  // namespace scree
