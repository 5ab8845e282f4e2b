#include "analysis/report/lateral_table.h"

#include <fmt/format.h>

#include <map>
#include <vector>

#include "analysis/report/report_page.h"
#include "analysis/report/report_text.h"
#include "analysis/results/finished_runs.h"
#include "analysis/results/outputs.h"

namespace scree {
namespace {

// Values of a strip over seeds.
struct Strip {
  std::vector<double> chi, d50_rel;
};

using Strips = std::map<double, std::vector<Strip>>;  // by middle (m), then by section

Strips strips_of(const RunResult& result, std::size_t sections) {
  Strips strips;
  for (const SeedResult& seed : result.seeds) {
    if (!seed.lateral) continue;
    for (std::size_t k = 0; k < seed.lateral->sections.size() && k < sections; ++k) {
      const LateralSection& section = seed.lateral->sections[k];
      for (std::size_t i = 0; i < section.y.size(); ++i) {
        std::vector<Strip>& row = strips[section.y[i]];
        row.resize(sections);
        row[k].chi.push_back(section.chi[i]);
        row[k].d50_rel.push_back(section.d50_rel[i]);
      }
    }
  }
  return strips;
}

}  // namespace

std::string lateral_table(const RunResult& result) {
  const Lateral* layout = nullptr;
  for (const SeedResult& seed : result.seeds)
    if (layout == nullptr && seed.lateral) layout = &*seed.lateral;
  if (layout == nullptr || layout->sections.empty()) return "";

  std::string head, rows;
  for (const LateralSection& section : layout->sections)
    head += fmt::format("<th>{}</th>", html_escaped(section.name));
  const double half = 0.5 * layout->strip_width;
  for (const auto& [y, row] : strips_of(result, layout->sections.size())) {
    rows +=
        fmt::format("<tr><td class=\"word\">y {} to {} m</td>", number_text(y - half), number_text(y + half));
    for (const Strip& strip : row) {
      const MeanStd chi = mean_std(strip.chi), d50_rel = mean_std(strip.d50_rel);
      rows += chi.n == 0 ? "<td>–</td>"
                         : fmt::format("<td>{}<small>D50 {}</small></td>", decimals_text(chi.mean, 2),
                                       decimals_text(d50_rel.mean, 2));
    }
    rows += "</tr>\n";
  }
  const std::vector<Outputs> seeds = outputs_of(result.seeds);
  const auto across = [&](const char* words, const char* output) {
    rows += fmt::format("<tr><td class=\"word\"><b>{}</b></td>", words);
    for (const LateralSection& section : layout->sections)
      rows += fmt::format(
          "<td>{}</td>", value_cell("chi", spread_of(seeds, fmt::format("{}_{}", output, section.name)), ""));
    rows += "</tr>\n";
  };
  across("deviation of χ over strips", "lateral_chi_std");
  across("largest difference of χ", "lateral_chi_range");
  across("deviation of the D50 ratio", "lateral_d50_rel_std");
  const MeanStd width = spread_of(seeds, "point1_toe_width_m");
  return fmt::format(
      "<h2>Across the slope</h2>\n<p>χ in strips {} m wide across each section, and below it D50 over that "
      "of the "
      "rock as dumped; strips with fewer than {} grains are left out.{}</p>\n<div "
      "class=\"wide\"><table><thead><tr>"
      "<th class=\"word\">Strip</th>{}</tr></thead><tbody>\n{}</tbody></table></div>\n",
      number_text(layout->strip_width), kLeastStripGrains,
      width.n > 0
          ? fmt::format(" At the toe lies the rock of the first dump point over a width of {} m{} (95 % of "
                        "its mass).",
                        decimals_text(width.mean, 1),
                        width.n > 1 ? fmt::format(" ± {} m", decimals_text(width.std, 1)) : "")
          : "",
      head, rows);
}

}  // namespace scree
