#include "analysis/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "analysis/report/energy_table.h"
#include "analysis/report/flow_picture.h"
#include "analysis/report/inside_pictures.h"
#include "analysis/report/lateral_table.h"
#include "analysis/report/report_page.h"
#include "analysis/report/report_text.h"
#include "analysis/results/finished_runs.h"
#include "analysis/results/outputs.h"
#include "analysis/results/summary.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

std::string notes_box(const RunResult& result) {
  if (result.notes.empty()) return "";
  std::string out = "<div class=\"notes\" role=\"note\"><strong>Read with care</strong><ul>\n";
  for (const std::string& note : result.notes) out += fmt::format("<li>{}</li>\n", html_escaped(note));
  return out + "</ul></div>\n";
}

std::string failures_box(const RunResult& result) {
  if (result.failures.empty()) return "";
  std::string out =
      "<div class=\"notes\" role=\"alert\"><strong>FAILED: this run does not count</strong><ul>\n";
  for (const std::string& failure : result.failures)
    out += fmt::format("<li>{}</li>\n", html_escaped(failure));
  return out + "</ul></div>\n";
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
      out += fmt::format("<td>{}</td>", value_cell(name, both, ""));
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

bool of_several_dumps(const Snapshot& pile) {
  return std::any_of(pile.grains.begin(), pile.grains.end(),
                     [&](const Grain& grain) { return grain.dump != pile.grains.front().dump; });
}

/// Layers, cells and flow of the first seed.
std::vector<Picture> draw_inside_of(const RunResult& result, const std::filesystem::path& folder) {
  std::vector<Picture> pictures;
  if (result.seeds.empty() || !result.seeds.front().inside) return pictures;
  const SeedResult& seed = result.seeds.front();
  const VerticalSection& section = seed.inside->section;
  if (of_several_dumps(seed.final_state) && reaches(seed.final_state, section))
    add_picture(pictures, [&] {
      return draw_layers(seed.final_state.grains, seed.fixed, section, folder / "layers.png");
    });
  if (shows_rock(*seed.inside))
    add_picture(pictures, [&] { return draw_inside(*seed.inside, folder / "inside.png"); });
  if (seed.flow && seed.flow->liveliest() && reaches(*seed.flow->liveliest(), section))
    add_picture(pictures, [&] {
      return draw_velocity(*seed.flow->liveliest(), seed.fixed, section, folder / "velocity.png");
    });
  return pictures;
}

std::string inside_table(const RunResult& result) {
  struct Row {
    const char *name, *words, *unit;
  };
  static constexpr Row kRows[] = {
      {"largest_at_toe", "share of the coarsest tenth that lies in the lowest sixth of the slope", ""},
      {"inside_mean_abs_chi", "mean |χ| over the cells of the section", ""},
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
  const bool layered = std::any_of(result.seeds.begin(), result.seeds.end(),
                                   [](const SeedResult& seed) { return of_several_dumps(seed.final_state); });
  std::string rows;
  for (const Row& row : kRows) {
    if (!layered && std::string_view(row.name).starts_with("layer_variance")) continue;
    const MeanStd both = spread_of(seeds, row.name);
    if (both.n == 0) continue;
    rows += fmt::format("<tr><td class=\"word\">{}</td><td>{}</td></tr>\n", row.words,
                        value_cell(row.name, both, row.unit));
  }
  if (rows.empty()) return rows;
  return "<div class=\"wide\"><table><thead><tr><th class=\"word\">Inside and flow</th><th>This "
         "run</th></tr></thead><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

/// Rings, form and runout of the heap of a repose test.
std::string heap_table(const RunResult& result) {
  const auto cell = [&](const char* name, auto value) {
    std::vector<double> values;
    for (const SeedResult& seed : result.seeds)
      if (seed.heap) values.push_back(value(*seed.heap));
    const MeanStd both = mean_std(values);
    return fmt::format(
        "<td>{}</td>",
        both.n == 0 ? "–"
                    : value_cell(name, both.mean, both.n > 1 ? std::optional(both.std) : std::nullopt, ""));
  };
  std::string rings, form;
  for (std::size_t k = 0; k < kHeapRings; ++k) {
    rings += fmt::format("<tr><td class=\"word\">ring {}</td>", k + 1);
    rings += cell("mass_share", [k](const HeapShape& heap) { return heap.mass_share[k]; });
    rings += cell("chi", [k](const HeapShape& heap) {
      return of_ring(heap, k, [](const Section& s) { return s.chi; });
    });
    rings += cell("d50_rel",
                  [k](const HeapShape& heap) {
                    return of_ring(heap, k, [](const Section& s) { return s.d50_rel; });
                  }) +
             "</tr>\n";
    form += cell("profile", [k](const HeapShape& heap) { return heap.profile[k]; });
  }
  return "<h2>The heap</h2>\n<p>Rings in plan of equal width, the first in the middle, the last out to the "
         "heap's radius R.</p>\n"
         "<div class=\"wide\"><table><thead><tr><th class=\"word\">Ring</th><th>share of the "
         "mass</th><th>χ</th>"
         "<th>D50 ratio</th></tr></thead><tbody>\n" +
         rings +
         "</tbody></table></div>\n<div class=\"wide\"><table><thead><tr><th class=\"word\">Height of the "
         "surface over the heap's</th><th>at R/4</th><th>at R/2</th><th>at 3R/4</th></tr></thead><tbody>\n"
         "<tr><td class=\"word\">here; of a cone 0.75, 0.50, 0.25</td>" +
         form +
         "</tr></tbody></table></div>\n<div class=\"wide\"><table><tbody><tr><td class=\"word\">Radius that "
         "holds "
         "95 % of the mass over the cube root of the rock's volume</td>" +
         cell("spread_95", [](const HeapShape& heap) { return heap.spread_95; }) +
         "</tr></tbody></table></div>\n";
}

std::string facts(const RunResult& result) {
  double particles = 0, fixed = 0, mass = 0, simulated = 0, moved = 0, seconds = 0, overlap = 0, lost = 0,
         lost_mass = 0;
  double shortest = std::numeric_limits<double>::max(), longest = 0;
  std::string seeds;
  bool at_rest = true, closed = true;
  for (const SeedResult& seed : result.seeds) {
    closed = closed && (!seed.energy || seed.energy->closed);
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
  for (const std::string& effect : result.effects) fact("effect", html_escaped(effect));
  fact("rock", fmt::format("{} {}, {} t{}", count_text(particles / n), particles == n ? "sphere" : "spheres",
                           number_text(mass / n / 1000), each));
  if (fixed > 0) fact("fixed balls of the ground", count_text(fixed / n));
  fact("simulated time", duration_text(simulated / n) + each);
  fact("computing time", duration_text(result.wall_seconds));
  if (seconds > 0) fact("speed", count_text(moved / seconds) + " particle-steps per second");
  if (longest > 0) {
    const std::string low = number_text(1e6 * shortest), high = number_text(1e6 * longest);
    fact("time step", low == high ? high + " µs" : low + " to " + high + " µs");
  }
  fact("largest overlap", number_text(100 * overlap, 2) + " % of the smaller radius");
  if (const double error = largest_energy_error(result);
      std::any_of(result.seeds.begin(), result.seeds.end(),
                  [](const SeedResult& seed) { return seed.energy.has_value(); }))
    fact("energy balance", fmt::format("{}{}", energy_in_words(error, closed),
                                       !std::isfinite(error) ? ""
                                       : n > 1 ? " of what was put in, the seed that is furthest off"
                                               : " of what was put in"));
  fact("lost from the model", lost > 0
                                  ? fmt::format("{} spheres, {} t{}", count_text(lost),
                                                number_text(lost_mass / 1000), n > 1 ? " over all seeds" : "")
                                  : std::string("nothing"));
  // A drop test ends at the top of the rebound.
  if (result.seeds.empty() || !result.seeds.front().rebound_height)
    fact("at rest", unfinished(result) ? "no: the run was interrupted"
                    : at_rest          ? "yes: every dump came to rest"
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

std::vector<std::string> write_report(const RunResult& result, const std::filesystem::path& folder,
                                      const SceneFacts& scene) {
  const std::filesystem::path pictures = folder / "pictures";
  std::filesystem::create_directories(pictures);
  PageFigures shown;
  std::string page = failures_box(result) + lead_paragraphs(result) + notes_box(result);
  page += shown.figures("The pile", draw_pile(result, scene, pictures));
  if (!result.comparison.empty())
    page += "<h2>Held against printed values</h2>\n" + comparison_explained() +
            comparison_table(result.comparison);
  page += shown.figures("Charts", draw_charts(result, scene, pictures));
  page +=
      shown.figures("Inside the pile, and the flow", draw_inside_of(result, pictures)) + inside_table(result);
  page += section_tables(result) + lateral_table(result);
  if (std::any_of(result.seeds.begin(), result.seeds.end(),
                  [](const SeedResult& seed) { return seed.heap.has_value(); }))
    page += heap_table(result);
  page += facts(result) + energy_table(result) + kGlossary;
  const std::string under =
      fmt::format("Simulated with scree {}, scenario {}", result.version, result.scenario);
  write_text_file(folder / "report.html",
                  html_page(result.title.empty() ? result.scenario : result.title, under, page));
  return shown.missing();
}

}  // namespace scree
