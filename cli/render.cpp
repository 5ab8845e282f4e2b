// scree render: a virtual photograph of known rock.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "analysis/image/image_bias.h"
#include "analysis/image/picture_file.h"
#include "analysis/image/render_photo.h"
#include "analysis/pile/slope_profile.h"
#include "cli/commands.h"
#include "cli/option_values.h"
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

scree::RockScene scene_of(const RenderOptions& options, const scree::SceneSettings& settings) {
  if (options.snapshot.empty()) {
    const fs::path known = asset_dir() / "gradings" / (options.grading + ".csv");
    const scree::Grading grading =
        scree::read_grading(fs::exists(options.grading) ? fs::path(options.grading) : known);
    if (options.coverage) return make_scene(grading, settings);
    scree::SceneSettings lowered = settings;
    scree::RockScene scene = make_scene_with_room(grading, lowered);
    if (lowered.coverage < settings.coverage)
      fmt::print("coverage: {:.2f}; at {:.2f} this rock finds no room\n", lowered.coverage,
                 settings.coverage);
    return scene;
  }
  scree::SnapshotRead read = scree::read_snapshot(options.snapshot, {});
  std::optional<double> slope = options.slope;
  if (!slope) {
    double top = 0;
    for (const scree::Grain& grain : read.snapshot.grains) top = std::max(top, grain.position.z());
    if (top > 0)
      if (const auto line = scree::slope_line(scree::slope_profile(read.snapshot.grains, top), top))
        slope = line->angle;
    if (!slope)
      throw scree::FileError(options.snapshot, 0,
                             "shows no slope along x; say at which angle it is seen: --slope 37");
    fmt::print("slope: {:.1f} degrees\n", *slope);
  }
  return scree::view_of_slope(read.snapshot.grains, read.fixed, *slope, 0.5);
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
  scree::Photo made;
  try {
    made = scree::render_photo(scene_of(options, scene), photo);
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
  if (options.out.has_parent_path()) fs::create_directories(options.out.parent_path());
  scree::write_picture(options.out, made.picture);
  scree::write_text_file(truth, scree::truth_csv(made.truth));
  std::string chi;
  const auto gradings =
      true_gradings(made.truth, scree::PhotoRegion(made.picture.size(), {}), scree::PhotoAnalysisSettings{});
  for (std::size_t k = 1; k < gradings.size(); ++k)
    chi += gradings[k].grains > 0 ? fmt::format(" {:+.2f}", gradings[k].chi) : " -";
  fmt::print(
      "{}: {} x {} px, {:.4g} cm/px, {} grains to be seen, D50 of the rock {:.3g} m\nchi of S1, the top, to "
      "S{}:{}\ntruth: {}\n",
      options.out.string(), made.picture.cols, made.picture.rows, 100 * photo.m_per_px,
      made.truth.grains.size(), made.truth.scene_d50, gradings.size() - 1, chi, truth.string());
  return kOk;
}
