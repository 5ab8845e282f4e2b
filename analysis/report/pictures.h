#pragma once
// Pictures of a run, drawn by gnuplot: views of the pile as PNG, charts as SVG.
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/results/results.h"

namespace scree {

/// A picture on disk and what a reader needs beside it.
struct Picture {
  std::string title;
  std::filesystem::path file;  ///< .png, .jpg or .svg
  std::string caption;         ///< one sentence
  std::string why_missing{};   ///< gnuplot's words where it refused this one; empty: the picture is there
};

/// What a run's result does not say about its scene.
struct SceneFacts {
  std::optional<double>
      bench_slope;  ///< initial slope of the bench, degrees; its outline is left out without it
};

/// Views of the first seed's pile, each grain a disc coloured by its diameter: a cut through the heaviest
/// part seen along the crest, and the slope seen from the toe (end dumping only). None without grains
/// or of a drop test. Drawn by add_picture().
std::vector<Picture> draw_pile(const RunResult& result, const SceneFacts& scene,
                               const std::filesystem::path& folder);

/// Charts over all seeds: segregation degree, relative diameters, passing curves, slope profile, repose
/// angle; each only when the run has its numbers. Drawn by add_picture().
std::vector<Picture> draw_charts(const RunResult& result, const SceneFacts& scene,
                                 const std::filesystem::path& folder);

/// Gnuplot ran and refused a picture.
struct GnuplotFailed : std::runtime_error {
  GnuplotFailed(std::filesystem::path refused, const std::string& words)
      : std::runtime_error(words), picture(std::move(refused)) {}
  std::filesystem::path picture;
};

/// Runs a gnuplot script that draws one picture; `output` is set here. Throws std::runtime_error with the
/// package to install when gnuplot is missing, GnuplotFailed with gnuplot's own words when it fails.
void run_gnuplot(const std::string& script, const std::filesystem::path& output);

/// Adds what `draw` gives, if it gives anything, or why gnuplot refused it: one picture must not cost a long
/// run its report.
void add_picture(std::vector<Picture>& pictures, const std::function<std::optional<Picture>()>& draw);

/// Terminal, axes and grid of every chart (SVG), size in pixels.
std::string chart_terminal(int width, int height);

/// Text as a gnuplot string in which nothing is expanded.
std::string gnuplot_quoted(std::string_view text);

/// Ticks of a logarithmic axis at 1, 2, 5 times powers of ten, as gnuplot lists them.
std::string log_ticks(double low, double high);

/// Colour of viridis (van der Walt and Smith, 2015) at a share from 0 (dark blue) to 1 (yellow), 0xRRGGBB.
unsigned viridis(double share);
/// The palette of viridis(), as a line for gnuplot.
std::string viridis_palette();

}  // namespace scree
