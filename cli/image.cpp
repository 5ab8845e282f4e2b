// scree image: photographs of a slope as gradings of its sections.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <regex>
#include <set>

#include "analysis/image/image_report.h"
#include "analysis/image/picture_file.h"
#include "analysis/report/report_text.h"
#include "analysis/results/results.h"
#include "cli/commands.h"
#include "cli/ensemble/dataset_write.h"
#include "cli/ensemble/output_scope.h"
#include "cli/ensemble/scenario_patch.h"
#include "cli/option_values.h"
#include "cli/output_folder.h"
#include "cli/picture_options.h"
#include "cli/written_dataset.h"
#include "scree_version.h"
#include "sim/io/text_file.h"
#include "sim/material/input_text.h"
#include "sim/scene/scenario.h"

namespace fs = std::filesystem;

namespace {

constexpr int kOverlaySide = 1600;  // px

bool settings_of(const ImageOptions& options, scree::PhotoAnalysisSettings& settings) {
  if (!options.scale.empty()) {
    settings.m_per_px = scale_in("--scale", options.scale);
    if (!settings.m_per_px) return false;
  }
  const auto target = length_in("--target-diameter", options.target_diameter);
  if (!target) return false;
  settings.target_diameter = *target;
  if (!options.region.empty()) {
    const auto region = polygon_in("--region", options.region);
    if (!region) return false;
    settings.region = *region;
  }
  for (const scree::SizeModel model : scree::kSizeModels)
    if (name_of(model) == options.model) settings.model = model;
  settings.sections = options.sections;
  settings.detection_area = 1e-4 * options.detection_limit_cm2;
  settings.density = options.density;
  settings.neck = options.neck;
  settings.threshold = options.threshold == "local" ? scree::Threshold::local : scree::Threshold::otsu;
  settings.edges = !options.no_edges;
  settings.rock_within_frame = !options.truth.empty();  // scree render lays it so
  if (options.shape_factor > 0) settings.shape_factor = options.shape_factor;
  return true;
}

scree::PhotoAnalysis analyse(const fs::path& file, const cv::Mat3b& picture,
                             const scree::PhotoAnalysisSettings& settings) {
  try {
    return scree::analyse_photo(picture, settings);
  } catch (const std::runtime_error& error) {
    throw scree::FileError(file, 0, error.what());
  }
}

// Lambda for which photographs of weighed rock give its mass; the table names them relative to itself.
double shape_factor_from(const fs::path& table_file, scree::PhotoAnalysisSettings settings) {
  scree::DelimitedTable table(table_file);
  const auto photo = table.column("photo"), mass = table.column("mass_kg");
  if (!photo || !mass)
    throw scree::FileError(table_file, table.header_line(), "needs the columns `photo,mass_kg`");
  settings.shape_factor = 1;
  settings.sections = 1;
  if (settings.model == scree::SizeModel::sphere) settings.model = scree::SizeModel::ellipsoid;
  std::vector<scree::WeighedFraction> fractions;
  while (table.next()) {
    const auto weighed = table.number(*mass);
    if (!weighed || !(*weighed > 0)) table.fail("`mass_kg` must be a number above 0");
    const fs::path file = table_file.parent_path() / table.field(*photo);
    const scree::PhotoAnalysis found = analyse(file, scree::read_photograph(file), settings);
    fractions.push_back(
        {table.field(*photo), *weighed, scree::gradings_of(found.grains, 1, settings.model)[0].mass});
  }
  if (fractions.empty()) throw scree::FileError(table_file, 0, "has no rows");
  const scree::ShapeFactor factor = scree::calibrate_shape_factor(fractions);
  fmt::print("shape factor from weighed rock ({}):\n", name_of(settings.model));
  for (std::size_t i = 0; i < fractions.size(); ++i)
    fmt::print("  {:<28} {:>8} kg weighed, lambda {:.3f}\n", fractions[i].name,
               scree::number_text(fractions[i].weighed), factor.by_fraction[i]);
  const scree::MeanStd spread = scree::mean_std(factor.by_fraction);
  fmt::print("  together lambda = {:.3f}{}\n", factor.value,
             spread.n > 1 ? fmt::format(" (deviation between fractions {:.3f})", spread.std) : "");
  return factor.value;
}

void print_gradings(const scree::AnalysedPhoto& photo) {
  fmt::print("{}: {} grains, {:.4g} cm/px\n", photo.name, photo.found.grains.size(),
             100 * photo.found.scale.at(photo.found.region.middle_y()));
  for (const std::string& note : photo.found.notes) fmt::print("note: {}\n", note);
  fmt::print("{:<8} {:>7} {:>8} {:>8} {:>8} {:>8} {:>6} {:>6} {:>7}\n", "section", "grains", "D10, cm",
             "D50, cm", "D80, cm", "D95, cm", "Cu", "Cc", "chi");
  for (const scree::ImageGrading& g : photo.gradings) {
    fmt::print("{:<8} {:>7}", g.name, g.grains);
    if (g.curve)
      fmt::print(" {:>8.1f} {:>8.1f} {:>8.1f} {:>8.1f} {:>6.2f} {:>6.2f} {:>7}", 100 * g.d10, 100 * g.d50,
                 100 * g.d80, 100 * g.d95, g.cu, g.cc,
                 std::isfinite(g.chi) ? fmt::format("{:.2f}", g.chi) : "-");
    fmt::print("\n");
  }
}

// `bodies`: what masses are those of, said where the rock is not.
void print_check(const scree::TruthCheck& check, const std::string& bodies) {
  if (!check.known[0].curve) {
    fmt::print("known rock: none of it in sight here; is this the truth of this picture?\n");
    return;
  }
  double worst = 0;
  for (std::size_t k = 1; k < check.known.size(); ++k)
    if (std::isfinite(check.known[k].chi))
      worst = std::fmax(worst, std::isfinite(check.measured[k].chi)
                                   ? std::abs(check.measured[k].chi - check.known[k].chi)
                                   : INFINITY);
  const scree::ImageGrading &known = check.known[0], &measured = check.measured[0], &ideal = check.ideal[0];
  const auto row = [](const char* name, const std::array<double, 4>& values, const char* format) {
    fmt::print("{:<22}", name);
    for (const double value : values) fmt::print(" {:>9}", fmt::format(fmt::runtime(format), value));
    fmt::print("\n");
  };
  const auto of = [](const scree::ImageGrading& g) {
    return std::array{100 * g.d10, 100 * g.d50, 100 * g.d80, g.mass / 1000};
  };
  const auto error = [](double is, double should) { return 100 * (is / should - 1); };
  fmt::print("{:<22} {:>9} {:>9} {:>9} {:>9}\n", "rock that can be seen", "D10, cm", "D50, cm", "D80, cm",
             "mass, t");
  row("  measured", of(measured), "{:.4g}");
  row("  known", of(known), "{:.4g}");
  row("  error, %",
      {error(measured.d10, known.d10), error(measured.d50, known.d50), error(measured.d80, known.d80),
       error(measured.mass, known.mass)},
      "{:+.1f}");
  fmt::print(
      " {:.0f} % of the known mass is seen{}; perfect outlines: D10 {:+.1f} %, D50 {:+.1f} %, D80 {:+.1f} "
      "%\n",
      100 * check.mass_seen(), bodies, error(ideal.d10, known.d10), error(ideal.d50, known.d50),
      error(ideal.d80, known.d80));
  fmt::print("all rock: D50 {:.1f} cm, measured {:+.1f} % off; largest error of chi {:.2f}\n",
             100 * check.scene_d50, error(measured.d50, check.scene_d50), worst);
}

void print_bias(const scree::ImageBias& bias) {
  fmt::print("bias against size: {} outlines, {} of them known grains\n{:>16} {:>8} {:>9} {:>6} {:>12}\n",
             bias.outlines, bias.matched, "diameter, m", "visible", "detected", "ratio", "std ln ratio");
  for (const scree::BiasClass& size : bias.classes)
    fmt::print("{:>16} {:>8} {:>8.0f}% {:>6} {:>12}\n", fmt::format("{:.3f} - {:.3f}", size.low, size.high),
               size.visible, 100.0 * size.detected / size.visible, scree::decimals_text(size.ratio, 2),
               scree::decimals_text(size.deviation, 2));
  fmt::print("{}\n", detection_in_words(bias));
}

// The bias as effects of a scenario; their ranges are those of `scree effects`.
std::string effects_yaml(const scree::ImageBias& bias, const fs::path& scenario, const fs::path& folder) {
  std::vector<std::string> values;
  const double ratio = std::clamp(bias.limit.value_or(0) / bias.reference, 0.0, 2.0);
  if (bias.limit) values.push_back(fmt::format("effects.detection_limit.ratio={:.4g}", ratio));
  if (ratio > 0) values.push_back(fmt::format("effects.detection_limit.steepness={:.4g}", bias.steepness));
  values.push_back(fmt::format("effects.image_blur.width={:.4g}", std::clamp(bias.width, 0.0, 2.0)));
  values.push_back(
      fmt::format("effects.image_shape_bias.exponent={:.4g}", std::clamp(bias.exponent, -0.9, 2.0)));
  std::vector<std::string> comment{
      "Bias of image analysis, measured on virtual photographs (scree image --truth); see docs/image.md."};
  if (!bias.limit) comment.push_back(fmt::format("No detection_limit: {}.", detection_in_words(bias)));
  if (!scenario.empty()) return scree::scenario_patch(scenario, folder, values, comment);
  comment.emplace_back("To be added to a scenario, or give --scenario.");
  return fmt::format("# {}\n{}", fmt::join(comment, "\n# "), scree::nested_yaml(values));
}

// Chi and D50 of every section, the pictures being repeats.
WrittenDataset dataset_of(const ImageOptions& options, const scree::Scenario& scenario,
                          const std::vector<scree::AnalysedPhoto>& photos, const fs::path& out) {
  scree::DatasetDraft draft;
  draft.title = "Gradings from photographs";
  std::vector<std::string> names;
  for (const scree::AnalysedPhoto& photo : photos) names.push_back(photo.name);
  draft.source = fmt::format("scree image {}", fmt::join(names, " "));
  draft.relative_uncertainty = options.relative_uncertainty;
  scree::DatasetDraft::Experiment experiment;
  experiment.name = std::regex_replace(scenario.name, std::regex("[/,;\"]"), "_");
  experiment.scenario = options.scenario;
  const scree::MeasuredSections sections = scree::measured_sections(scenario, options.sections);
  experiment.overrides = sections.overrides;
  for (int k = 1; k <= options.sections; ++k) {
    std::vector<double> chi, d50;
    for (const scree::AnalysedPhoto& photo : photos) {
      chi.push_back(photo.gradings[k].chi);
      d50.push_back(photo.gradings[k].d50);
    }
    for (const auto& [name, values] : {std::pair("chi", chi), std::pair("d50_m", d50)})
      if (const scree::MeanStd mean = scree::mean_std(values); mean.n > 0)
        experiment.observables[fmt::format("{}_S{}{}", name, k, sections.of)] = mean;
  }
  draft.experiments.push_back(std::move(experiment));
  return {out, [draft = std::move(draft)](const fs::path& folder) {
            return note_of_left_out(scree::write_dataset(draft, folder));
          }};
}

// Sections of a run reach from the crest to the toe, and so must those of the pictures.
void note_whole_picture(const std::vector<scree::PhotoTruth>& truths) {
  std::string known;
  for (const scree::PhotoTruth& truth : truths)
    if (known.empty() && !truth.region.empty()) known = fmt::format(" \"{}\"", truth.region);
  fmt::print(
      "note: the whole picture is taken for the slope, the crest at its top edge and the toe at its foot; if "
      "there is more in it: --region{}\n",
      known);
}

// What can be said before any picture is looked at.
bool may_begin(const ImageOptions& options, std::optional<scree::Scenario>& scenario) {
  if (given_twice(options.photos)) return false;
  if (!options.truth.empty() && options.truth.size() != options.photos.size()) {
    fmt::print(stderr, "--truth: {} files for {} photographs; one each is needed, in their order\n",
               options.truth.size(), options.photos.size());
    return false;
  }
  if (!options.scenario.empty()) {
    if (!is_of_kind(options.scenario, scree::FileKind::scenario)) return false;
    scree::ScenarioResult loaded =
        scree::load_scenario(options.scenario, {}, asset_dir(), scree::ReadFor::numbers);
    if (!nothing_wrong(loaded.errors, loaded.warnings)) return false;
    if (options.photos.size() == 1 && !options.relative_uncertainty) {
      fmt::print(stderr,
                 "--scenario: one photograph says nothing of the scatter between repeats: give several, or "
                 "--relative-uncertainty 0.2 (of each value)\n");
      return false;
    }
    scenario = std::move(loaded.scenario);
  }
  return options.out.empty() || may_fill(options.out, options.force);
}

// What an older analysis has left, with --force, and this one may not write anew.
void forget_older(const fs::path& out, const std::vector<fs::path>& photos) {
  std::error_code ignored;
  if (!fs::exists(out / "grains.csv", ignored)) return;
  for (const char* file : {"bias.csv", "bias.svg", "effects.yaml"}) fs::remove(out / file, ignored);
  for (const auto& entry : fs::directory_iterator(out, ignored)) {
    const std::string name = entry.path().filename().string();
    const auto same = [&](const fs::path& photo) { return fs::equivalent(entry.path(), photo, ignored); };
    if (std::any_of(photos.begin(), photos.end(), same)) continue;
    if ((name.starts_with("overlay_") && name.ends_with(".jpg")) ||
        (name.starts_with("passing-") && name.ends_with(".svg")))
      fs::remove(entry.path(), ignored);
  }
}

}  // namespace

