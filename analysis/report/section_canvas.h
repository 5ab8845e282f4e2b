#pragma once
// The sheet on which pictures of a vertical section are drawn: panels below each other, axes, bench.
#include <functional>
#include <string>
#include <vector>

#include "analysis/pile/vertical_section.h"
#include "sim/io/snapshot.h"

namespace scree {

/// The part of a section that a picture shows, m.
struct SectionFrame {
  double left = 0, right = 0, low = 0, high = 0;
};

/// Pixels of a picture, which is twice screen size: of the drawn area, all panels together, and around it.
inline constexpr struct {
  double most_across = 2000, most_up = 1400, left = 170, right = 300, below = 140, above = 90;
} kSheet;

/// Colour of fixed balls of the ground, 0xRRGGBB.
inline constexpr unsigned kFixedGrey = 0xd4d4d4;

/// Gnuplot lines of the terminal and the look of axes, for a picture of this many pixels.
std::string sheet_head(double width, double height);

/// Gnuplot lines that place a panel and its colour scale on such a sheet: `bottom` and height `up` in pixels.
std::string panel_place(const SectionFrame& frame, double width, double height, double bottom, double up);

/// Room around the grains of the section and its bench. The outermost 0.2 % of the mass on either side do not
/// widen it, so a stone that rolled far leaves the pile large. Throws std::invalid_argument when no grain
/// lies in the section.
SectionFrame frame_of(const std::vector<Grain>& grains, const VerticalSection& section);

/// Grains in front of whose centres nothing of the band is left, the farthest first: those from y0 to
/// y0 + half_width, as one who looks along y sees them behind a cut at y0.
std::vector<const Grain*> grains_behind_cut(const std::vector<Grain>& grains, const VerticalSection& section);

/// Gnuplot lines for panels of one frame and scale below each other, as PNG of twice the screen's resolution.
class SectionCanvas {
 public:
  /// `notes` are lines of text (0 to 3) under the panels.
  SectionCanvas(const SectionFrame& frame, int panels, const VerticalSection& section,
                const std::vector<std::string>& notes = {});

  const SectionFrame& frame() const { return frame_; }
  /// Terminal, styles; to be written first.
  std::string head() const;
  /// Place, axes, title and outline of the bench of panel 0, 1, ... from above; the label of its colours.
  std::string panel(int index, const std::string& title, const std::string& colour_label) const;
  double metres_a_pixel() const { return 1 / pixels_a_metre_; }

 private:
  SectionFrame frame_;
  int panels_;
  VerticalSection section_;
  std::vector<std::string> notes_;
  double pixels_a_metre_ = 0, width_ = 0, height_ = 0;
};

/// The data block $discs: grains behind the cut with a dark rim, above the fixed balls in grey. `colour`
/// gives 0xRRGGBB.
std::string disc_block(const std::vector<Grain>& grains, const std::vector<Grain>& fixed,
                       const VerticalSection& section, const SectionCanvas& canvas,
                       const std::function<unsigned(const Grain&)>& colour);

/// The plot command of $discs with the colour scale beside it. `scale_value` is any value on the scale,
/// `above` further plot elements, each after a comma, that are drawn above the discs.
std::string plot_discs(double scale_value, const std::string& above = "");

/// Where the cut lies, in words.
std::string cut_words(const VerticalSection& section);

/// The least of 1, 2, 5 times a power of ten that is not below `least` (above 0).
double round_number_above(double least);

}  // namespace scree
