// scree render: a virtual photograph of known rock.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "analysis/image/image_bias.h"
#include "analysis/image/picture_file.h"
#include "analysis/image/render_photo.h"
#include "analysis/image/slope_view.h"
#include "cli/bench_in_file.h"
#include "cli/commands.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "cli/picture_options.h"
#include "sim/io/snapshot_reader.h"
#include "sim/io/text_file.h"
#include "sim/material/input_text.h"

namespace fs = std::filesystem;

namespace {

bool settings_of(const RenderOptions& options, scree::PhotoSettings& photo, scree::SceneSettings& scene) {
  const auto scale = scale_in("--scale", options.scale);
  const auto sun = pair_in("--sun", options.sun, ',');
  const auto pixels = pair_in("--pixels", options.pixels, 'x');
  if (!scale || !sun || !pixels) return false;
  if (!(sun->second >= 5 && sun->second <= 90)) {
    fmt::print(stderr, "--sun {}: azimuth and elevation in degrees; the elevation is 5 to 90\n", options.sun);
    return false;
  }
  photo.target_diameter = 0;
  if (options.target_diameter != "none") {
    const auto target = length_in("--target-diameter", options.target_diameter);
    if (!target) return false;
    photo.target_diameter = *target;
  }
  photo.m_per_px = *scale;
  photo.sun_azimuth_deg = sun->first;
  photo.sun_elevation_deg = sun->second;
  photo.ambient = options.ambient;
  photo.texture = options.texture;
  photo.blur_px = options.blur;
  photo.noise = options.noise;
  photo.seed = scene.seed = options.seed;
  if (!(pixels->first >= 1 && pixels->second >= 1 &&
        pixels->first * pixels->second <= static_cast<double>(scree::kLargestPicture))) {
    fmt::print(stderr, "--pixels {}: WIDTHxHEIGHT, at most {} megapixels\n", options.pixels,
               scree::kLargestPicture / 1'000'000);
    return false;
  }
  scene.width = std::round(pixels->first) * *scale;
  scene.height = std::round(pixels->second) * *scale;
  scene.target_margin = 1.35 * photo.target_diameter;
  scene.segregation = options.segregation;
  if (options.layout == "touching") {
    scene.layout = scree::GrainLayout::touching;
    scene.coverage = 0.5;
  } else if (options.layout == "overlapping") {
    scene.layout = scree::GrainLayout::overlapping;
    scene.coverage = 1.5;
  }
  if (options.coverage) scene.coverage = *options.coverage;
  return true;
}

// A scene, and where in it a pile has its slope.
struct View {
  scree::RockScene scene;
  std::optional<scree::PileSlope> slope;
  std::optional<BenchInFile> bench;
};

View view_of_pile(const RenderOptions& options) {
  scree::SnapshotRead read = scree::read_snapshot(options.snapshot, {});
  View view;
  view.bench = bench_in_file(options.snapshot);
  view.slope =
      slope_of_pile(read.snapshot.grains, view.bench ? std::optional(view.bench->height) : std::nullopt);
  std::optional<double> seen_at = options.slope;
  if (!seen_at) {
    if (!view.slope)
      throw scree::FileError(options.snapshot, 0,
                             "shows no slope along x; say at which angle it is seen: --slope 37");
    seen_at = view.slope->angle;
    fmt::print("slope: {:.1f} degrees\n", *seen_at);
  }
  view.scene = scree::view_of_slope(read.snapshot.grains, read.fixed, *seen_at, 0.5);
  return view;
}

View view_of(const RenderOptions& options, const scree::SceneSettings& settings) {
  if (!options.snapshot.empty()) return view_of_pile(options);
  const fs::path known = asset_dir() / "gradings" / (options.grading + ".csv");
  const scree::Grading grading =
      scree::read_grading(fs::exists(options.grading) ? fs::path(options.grading) : known);
  if (options.coverage) return {make_scene(grading, settings), {}, {}};
  scree::SceneSettings lowered = settings;
  View view{make_scene_with_room(grading, lowered), {}, {}};
  if (lowered.coverage < settings.coverage)
    fmt::print("coverage: {:.2f}; at {:.2f} this rock finds no room\n", lowered.coverage, settings.coverage);
  return view;
}

// The picture's slope, as `scree image` takes it.
void print_region(const View& view, const std::string& region) {
  fmt::print("slope, {}: --region \"{}\"{}\n",
             view.bench ? "crest to toe of the run's bench" : "the fitted line from the pile's top to z = 0",
             region, view.bench ? fmt::format(" --sections {}", view.bench->sections) : "");
}

}  // namespace

int run_render(const RenderOptions& options) {
  scree::PhotoSettings photo;
  scree::SceneSettings scene;
  if (!settings_of(options, photo, scene)) return kBadInput;
  const std::string ending = options.out.extension().string();
  if (ending != ".png" && ending != ".jpg") {
    fmt::print(stderr, "{}: the picture's name must end with .png or .jpg\n", options.out.string());
    return kBadInput;
  }
  const fs::path truth = fs::path(options.out).replace_extension(".truth.csv");
  for (const fs::path& file : {options.out, truth})
    if (fs::exists(file) && !options.force) {
      fmt::print(stderr, "{}: is there already; choose another name, or --force to write over it\n",
                 file.string());
      return kBadInput;
    }
  const fs::path folder = options.out.has_parent_path() ? options.out.parent_path() : ".";
  if (std::error_code none; !fs::exists(folder, none)) {
    if (!well_named(options.out) || !may_fill(folder, true)) return kBadInput;
  } else if (!may_write(options.out) || !may_write(truth)) {
    return kBadInput;
  }
  scree::Photo made;
  View view;
  std::optional<std::array<int, 4>> region;
  try {
    view = view_of(options, scene);
    made = scree::render_photo(view.scene, photo);
    if (view.slope) region = slope_region(view.scene, *view.slope, photo.m_per_px);
    if (region) made.truth.region = scree::region_text(*region);
  } catch (const scree::FileError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kBadInput;
  } catch (const std::runtime_error& error) {  // a grading that cannot be read
    fmt::print(stderr, "{}\n", error.what());
    return kBadInput;
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "scree: {}\n", error.what());
    return kBadInput;
  }
  if (!prepare_folder(folder, true) || !may_write(options.out) || !may_write(truth)) return kBadInput;
  scree::write_picture(options.out, made.picture);
  scree::write_text_file(truth, scree::truth_csv(made.truth));
  std::string chi;
  scree::PhotoAnalysisSettings analysis;
  if (view.bench) analysis.sections = view.bench->sections;
  if (region) analysis.region = *polygon_in("--region", made.truth.region);
  const auto gradings =
      true_gradings(made.truth, scree::PhotoRegion(made.picture.size(), analysis.region), analysis);
  for (std::size_t k = 1; k < gradings.size(); ++k)
    chi += gradings[k].grains > 0 ? fmt::format(" {:+.2f}", gradings[k].chi) : " -";
  fmt::print(
      "{}: {} x {} px, {:.4g} cm/px, {} grains to be seen, D50 of the rock {:.3g} m\nchi of S1, the top, to "
      "S{}:{}\ntruth: {}\n",
      options.out.string(), made.picture.cols, made.picture.rows, 100 * photo.m_per_px,
      made.truth.grains.size(), made.truth.scene_d50, gradings.size() - 1, chi, truth.string());
  if (region) print_region(view, made.truth.region);
  return kOk;
}
