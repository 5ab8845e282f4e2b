#include "analysis/report/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/pile/heaviest_cut.h"
#include "analysis/report/section_canvas.h"
#include "analysis/results/summary.h"

namespace scree {
namespace {

constexpr std::array<unsigned, 9> kViridis{0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c,
                                           0x28ae80, 0x5ec962, 0xaddc30, 0xfde725};

constexpr unsigned kRockRim = 0x202020, kGroundRim = 0x909090;

/// Where discs lie in a view, and what is drawn first.
struct Disc {
  double across = 0, up = 0, depth = 0, radius = 0, diameter = 0;  // m; larger depth is farther
};

struct View {
  std::vector<Disc> discs, ground;  // ground: fixed balls, under everything else
  std::string across_label, up_label, title;
  std::string under, over;  // gnuplot lines, drawn before and after the discs
  SectionFrame frame;
};

struct SizeRange {
  double low = 0, high = 0;  // m
};

SizeRange size_range(const std::vector<Grain>& grains) {
  SizeRange range{std::numeric_limits<double>::max(), 0};
  for (const Grain& grain : grains) {
    range.low = std::min(range.low, grain.diameter);
    range.high = std::max(range.high, grain.diameter);
  }
  if (range.high < 1.01 * range.low) range = {range.low / 1.1, range.high * 1.1};
  return range;
}

/// Two discs a grain, a dark one under a coloured one, give an outline that never swallows a small grain's
/// colour.
std::string disc_rows(std::vector<Disc> discs, double metres_a_pixel, unsigned rim,
                      const std::function<unsigned(const Disc&)>& fill) {
  std::sort(discs.begin(), discs.end(), [](const Disc& a, const Disc& b) { return a.depth > b.depth; });
  std::string rows;
  for (const Disc& disc : discs) {
    const double outline = std::min(1.5 * metres_a_pixel, 0.15 * disc.radius);
    rows += fmt::format("{:.5g} {:.5g} {:.5g} {}\n", disc.across, disc.up, disc.radius, rim);
    rows += fmt::format("{:.5g} {:.5g} {:.5g} {}\n", disc.across, disc.up, disc.radius - outline, fill(disc));
  }
  return rows;
}

std::string script(const View& view, const SizeRange& range) {
  const double across = view.frame.right - view.frame.left, up = view.frame.high - view.frame.low;
  const double pixels_a_metre = std::min(kSheet.most_across / across, kSheet.most_up / up);
  const double width = kSheet.left + kSheet.right + pixels_a_metre * across;
  const double height = kSheet.below + kSheet.above + pixels_a_metre * up;
  std::string out =
      sheet_head(width, height) + panel_place(view.frame, width, height, kSheet.below, pixels_a_metre * up);
  out += fmt::format("set xlabel {}\nset ylabel {}\nset title {} offset 0,-0.3\n",
                     gnuplot_quoted(view.across_label), gnuplot_quoted(view.up_label),
                     gnuplot_quoted(view.title));
  out += viridis_palette() + "set logscale cb\n";
  out += fmt::format(
      "set cbrange [{:.6g}:{:.6g}]\nset cbtics ({}) scale 0.4\nset cblabel 'grain diameter (m)'\n", range.low,
      range.high, log_ticks(range.low, range.high));
  const auto by_size = [&](const Disc& disc) {
    return viridis(std::log(disc.diameter / range.low) / std::log(range.high / range.low));
  };
  const auto grey = [](const Disc&) { return kFixedGrey; };
  out += "$discs << END\n" + disc_rows(view.ground, 1 / pixels_a_metre, kGroundRim, grey) +
         disc_rows(view.discs, 1 / pixels_a_metre, kRockRim, by_size) + "END\n";
  out += view.under + plot_discs(range.low, view.over);
  return out;
}

double ceiling_to(double value, double step) {
  return std::ceil(value / step) * step;
}

/// Room around the discs, with the bench when there is one.
SectionFrame frame_around(const std::vector<Disc>& discs, double bench_height) {
  SectionFrame frame{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest(), 0,
                     bench_height};
  double largest = 0;
  for (const Disc& disc : discs) {
    frame.left = std::min(frame.left, disc.across - disc.radius);
    frame.right = std::max(frame.right, disc.across + disc.radius);
    frame.low = std::min(frame.low, disc.up - disc.radius);
    frame.high = std::max(frame.high, disc.up + disc.radius);
    largest = std::max(largest, disc.radius);
  }
  const double room = std::max(0.03 * (frame.right - frame.left), largest);
  frame.left -= room;
  frame.right += room;
  frame.high += room;
  frame.low -= 0.3 * room;
  return frame;
}

std::string line(double x0, double z0, double x1, double z1, const char* look) {
  return fmt::format("set arrow from first {:.5g},{:.5g} to {:.5g},{:.5g} nohead {}\n", x0, z0, x1, z1, look);
}

/// Boundaries of the sections with their names, at the right of the view.
std::string section_lines(const RunResult& result, const SectionFrame& frame) {
  const SectionTable* table = section_layout(result, 0);
  if (!table || result.bench_height <= 0) return "";
  std::string out;
  const double step = result.bench_height / static_cast<double>(table->sections.size());
  for (std::size_t i = 0; i <= table->sections.size(); ++i) {
    const double z = result.bench_height - step * static_cast<double>(i);
    out += line(frame.left, z, frame.right, z, "back lw 1.2 dt 3 lc rgb '#606060'");
    if (i < table->sections.size())
      out += fmt::format("set label {} at {:.5g},{:.5g} right offset -0.5,0 tc rgb '#555555'\n",
                         gnuplot_quoted(table->sections[i].name), frame.right, z - step / 2);
  }
  return out;
}

std::string bench_lines(const RunResult& result, const SceneFacts& scene, const SectionFrame& frame) {
  const double height = result.bench_height;
  if (height <= 0 || !scene.bench_slope) return "";
  const double toe = height / std::tan(*scene.bench_slope * std::numbers::pi / 180);
  const char* look = "front lw 1.5 lc rgb '#404040'";
  return line(frame.left, height, 0, height, look) + line(0, height, toe, 0, look) +
         line(toe, 0, frame.right, 0, look);
}

/// The straight flanks whose slope is the repose angle.
std::string cone_lines(const ReposeAngle& repose, double centre) {
  const char* look = "front lw 1.5 dt 2 lc rgb '#d55e00'";
  const double top = repose.flank_height, foot = top / std::tan(repose.angle * std::numbers::pi / 180);
  if (!std::isfinite(foot)) return "";
  return line(centre - foot, 0, centre, top, look) + line(centre, top, centre + foot, 0, look);
}

Disc seen_along_the_crest(const Grain& grain) {
  return {grain.position.x(), grain.position.z(), grain.position.y(), grain.diameter / 2, grain.diameter};
}

View cut_view(const RunResult& result, const SceneFacts& scene, const SeedResult& seed, double largest) {
  const std::vector<Grain>& grains = seed.final_state.grains;
  const double depth = ceiling_to(1.5 * largest, largest < 0.3 ? 0.05 : 0.5);
  const double cut = heaviest_cut(grains, depth);
  View view;
  double moment = 0, mass = 0;
  for (const Grain& grain : grains) {
    moment += grain.mass * grain.position.x();
    mass += grain.mass;
    if (in_cut(grain, cut, depth)) view.discs.push_back(seen_along_the_crest(grain));
  }
  view.frame = frame_around(view.discs, result.bench_height);
  for (const Grain& ball : seed.fixed) {
    const Disc disc = seen_along_the_crest(ball);
    if (!in_cut(ball, cut, depth) || disc.across + disc.radius < view.frame.left ||
        disc.across - disc.radius > view.frame.right)
      continue;
    view.ground.push_back(disc);
    view.frame.low = std::min(view.frame.low, disc.up - 1.05 * disc.radius);
  }
  view.title = fmt::format("Cut at y = {:.2g} m: grains up to {:.2g} m behind it", cut + 0.0, depth);
  view.across_label = result.bench_height > 0 ? "distance from the crest, x (m)" : "x (m)";
  view.up_label = "height, z (m)";
  view.under = section_lines(result, view.frame) + bench_lines(result, scene, view.frame);
  if (seed.repose && mass > 0) view.under += cone_lines(*seed.repose, moment / mass);
  return view;
}

View toe_view(const RunResult& result, const SeedResult& seed) {
  View view;
  for (const Grain& grain : seed.final_state.grains)
    view.discs.push_back(
        {grain.position.y(), grain.position.z(), -grain.position.x(), grain.diameter / 2, grain.diameter});
  view.frame = frame_around(view.discs, result.bench_height);
  view.title = "The slope seen from the toe";
  view.across_label = "along the crest, y (m)";
  view.up_label = "height, z (m)";
  view.under = section_lines(result, view.frame);
  return view;
}

}  // namespace

std::string log_ticks(double low, double high) {
  std::string ticks;
  for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (const double size = decade * step; size >= low * 0.999 && size <= high * 1.001)
        ticks += fmt::format("{}'{:.3g}' {:.6g}", ticks.empty() ? "" : ", ", size, size);
  return ticks;
}

std::string viridis_palette() {
  std::string out = "set palette defined (";
  for (std::size_t i = 0; i < kViridis.size(); ++i)
    out += fmt::format("{}{} '#{:06x}'", i ? ", " : "", i, kViridis[i]);
  return out + ")\n";
}

unsigned viridis(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kViridis.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), kViridis.size() - 2);
  unsigned colour = 0;
  for (const unsigned shift : {16U, 8U, 0U}) {
    const double a = (kViridis[i] >> shift) & 0xFF, b = (kViridis[i + 1] >> shift) & 0xFF;
    colour |= static_cast<unsigned>(std::lround(a + (b - a) * (at - static_cast<double>(i)))) << shift;
  }
  return colour;
}