int run_image(const ImageOptions& options) {
  scree::ImageReport report;
  std::optional<scree::Scenario> scenario;
  if (!settings_of(options, report.settings) || !may_begin(options, scenario)) return kBadInput;
  const fs::path out = options.out.empty() ? free_run_folder("image") : options.out;
  std::vector<scree::PhotoTruth> truths;
  std::vector<cv::Mat3b> overlays;
  std::set<std::string> names;
  try {
    if (!options.weighed.empty())
      report.settings.shape_factor = shape_factor_from(options.weighed, report.settings);
    for (const fs::path& file : options.truth) truths.push_back(scree::read_truth(file));
    for (const fs::path& file : options.photos) {
      std::string name = file.stem().string();
      for (int k = 2; !names.insert(name).second; ++k) name = fmt::format("{}-{}", file.stem().string(), k);
      const cv::Mat3b picture = scree::read_photograph(file);
      scree::AnalysedPhoto photo{name, analyse(file, picture, report.settings), {}};
      photo.gradings = scree::gradings_of(photo.found.grains, options.sections, report.settings.model);
      for (std::string& note :
           scree::single_grain_notes(photo.found.grains, photo.gradings, report.settings.model))
        photo.found.notes.push_back(std::move(note));
      print_gradings(photo);
      overlays.push_back(scree::overlay(picture, photo.found, options.sections, kOverlaySide));
      if (!truths.empty()) {
        report.checks.push_back(
            scree::check_against_truth(photo.found, truths[report.photos.size()], report.settings));
        print_check(report.checks.back(), scree::bodies_in_words(report.settings));
      } else {
        photo.found.labels.of.release();  // large, and no longer needed
      }
      report.photos.push_back(std::move(photo));
    }
  } catch (const scree::FileError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return kBadInput;
  } catch (const std::invalid_argument& error) {
    fmt::print(stderr, "{}: {}\n", options.weighed.string(), error.what());
    return kBadInput;
  }
  const bool of_bench = scenario && bench_of(*scenario) != nullptr;
  const bool of_pile = std::any_of(truths.begin(), truths.end(),
                                   [](const scree::PhotoTruth& truth) { return !truth.region.empty(); });
  if (options.region.empty() && (of_bench || of_pile)) note_whole_picture(truths);
  std::optional<WrittenDataset> dataset;
  if (scenario) {
    dataset = dataset_of(options, *scenario, report.photos, out);
    if (const int code = dataset->check(); code != kOk) return code;
  }
  if (!prepare_folder(out, options.force)) return kBadInput;
  forget_older(out, options.photos);
  for (std::size_t i = 0; i < overlays.size(); ++i) {
    report.overlays.push_back(out / ("overlay_" + report.photos[i].name + ".jpg"));
    scree::write_picture(report.overlays.back(), overlays[i]);
  }
  scree::write_text_file(out / "grains.csv", scree::grains_csv(report.photos, report.settings.model,
                                                               report.settings.shape_factor));
  scree::write_text_file(out / "gradings.csv", scree::gradings_csv(report.photos));
  scree::write_text_file(out / "models.csv", scree::models_csv(report.photos, options.sections));
  scree::write_text_file(out / "passing.csv", scree::passing_csv(report.photos));
  if (!truths.empty()) {
    std::vector<scree::CheckedPhoto> checked;
    for (std::size_t i = 0; i < truths.size(); ++i) checked.push_back({&report.photos[i].found, &truths[i]});
    report.bias = scree::measure_bias(checked, report.settings.model);
    print_bias(*report.bias);
    scree::write_text_file(out / "bias.csv", scree::bias_csv(*report.bias));
    if (!report.bias->says_something()) {
      fmt::print("note: no effects.yaml: {} known grains are detected, too few to say anything of size\n",
                 report.bias->matched);
    } else {
      scree::write_text_file(out / "effects.yaml", effects_yaml(*report.bias, options.scenario, out));
    }
  }
  report.version = fmt::format("scree {} ({})", SCREE_VERSION, SCREE_REVISION);
  const int code = tell_report(out, scree::write_image_report(report, out));
  if (dataset) dataset->put_in_place();
  return code;
}
