#include "analysis/report/section_canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "analysis/pile/mass_quantile.h"
#include "analysis/report/pictures.h"

namespace scree {
namespace {

constexpr double kGap = 110, kNote = 44;  // pixels between panels, of a line of text
constexpr double kStrays = 0.002;         // of the mass, on either side
constexpr unsigned kRim = 0x202020;

std::string line(double x0, double z0, double x1, double z1) {
  return fmt::format(
      "set arrow from first {:.5g},{:.5g} to {:.5g},{:.5g} nohead front lw 1.5 lc rgb '#404040'\n", x0, z0,
      x1, z1);
}

std::string ground_line(const VerticalSection& section, const SectionFrame& frame) {
  if (!section.bench) return line(frame.left, 0, frame.right, 0);
  const double toe = section.bench->toe(), height = section.bench->height;
  return line(frame.left, height, 0, height) + line(0, height, toe, 0) + line(toe, 0, frame.right, 0);
}

}  // namespace

std::string sheet_head(double width, double height) {
  return fmt::format(
      "set terminal pngcairo noenhanced size {:.0f},{:.0f} font 'DejaVu Sans,11' fontscale 2 linewidth 2\n"
      "set minussign\nset border 3 lc rgb '#777777'\nset tics nomirror out scale 0.6 tc rgb '#333333'\n",
      width, height);
}

std::string panel_place(const SectionFrame& frame, double width, double height, double bottom, double up) {
  return fmt::format(
      "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset bmargin at screen {:.5f}\n"
      "set tmargin at screen {:.5f}\nset xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]\n"
      "set colorbox user origin screen {:.5f}, screen {:.5f} size screen {:.5f}, screen {:.5f}\n",
      kSheet.left / width, 1 - kSheet.right / width, bottom / height, (bottom + up) / height, frame.left,
      frame.right, frame.low, frame.high, 1 - (kSheet.right - 60) / width, bottom / height, 36 / width,
      up / height);
}

SectionFrame frame_of(const std::vector<Grain>& grains, const VerticalSection& section) {
  std::vector<WeighedValue> across;
  double largest = 0, top = section.ground(0);
  for (const Grain& grain : grains) {
    if (std::abs(grain.position.y() - section.y0) > section.half_width) continue;
    across.push_back({grain.position.x(), grain.mass});
    largest = std::max(largest, grain.diameter / 2);
    top = std::max(top, grain.position.z() + grain.diameter / 2);
  }
  if (across.empty()) throw std::invalid_argument("no grain lies in the section that is to be drawn");
  SectionFrame frame{mass_quantile(across, kStrays), mass_quantile(across, 1 - kStrays), 0, top};
  if (section.bench) {
    frame.left = std::min(frame.left, 0.0);
    frame.right = std::max(frame.right, section.bench->toe());
  }
  const double room = std::max(0.03 * (frame.right - frame.left), 1.5 * largest);
  frame.left -= room, frame.right += room;
  frame.high += 0.5 * room, frame.low -= std::max(0.3 * room, 0.6 * largest);
  return frame;
}

std::vector<const Grain*> grains_behind_cut(const std::vector<Grain>& grains,
                                            const VerticalSection& section) {
  std::vector<const Grain*> seen;
  for (const Grain& grain : grains)
    if (grain.position.y() >= section.y0 && grain.position.y() <= section.y0 + section.half_width)
      seen.push_back(&grain);
  std::stable_sort(seen.begin(), seen.end(),
                   [](const Grain* a, const Grain* b) { return a->position.y() > b->position.y(); });
  return seen;
}

SectionCanvas::SectionCanvas(const SectionFrame& frame, int panels, const VerticalSection& section,
                             const std::vector<std::string>& notes)
    : frame_(frame), panels_(panels), section_(section), notes_(notes) {
  const double across = frame.right - frame.left, up = frame.high - frame.low;
  // Several panels may be as high together as two single ones.
  pixels_a_metre_ =
      std::min(kSheet.most_across / across, (panels > 1 ? 2 : 1) * kSheet.most_up / (up * panels));
  width_ = kSheet.left + kSheet.right + pixels_a_metre_ * across;
  height_ = kSheet.below + kSheet.above + panels * pixels_a_metre_ * up + (panels - 1) * kGap +
            kNote * static_cast<double>(notes.size());
}

std::string SectionCanvas::head() const {
  std::string out = sheet_head(width_, height_) + "set clip one\nset multiplot\n";
  for (std::size_t k = 0; k < notes_.size(); ++k)
    out += fmt::format("set label {} {} at screen {:.5f}, screen {:.5f} left tc rgb '#444444'\n", k + 1,
                       gnuplot_quoted(notes_[k]), kSheet.left / width_,
                       kNote * (static_cast<double>(notes_.size() - k) - 0.4) / height_);
  return out;
}

std::string SectionCanvas::panel(int index, const std::string& title, const std::string& colour_label) const {
  const double up = pixels_a_metre_ * (frame_.high - frame_.low);
  const double bottom =
      kSheet.below + kNote * static_cast<double>(notes_.size()) + (panels_ - 1 - index) * (up + kGap);
  const bool last = index == panels_ - 1;
  std::string out = panel_place(frame_, width_, height_, bottom, up);
  out += fmt::format("set xlabel {}\nset ylabel 'height, z (m)'\nset title {} offset 0,-0.3\n",
                     last ? (section_.bench ? "'distance from the crest, x (m)'" : "'x (m)'") : "''",
                     gnuplot_quoted(title));
  out += fmt::format("set format x '{}'\nset cblabel {}\n", last ? "%g" : "", gnuplot_quoted(colour_label));
  return out + "unset arrow\n" + ground_line(section_, frame_);
}

std::string disc_block(const std::vector<Grain>& grains, const std::vector<Grain>& fixed,
                       const VerticalSection& section, const SectionCanvas& canvas,
                       const std::function<unsigned(const Grain&)>& colour) {
  std::string rows = "$discs << END\n";
  const auto add = [&](const Grain& grain, unsigned fill) {
    const double r = grain.diameter / 2, x = grain.position.x();
    if (x + r < canvas.frame().left || x - r > canvas.frame().right) return;
    // Two discs, a dark one under a coloured one, give a rim that never swallows a small grain's colour.
    const double rim = std::min(1.5 * canvas.metres_a_pixel(), 0.15 * r);
    rows += fmt::format("{0:.5g} {1:.5g} {2:.5g} {3}\n{0:.5g} {1:.5g} {4:.5g} {5}\n", x, grain.position.z(),
                        r, kRim, r - rim, fill);
  };
  for (const Grain* ball : grains_behind_cut(fixed, section)) add(*ball, kFixedGrey);
  for (const Grain* grain : grains_behind_cut(grains, section)) add(*grain, colour(*grain));
  return rows + "END\n";
}

std::string plot_discs(double scale_value, const std::string& above) {
  // The last curve draws nothing: it makes gnuplot show the colour scale.
  return fmt::format(
      "$none << END\n0 1e9 {:.6g}\nEND\nplot $discs using 1:2:3:4 with circles lc rgb variable fs solid 1.0 "
      "noborder notitle{}, $none using 1:2:3 with points ps 0 lc palette notitle\n",
      scale_value, above);
}

std::string cut_words(const VerticalSection& section) {
  return fmt::format("cut at y = {:.3g} m, grains up to {:.3g} m behind it", section.y0 + 0.0,
                     section.half_width);
}

double round_number_above(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= least * (1 - 1e-9)) return step * power;
  return 10 * power;
}

}  // namespace scree
