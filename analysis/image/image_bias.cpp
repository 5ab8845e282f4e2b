#include "analysis/image/image_bias.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "analysis/report/report_text.h"
#include "analysis/results/results.h"

namespace scree {
namespace {

struct KnownGrain {
  double diameter = 0;
  double ratio = 0;  // measured over true; 0: not detected
};

// Whether all that is seen of a grain lies in the region, as far as the picture shows it.
bool lies_within(const CheckedPhoto& photo, const VisibleGrain& grain) {
  constexpr int kDirections = 16;
  const cv::Size picture = photo.found->region.mask().size();
  const double reach = 0.5 * std::max(grain.visible_a, grain.visible_b) / photo.truth->m_per_px;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2 * std::numbers::pi * k / kDirections;
    const double x = std::clamp(grain.x + reach * std::cos(angle), 0.0, picture.width - 1.0),
                 y = std::clamp(grain.y + reach * std::sin(angle), 0.0, picture.height - 1.0);
    if (!photo.found->region.has(x, y)) return false;
  }
  return photo.found->region.has(grain.x, grain.y);
}

void match(const CheckedPhoto& photo, SizeModel model, std::vector<KnownGrain>& known, ImageBias& bias) {
  std::map<int, const ImageGrain*> outline;
  for (const ImageGrain& grain : photo.found->grains) outline[grain.label] = &grain;
  std::map<int, const VisibleGrain*> owner;
  const cv::Mat1i& labels = photo.found->labels.of;
  const auto label_at = [&](const VisibleGrain& grain) {
    const int x = static_cast<int>(std::lround(grain.x)), y = static_cast<int>(std::lround(grain.y));
    return x >= 0 && y >= 0 && x < labels.cols && y < labels.rows ? labels(y, x) : 0;
  };
  const std::set<int> cut(photo.found->cut.begin(), photo.found->cut.end());
  for (const VisibleGrain& grain : photo.truth->grains) {
    const int label = label_at(grain);
    if (!outline.contains(label)) continue;
    const VisibleGrain*& best = owner[label];
    if (best == nullptr || grain.visible_area > best->visible_area) best = &grain;
  }
  for (const VisibleGrain& grain : photo.truth->grains) {
    const int label = label_at(grain);
    if (!lies_within(photo, grain) || cut.contains(label)) continue;
    const auto found = owner.find(label);
    const bool detected = found != owner.end() && found->second == &grain;
    known.push_back(
        {grain.diameter,
         detected ? outline[label]->size[static_cast<std::size_t>(model)].diameter / grain.diameter : 0});
  }
  bias.outlines += static_cast<int>(outline.size());
  bias.matched += static_cast<int>(owner.size());
}

// Logistic regression of detection on ln d by Newton's method; a prior of deviation 25 on the steepness keeps
// a perfectly sharp step finite.
void fit_detection(const std::vector<KnownGrain>& known, ImageBias& bias) {
  const auto seen =
      std::count_if(known.begin(), known.end(), [](const KnownGrain& g) { return g.ratio > 0; });
  if (seen == 0) return;
  if (seen == static_cast<std::ptrdiff_t>(known.size())) {
    bias.limit = 0;
    return;
  }
  const double centre = std::log(bias.reference);
  double a = 0, b = 4;  // logit of the share = a + b (ln d - centre)
  for (int round = 0; round < 200; ++round) {
    double ga = 0, gb = -b / 625, haa = 1e-9, hab = 0, hbb = 1.0 / 625;
    for (const KnownGrain& grain : known) {
      const double x = std::log(grain.diameter) - centre;
      const double p = 1 / (1 + std::exp(-(a + b * x)));
      const double rest = (grain.ratio > 0 ? 1 : 0) - p, w = p * (1 - p);
      ga += rest;
      gb += rest * x;
      haa += w;
      hab += w * x;
      hbb += w * x * x;
    }
    const double det = haa * hbb - hab * hab;
    double da = (hbb * ga - hab * gb) / det, db = (haa * gb - hab * ga) / det;
    // A step that is too long leaves the region where the likelihood is nearly quadratic.
    const double longest = std::max(std::abs(da), std::abs(db));
    if (longest > 2) {
      da *= 2 / longest;
      db *= 2 / longest;
    }
    a += da;
    b += db;
    if (longest < 1e-10) break;
  }
  bias.steepness = std::clamp(b, 1.0, 50.0);
  const auto [smallest, largest] =
      std::minmax_element(known.begin(), known.end(),
                          [](const KnownGrain& p, const KnownGrain& q) { return p.diameter < q.diameter; });
  const double limit = bias.reference * std::exp(-a / b);
  if (b > 0 && limit >= smallest->diameter && limit <= largest->diameter) bias.limit = limit;
}

void fit_size(const std::vector<KnownGrain>& known, ImageBias& bias) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const KnownGrain& grain : known)
    if (grain.ratio > 0) {
      const double x = std::log(grain.diameter / bias.reference), y = std::log(grain.ratio);
      ++n;
      sx += x;
      sy += y;
      sxx += x * x;
      sxy += x * y;
    }
  if (n < 3 || !(sxx - sx * sx / n > 0)) return;
  bias.exponent = (sxy - sx * sy / n) / (sxx - sx * sx / n);
  const double at_reference = (sy - bias.exponent * sx) / n;
  double rest = 0;
  for (const KnownGrain& grain : known)
    if (grain.ratio > 0)
      rest += std::pow(
          std::log(grain.ratio) - at_reference - bias.exponent * std::log(grain.diameter / bias.reference),
          2);
  bias.width = std::sqrt(rest / (n - 2));
}

