#include "analysis/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>

#include "analysis/flow_picture.h"
#include "analysis/inside_pictures.h"
#include "analysis/outputs.h"
#include "analysis/report_text.h"
#include "analysis/summary.h"
#include "sim/io/text_file.h"

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
td small { color: var(--soft); display: block; font-size: .8em; white-space: nowrap; }
tbody tr:nth-child(even) { background: var(--shade); }
.close { background: var(--close); } .agrees { background: var(--agrees); }
.differs { background: var(--differs); } .unknown { background: var(--unknown); }
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

struct VerdictLook {
  const char* style;
  const char* words;
};

VerdictLook look(Verdict verdict) {
  switch (verdict) {
    case Verdict::close:
      return {"close", "agrees closely"};
    case Verdict::agrees:
      return {"agrees", "agrees"};
    case Verdict::differs:
      return {"differs", "does not agree"};
    case Verdict::unknown:
      break;
  }
  return {"unknown", "not judged"};
}

std::string notes_box(const RunResult& result) {
  if (result.notes.empty()) return "";
  std::string out = "<div class=\"notes\" role=\"note\"><strong>Read with care</strong><ul>\n";
  for (const std::string& note : result.notes) out += fmt::format("<li>{}</li>\n", html_escaped(note));
  return out + "</ul></div>\n";
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

/// A value with its deviation below it, both with the same decimals.
std::string value_cell(std::string_view quantity, double value, std::optional<double> std,
                       const std::string& unit) {
  const int decimals = decimals_for(quantity, value);
  std::string out = with_unit(decimals_text(value, decimals), unit);
  if (std && std::isfinite(*std)) out += fmt::format("<small>± {}</small>", decimals_text(*std, decimals));
  return out;
}

const char* relation_sign(const ReferenceValue& reference) {
  switch (meaning_of(reference)) {
    case Meaning::at_least:
      return "≥ ";
    case Meaning::at_most:
      return "≤ ";
    default:
      return reference.relation == "approx" ? "≈ " : "";
  }
}

std::string comparison_table(const RunResult& result) {
  if (result.comparison.empty()) return "";
  std::string out =
      "<h2>Held against printed values</h2>\n"
      "<p>z is the difference over the standard deviations of both values together: below 1 agrees closely, "
      "below 2 "
      "agrees, above does not agree.</p>\n<div class=\"wide\"><table><thead><tr><th "
      "class=\"word\">Quantity</th>"
      "<th class=\"word\">Section</th><th class=\"word\">Printed by</th><th>Printed</th><th>This "
      "run</th><th>z</th>"
      "<th class=\"word\">Verdict</th><th class=\"word\">Source</th></tr></thead><tbody>\n";
  for (const Comparison& row : result.comparison) {
    const ReferenceValue& reference = row.reference;
    const VerdictLook shown = look(verdict(row));
    out += fmt::format(
        "<tr><td class=\"word\">{}</td><td class=\"word\">{}</td><td "
        "class=\"word\">{}<small>{}</small></td><td>{}{}</td>"
        "<td>{}</td><td>{}</td><td class=\"word {}\">{}</td><td class=\"word\">{}</td></tr>\n",
        html_escaped(quantity_in_words(reference.quantity)), html_escaped(reference.section),
        html_escaped(kind_in_words(reference.kind)), html_escaped(reference.case_name),
        relation_sign(reference),
        value_cell(reference.quantity, reference.value, reference.std, reference.unit),
        value_cell(reference.quantity, row.simulated, row.simulated_std, reference.unit),
        row.z ? decimals_text(*row.z, 1) : "–", shown.style, shown.words, html_escaped(reference.source));
  }
  return out + "</tbody></table></div>\n";
}

std::string figure(const Picture& picture) {
  std::ifstream in(picture.file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const bool svg = picture.file.extension() == ".svg";
  return fmt::format(
      "<figure{}><img alt=\"{}\" src=\"data:image/{};base64,{}\"><figcaption><b>{}.</b> "
      "{}</figcaption></figure>\n",
      svg ? " class=\"chart\"" : "", html_escaped(picture.title + ". " + picture.caption),
      svg ? "svg+xml" : "png", base64(bytes), html_escaped(picture.title), html_escaped(picture.caption));
}

std::string figures(const char* heading, const std::vector<Picture>& pictures) {
  if (pictures.empty()) return "";
  std::string out = fmt::format("<h2>{}</h2>\n", heading);
  for (const Picture& picture : pictures) out += figure(picture);
  return out;
}

std::string section_rows(const RunResult& result, std::size_t table) {
  static const char* const shown[] = {"mass_t", "chi",     "d10_m",   "d50_m",   "d80_m",
                                      "d90_m",  "d10_rel", "d50_rel", "d80_rel", "d90_rel"};
  std::string out;
  const SectionTable& layout = *section_layout(result, table);
  for (std::size_t i = 0; i < layout.sections.size(); ++i) {
    out += fmt::format("<tr><td class=\"word\">{}</td><td>{}</td>", html_escaped(layout.sections[i].name),
                       decimals_text(layout.sections[i].x_over_l, 2));
    for (const char* name : shown) {
      const auto field =
          std::find_if(section_fields().begin(), section_fields().end(),
                       [&](const SectionField& one) { return std::string_view(one.name) == name; });
      const MeanStd both = mean_std(over_seeds(result, table, i, field->value));
      out += fmt::format(
          "<td>{}</td>",
          both.n == 0 ? "–"
                      : value_cell(name, both.mean, both.n > 1 ? std::optional(both.std) : std::nullopt, ""));
    }
    out += "</tr>\n";
  }
  return out;
}

std::string section_tables(const RunResult& result) {
  std::string out;
  for (std::size_t table = 0; section_layout(result, table); ++table) {
    if (table == 0)
      out += result.bench_height > 0
                 ? "<h2>Sections of the slope</h2>\n<p>Sections have equal height; the first lies "
                   "at the crest.</p>\n"
                 : "<h2>Cells at the surface</h2>\n<p>The half cone is cut into three parts by "
                   "height and three by distance from its axis.</p>\n";
    const SectionTable& layout = *section_layout(result, table);
    const bool finished = layout.dumps == section_layout(result, 0)->dumps;
    out += fmt::format("<h3>{} sections{}</h3>\n", layout.sections.size(),
                       finished ? std::string() : fmt::format(", after load {}", layout.dumps));
    out +=
        "<div class=\"wide\"><table><thead><tr><th class=\"word\">Section</th><th>x/L</th><th>mass "
        "(t)</th><th>χ</th>"
        "<th>D10 (m)</th><th>D50 (m)</th><th>D80 (m)</th><th>D90 (m)</th><th>D10 ratio</th><th>D50 ratio</th>"
        "<th>D80 ratio</th><th>D90 ratio</th></tr></thead><tbody>\n";
    out += section_rows(result, table) + "</tbody></table></div>\n";
  }
  return out.empty()
             ? out
             : out + "<p class=\"under\">Ratios are over the same diameter of the rock as dumped.</p>\n";
}

bool reaches(const Snapshot& snapshot, const VerticalSection& section) {
  return std::any_of(snapshot.grains.begin(), snapshot.grains.end(), [&](const Grain& grain) {
    return std::abs(grain.position.y() - section.y0) < section.half_width;
  });
}

/// Layers, cells and flow of the first seed.
std::vector<Picture> draw_inside_of(const RunResult& result, const std::filesystem::path& folder) {
  std::vector<Picture> pictures;
  if (result.seeds.empty() || !result.seeds.front().inside) return pictures;
  const SeedResult& seed = result.seeds.front();
  const VerticalSection& section = seed.inside->section;
  if (!seed.inside->cells.empty()) {
    pictures.push_back(draw_layers(seed.final_state.grains, seed.fixed, section, folder / "layers.png"));
    pictures.push_back(draw_inside(*seed.inside, folder / "inside.png"));
  }
  if (seed.flow && seed.flow->liveliest() && reaches(*seed.flow->liveliest(), section))
    pictures.push_back(draw_velocity(*seed.flow->liveliest(), seed.fixed, section, folder / "velocity.png"));
  return pictures;
}

std::string inside_table(const RunResult& result) {
  struct Row {
    const char *name, *words, *unit;
  };
  static constexpr Row kRows[] = {
      {"largest_at_toe", "share of the coarsest tenth that lies in the lowest sixth of the slope", ""},
      {"inside_mean_abs_chi", "mean |χ| over the cells inside", ""},
      {"inside_ksat_contrast", "hydraulic conductivity by grading, 90th over 10th percentile of the cells",
       ""},
      {"inside_porosity", "porosity of the cells wholly inside (overlaps of soft spheres count as rock)", ""},
      {"layer_coarsening_down", "χ of the lower half of a load's layer less that of its upper half", ""},
      {"layer_variance_between", "share of the scatter of grain size that lies between layers", ""},
      {"layer_variance_by_chance", "the same if loads were mixed", ""},
      {"point1_toe_width_m", "width at the toe of what the first dump point brought", "m"},
      {"flow_depth_m", "depth of the flow at the middle of the slope, largest", "m"},
      {"arrival_energy_j_per_kg", "energy of rock on arrival in the lowest section", "J/kg"},
      {"arrival_share_of_drop", "the same over g times the height of the bench", ""},
  };
  const std::vector<Outputs> seeds = outputs_of(result.seeds);
  std::string rows;
  for (const Row& row : kRows) {
    std::vector<double> values;
    for (const Outputs& seed : seeds)
      if (const auto found = seed.find(row.name); found != seed.end()) values.push_back(found->second);
    const MeanStd both = mean_std(values);
    if (both.n == 0) continue;
    rows += fmt::format(
        "<tr><td class=\"word\">{}</td><td>{}</td></tr>\n", row.words,
        value_cell(row.name, both.mean, both.n > 1 ? std::optional(both.std) : std::nullopt, row.unit));
  }
  if (rows.empty()) return rows;
  return "<div class=\"wide\"><table><thead><tr><th class=\"word\">Inside and flow</th><th>This "
         "run</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string facts(const RunResult& result) {
  double particles = 0, fixed = 0, mass = 0, simulated = 0, moved = 0, seconds = 0, overlap = 0, lost = 0,
         lost_mass = 0;
  double shortest = std::numeric_limits<double>::max(), longest = 0;
  std::string seeds;
  bool at_rest = true, interrupted = false;
  for (const SeedResult& seed : result.seeds) {
    seeds += fmt::format("{}{}", seeds.empty() ? "" : ", ", seed.seed);
    particles += static_cast<double>(seed.particles);
    fixed += static_cast<double>(seed.fixed.size());
    mass += seed.mass;
    simulated += seed.simulated_seconds;
    moved += seed.particle_steps;
    seconds += seed.wall_seconds;
    overlap = std::max(overlap, seed.largest_overlap_ratio);
    lost += static_cast<double>(seed.lost_particles);
    lost_mass += seed.lost_mass;
    shortest = std::min(shortest, seed.time_step_min);
    longest = std::max(longest, seed.time_step_max);
    at_rest = at_rest && seed.at_rest;
    interrupted = interrupted || seed.interrupted;
  }
  const double n = static_cast<double>(std::max<std::size_t>(result.seeds.size(), 1));
  const char* each = n > 1 ? " for each seed, on average" : "";
  std::string out = "<h2>The run</h2>\n<dl class=\"facts\">\n";
  const auto fact = [&](const char* name, const std::string& value) {
    out += fmt::format("<dt>{}</dt><dd>{}</dd>\n", name, value);
  };
  fact("scenario", html_escaped(result.scenario));
  fact("program", fmt::format("scree {}", html_escaped(result.version)));
  fact("engine", html_escaped(result.engine));
  fact("seeds", seeds);
  fact("rock",
       fmt::format("{} spheres, {} t{}", count_text(particles / n), number_text(mass / n / 1000), each));
  if (fixed > 0) fact("fixed balls of the ground", count_text(fixed / n));
  fact("simulated time", duration_text(simulated / n) + each);
  fact("computing time", duration_text(result.wall_seconds));
  if (seconds > 0) fact("speed", count_text(moved / seconds) + " particle-steps per second");
  if (longest > 0) {
    const std::string low = number_text(1e6 * shortest), high = number_text(1e6 * longest);
    fact("time step", low == high ? high + " µs" : low + " to " + high + " µs");
  }
  fact("largest overlap", number_text(100 * overlap, 2) + " % of the smaller radius");
  fact("lost from the model", lost > 0
                                  ? fmt::format("{} spheres, {} t{}", count_text(lost),
                                                number_text(lost_mass / 1000), n > 1 ? " over all seeds" : "")
                                  : std::string("nothing"));
  fact("at rest", interrupted ? "no: the run was interrupted"
                  : at_rest   ? "yes: every dump came to rest"
                              : "no: a dump was still moving at its time limit");
  return out + "</dl>\n";
}

constexpr const char* kGlossary = R"(<h2>Words</h2>
<dl>
<dt>χ, segregation degree</dt><dd>How coarse a section is: 0 is the rock as dumped, 1 is its coarsest quarter, below 0 is
finer than dumped. It compares the mean logarithm of the diameters.</dd>
<dt>D10, D50, D80, D90</dt><dd>Diameter below which 10, 50, 80 or 90 % of the mass lies. D50 is the median.</dd>
<dt>section</dt><dd>A slice of the slope between two heights; S1 lies at the crest, the last one at the toe.</dd>
<dt>x/L</dt><dd>Place along the slope: 0 at the crest, 1 at the toe.</dd>
<dt>repose angle</dt><dd>Slope of the flank of a heap at rest, between 20 and 80 % of its height.</dd>
<dt>seed</dt><dd>A run with the same rock and scene but other random numbers; the spread of seeds is the scatter of the
result.</dd>
</dl>
)";

}  // namespace

void write_report(const RunResult& result, const std::filesystem::path& folder, const SceneFacts& scene) {
  const std::filesystem::path pictures = folder / "pictures";
  std::filesystem::create_directories(pictures);
  const std::string title = html_escaped(result.title.empty() ? result.scenario : result.title);
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, "
      "initial-scale=1\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n"
      "<h1>{0}</h1>\n<p class=\"under\">Simulated with scree {2}, scenario {3}</p>\n",
      title, kStyle, html_escaped(result.version), html_escaped(result.scenario));
  page += lead_paragraphs(result) + notes_box(result);
  page += figures("The pile", draw_pile(result, scene, pictures));
  page += comparison_table(result);
  page += figures("Charts", draw_charts(result, scene, pictures));
  page += figures("Inside the pile, and the flow", draw_inside_of(result, pictures)) + inside_table(result);
  page += section_tables(result) + facts(result) + kGlossary + "</body>\n</html>\n";
  write_text_file(folder / "report.html", page);
}

}  // namespace scree
