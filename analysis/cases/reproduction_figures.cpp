#include "analysis/cases/reproduction_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "analysis/report/profile_chart.h"
#include "analysis/report/report_text.h"
#include "analysis/results/outputs.h"

namespace scree {
namespace {

using Kind = ChartSeries::Kind;

// A case in a figure, by what sets it apart there.
struct Shown {
  const char *name, *label;
};

// A figure of the thesis: a quantity along the slope, of several cases.
struct FigureSpec {
  const char *figure, *file, *title;
  const char *quantity, *label;
  int sections;
  int dumps;  // after which the pile is looked at; 0: at the end
  std::vector<Shown> cases;
};

const std::vector<FigureSpec>& figure_specs() {
  static const char* const kChi = "segregation degree χ";
  static const char* const kD50 = "D50 over that as dumped";
  static const std::vector<Shown> kLab{{"lab_segregation", ""}}, kMalartic{{"c1", ""}}, kBlanca{{"a3", ""}};
  static const std::vector<Shown> kHeights{{"a1", "10 m"}, {"a2", "15 m"}, {"a3", "20 m"}, {"a4", "25 m"}};
  static const std::vector<Shown> kGradings{{"a1", "grading QB0"}, {"c1", "grading CM0"}};
  static const std::vector<Shown> kPayloads{{"a1", "300 t"}, {"b1", "600 t"}};
  static const std::vector<Shown> kMethods{{"a1", "end dumping"}, {"d2", "push dumping"}};
  static const std::vector<Shown> kBlades{{"d1", "0.1 m/s"}, {"d2", "0.2 m/s"}, {"d3", "0.3 m/s"},
                                          {"d4", "0.4 m/s"}, {"d5", "0.5 m/s"}, {"d6", "0.6 m/s"}};
  static const std::vector<Shown> kSpeeds{
      {"a1", "end dumping"}, {"d1", "pushed at 0.1 m/s"}, {"d6", "pushed at 0.6 m/s"}};
  static const std::vector<Shown> kPoints{{"a1", "one point"},
                                          {"lateral_s4", "points 4 m apart"},
                                          {"lateral_s8", "8 m apart"},
                                          {"lateral_s12", "12 m apart"}};
  static const std::vector<FigureSpec> specs{
      {"5.8", "lab_d10", "Laboratory, D10 of the surface cells", "d10", "D10 (m)", 3, 0, kLab},
      {"5.9", "lab_d50", "Laboratory, D50 of the surface cells", "d50", "D50 (m)", 3, 0, kLab},
      {"5.9", "lab_d80", "Laboratory, D80 of the surface cells", "d80", "D80 (m)", 3, 0, kLab},
      {"5.10", "lab_chi", "Laboratory, segregation degree", "chi", kChi, 3, 0, kLab},
      {"5.11", "cm_d50", "Canadian Malartic, D50, three sections", "d50", "D50 (m)", 3, 3, kMalartic},
      {"5.12", "cm_chi", "Canadian Malartic, three sections", "chi", kChi, 3, 3, kMalartic},
      {"5.12", "cm_chi6", "Canadian Malartic, six sections", "chi", kChi, 6, 0, kMalartic},
      {"5.13", "qb_d50", "Quebrada Blanca, D50, nine sections", "d50", "D50 (m)", 9, 0, kBlanca},
      {"5.14", "qb_d80", "Quebrada Blanca, D80, nine sections", "d80", "D80 (m)", 9, 0, kBlanca},
      {"6.5", "height_chi", "Height of the bench", "chi", kChi, 6, 0, kHeights},
      {"6.5", "height_d50", "Height of the bench", "d50_rel", kD50, 6, 0, kHeights},
      {"6.6", "grading_chi", "Grading of the rock", "chi", kChi, 6, 0, kGradings},
      {"6.6", "grading_d50", "Grading of the rock", "d50_rel", kD50, 6, 0, kGradings},
      {"6.7", "payload_chi", "Payload", "chi", kChi, 6, 0, kPayloads},
      {"6.7", "payload_d50", "Payload", "d50_rel", kD50, 6, 0, kPayloads},
      {"6.8", "method_chi", "End dumping and push dumping", "chi", kChi, 6, 0, kMethods},
      {"6.8", "method_d50", "End dumping and push dumping", "d50_rel", kD50, 6, 0, kMethods},
      {"6.9", "push_chi", "Velocity of the blade", "chi", kChi, 6, 0, kBlades},
      {"6.9", "push_d50", "Velocity of the blade", "d50_rel", kD50, 6, 0, kBlades},
      {"6.10", "push_speed", "Mean speed of moving rock", "flow_speed", "speed (m/s)", 6, 0, kSpeeds},
      {"6.12", "lateral_chi", "Distance of the dump points", "chi", kChi, 6, 0, kPoints},
      {"6.13", "lateral_std", "Deviation of χ across the slope", "lateral_chi_std",
       "deviation of χ over strips", 6, 0, kPoints},
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

ChartSeries ours(const CaseResult& result, const FigureSpec& spec, const Shown& shown, int colour) {
  ChartSeries series{shown.label, Kind::ours, colour, {}};
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

// Printed numbers of a kind, bounds among them; of a range both ends are bounds.
ChartSeries printed(const CaseResult& result, const FigureSpec& spec, const Shown& shown, Kind kind,
                    int colour) {
  ChartSeries series{shown.label, kind, colour, {}};
  for (const Comparison& row : result.comparison) {
    const ReferenceValue& r = row.reference;
    const int k = section_number(r.section);
    if (r.quantity != spec.quantity || section_count(r) != spec.sections || k == 0) continue;
    const Meaning meaning = meaning_of(r);
    const bool wanted = kind == Kind::at_least ? meaning == Meaning::at_least || meaning == Meaning::range
                        : kind == Kind::at_most
                            ? meaning == Meaning::at_most || meaning == Meaning::range
                            : meaning == Meaning::value && (r.kind == "measured") == (kind == Kind::measured);
    if (!wanted) continue;
    const double value = kind == Kind::at_most && meaning == Meaning::range ? r.upper.value() : r.value;
    series.points.push_back({x_over_l(k, spec.sections), value, r.std.value_or(std::nan(""))});
  }
  std::sort(series.points.begin(), series.points.end(),
            [](const auto& a, const auto& b) { return a.x < b.x; });
  return series;
}

bool same_points(const ChartSeries& a, const ChartSeries& b) {
  return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const auto& p, const auto& q) { return p.x == q.x && p.y == q.y; });
}

// One line for a bound that several cases share.
void add_bound(std::vector<ChartSeries>& all, ChartSeries bound) {
  if (bound.points.empty()) return;
  for (ChartSeries& there : all)
    if (there.kind == bound.kind && same_points(there, bound)) {
      there.label = bound.kind == Kind::at_least ? "PFC3D, at least" : "PFC3D, at most";
      there.colour = -1;
      return;
    }
  all.push_back(std::move(bound));
}

const CaseResult* with_runs(const std::vector<CaseResult>& cases, const char* name) {
  const auto found =
      std::find_if(cases.begin(), cases.end(), [&](const CaseResult& each) { return each.name == name; });
  return found == cases.end() ? nullptr : &*found;
}

std::vector<ChartSeries> series_of(const std::vector<CaseResult>& cases, const FigureSpec& spec) {
  std::vector<ChartSeries> all, bounds;
  int colour = -1;
  for (const Shown& shown : spec.cases) {
    ++colour;
    const CaseResult* result = with_runs(cases, shown.name);
    if (!result) continue;
    ChartSeries here = ours(*result, spec, shown, colour);
    if (here.points.empty()) continue;
    all.push_back(std::move(here));
    for (const Kind kind : {Kind::pfc3d, Kind::measured})
      if (ChartSeries theirs = printed(*result, spec, shown, kind, colour); !theirs.points.empty())
        all.push_back(std::move(theirs));
    for (const Kind kind : {Kind::at_least, Kind::at_most})
      add_bound(bounds, printed(*result, spec, shown, kind, colour));
  }
  std::move(bounds.begin(), bounds.end(), std::back_inserter(all));
  return all;
}

// What the marks of these series mean.
std::string marks_in_words(const std::vector<ChartSeries>& all) {
  const auto has = [&](Kind kind) {
    return std::any_of(all.begin(), all.end(), [&](const auto& series) { return series.kind == kind; });
  };
  std::string text = "Dots with a line: mean and standard deviation of the seeds simulated here.";
  if (has(Kind::pfc3d)) text += " Squares: PFC3D.";
  if (has(Kind::measured)) text += " Triangles: measured.";
  if (has(Kind::at_least) || has(Kind::at_most)) text += " Dashed: bounds printed of PFC3D.";
  if (all.size() > 1 && !has(Kind::pfc3d) && !has(Kind::measured) && !has(Kind::at_least) &&
      !has(Kind::at_most))
    text += " The thesis prints no numbers of these.";
  return text;
}

}  // namespace

std::vector<Picture> draw_figures(const std::vector<CaseResult>& cases, const std::filesystem::path& folder) {
  std::vector<Picture> pictures;
  for (const FigureSpec& spec : figure_specs()) {
    ProfileChart chart{spec.title,
                       std::string_view(spec.file).starts_with("lab")
                           ? "place on the cone (0 top, 1 bottom)"
                           : "place along the slope x/L (0 crest, 1 toe)",
                       spec.label, std::string_view(spec.quantity) == "chi", series_of(cases, spec)};
    if (chart.series.empty()) continue;
    const auto file = folder / fmt::format("{}.svg", spec.file);
    add_picture(pictures, [&] {
      draw(chart, file);
      return Picture{
          fmt::format("{}: {} (figure {} of the thesis)", spec.title, spec.label, spec.figure), file,
          marks_in_words(chart.series) +
              std::string(spec.dumps > 0 ? fmt::format(" Simulated after load {}.", spec.dumps) : "")};
    });
  }
  return pictures;
}

std::vector<Picture> draw_velocity_trends(const std::vector<CaseResult>& cases,
                                          const std::filesystem::path& folder) {
  std::vector<Picture> pictures;
  for (const VelocityTrend& trend : velocity_trends(cases)) {
    const std::string what = quantity_in_words(trend.value.quantity) + " of " + trend.value.section;
    const double first = trend.means.front().x, last = trend.means.back().x, room = 0.1 * (last - first);
    ProfileChart chart{what + " over the velocity of the blade",
                       "velocity of the blade (m/s)",
                       what,
                       trend.value.quantity == "chi",
                       {{"", Kind::ours, 0, trend.means}},
                       {first - room, last + room}};
    if (!trend.printed.empty()) chart.series.push_back({"", Kind::pfc3d, 1, trend.printed});
    const auto file = folder / fmt::format("velocity_{}.svg", trend.value.quantity);
    add_picture(pictures, [&] {
      draw(chart, file);
      return Picture{chart.title, file, marks_in_words(chart.series)};
    });
  }
  return pictures;
}

}  // namespace scree