std::vector<Picture> draw_pile(const RunResult& result, const SceneFacts& scene,
                               const std::filesystem::path& folder) {
  const auto seed = std::find_if(result.seeds.begin(), result.seeds.end(),
                                 [](const SeedResult& one) { return !one.final_state.grains.empty(); });
  if (seed == result.seeds.end() || seed->rebound_height) return {};
  const SizeRange range = size_range(seed->final_state.grains);
  const std::string which = fmt::format("seed {}", seed->seed);
  std::vector<Picture> pictures;
  const auto draw = [&](const View& view, const char* name, const std::string& title,
                        const std::string& caption) {
    add_picture(pictures, [&] {
      run_gnuplot(script(view, range), folder / name);
      return Picture{title, folder / name, caption};
    });
  };
  const View cut = cut_view(result, scene, *seed, range.high);
  const std::string ground = cut.ground.empty() ? "" : " Grey balls are the fixed ones of the ground.";
  if (result.bench_height > 0) {
    draw(cut, "pile_cut.png", "Cut through the pile",
         fmt::format("The rock inside the pile ({}), cut where it is heaviest: dark grains are fine, yellow "
                     "ones coarse; the dotted lines part the sections.{}",
                     which, ground));
    draw(toe_view(result, *seed), "pile_front.png", "Slope from the toe",
         fmt::format("What a person at the toe sees ({}); the dotted lines part the sections.{}", which,
                     cut.ground.empty() ? "" : " The fixed balls of the ground are left out."));
  } else {
    draw(cut, "heap_cut.png", "Cut through the heap",
         fmt::format("The heap ({}): dark grains are fine, yellow ones coarse.{}{}", which,
                     seed->repose ? " A dashed line is the flank whose slope is the repose angle." : "",
                     ground));
  }
  return pictures;
}

}  // namespace scree