void sort_into_classes(const std::vector<KnownGrain>& known, ImageBias& bias) {
  std::map<int, std::vector<double>> ratios;
  std::map<int, int> visible;
  for (const KnownGrain& grain : known) {
    const int k = static_cast<int>(std::floor(2 * std::log2(grain.diameter)));
    ++visible[k];
    if (grain.ratio > 0) ratios[k].push_back(std::log(grain.ratio));
  }
  for (const auto& [k, n] : visible) {
    const MeanStd log_ratio = mean_std(ratios[k]);
    bias.classes.push_back(
        {std::exp2(k / 2.0), std::exp2((k + 1) / 2.0), n, log_ratio.n,
         log_ratio.n > 0 ? std::exp(log_ratio.mean) : std::numeric_limits<double>::quiet_NaN(),
         log_ratio.std});
  }
}

}  // namespace

ImageBias measure_bias(const std::vector<CheckedPhoto>& photos, SizeModel model) {
  ImageBias bias;
  std::vector<KnownGrain> known;
  for (const CheckedPhoto& photo : photos) {
    match(photo, model, known, bias);
    bias.reference += photo.truth->scene_d50 / static_cast<double>(photos.size());
  }
  sort_into_classes(known, bias);
  fit_detection(known, bias);
  fit_size(known, bias);
  return bias;
}

std::string detection_in_words(const ImageBias& bias) {
  if (bias.matched == 0) return "no known grain is detected";
  if (!bias.limit)
    return "the share detected does not rise through one half among the known diameters: no limit is told";
  if (*bias.limit == 0) return "every known grain is detected";
  return fmt::format("half of the known grains are detected at {} m ({} of D50, steepness {})",
                     number_text(*bias.limit), number_text(*bias.limit / bias.reference),
                     number_text(bias.steepness));
}

namespace {

// Known grains of a region that are to be seen, and the section of each.
struct KnownGrains {
  std::vector<const VisibleGrain*> grains;
  std::vector<int> section;
};
KnownGrains known_grains(const PhotoTruth& truth, const PhotoRegion& region,
                         const PhotoAnalysisSettings& settings) {
  KnownGrains known;
  for (const VisibleGrain& grain : truth.grains) {
    if (grain.visible_area < settings.detection_area || !region.has(grain.x, grain.y)) continue;
    known.grains.push_back(&grain);
    known.section.push_back(section_of(grain.y, region, settings.sections));
  }
  return known;
}

}  // namespace

std::vector<ImageGrading> true_gradings(const PhotoTruth& truth, const PhotoRegion& region,
                                        const PhotoAnalysisSettings& settings) {
  const KnownGrains known = known_grains(truth, region, settings);
  std::vector<double> diameters, masses;
  for (const VisibleGrain* grain : known.grains) {
    diameters.push_back(grain->diameter);
    masses.push_back(grain->mass);
  }
  return gradings_of(diameters, masses, known.section, settings.sections);
}

std::string bodies_in_words(const PhotoAnalysisSettings& settings) {
  return settings.model == SizeModel::sphere
             ? ""
             : fmt::format(" (as bodies of c/b = {:g}; virtual rock is spheres)", settings.shape_factor);
}

TruthCheck check_against_truth(const PhotoAnalysis& found, const PhotoTruth& truth,
                               const PhotoAnalysisSettings& settings) {
  const KnownGrains known = known_grains(truth, found.region, settings);
  std::vector<double> diameters, masses;
  for (const VisibleGrain* grain : known.grains) {
    // As size_of, without the factors that are the same for all.
    const bool sphere = settings.model == SizeModel::sphere;
    const double b = sphere ? std::sqrt(grain->visible_area) : grain->visible_b;
    diameters.push_back(sphere ? b * std::sqrt(4 / std::numbers::pi) : b);
    masses.push_back((sphere ? b : grain->visible_a) * b * b);
  }
  return {true_gradings(truth, found.region, settings),
          gradings_of(found.grains, settings.sections, settings.model),
          gradings_of(diameters, masses, known.section, settings.sections), truth.scene_d50};
}

}  // namespace scree
