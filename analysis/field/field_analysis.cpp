#include "analysis/field/field_analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace scree {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct OfGrading {
  FieldQuantity quantity;
  double (*of)(const Grading&);
};

const std::vector<OfGrading>& numbers_of_grading() {
  static const std::vector<OfGrading> all{
      {{"d10", "D10", "m"}, [](const Grading& g) { return g.diameter(0.10); }},
      {{"d15", "D15", "m"}, [](const Grading& g) { return g.diameter(0.15); }},
      {{"d30", "D30", "m"}, [](const Grading& g) { return g.diameter(0.30); }},
      {{"d50", "D50", "m"}, [](const Grading& g) { return g.diameter(0.50); }},
      {{"d60", "D60", "m"}, [](const Grading& g) { return g.diameter(0.60); }},
      {{"d80", "D80", "m"}, [](const Grading& g) { return g.diameter(0.80); }},
      {{"d90", "D90", "m"}, [](const Grading& g) { return g.diameter(0.90); }},
      {{"d95", "D95", "m"}, [](const Grading& g) { return g.diameter(0.95); }},
      {{"cu", "coefficient of uniformity", "-"}, [](const Grading& g) { return g.cu(); }},
      {{"cc", "coefficient of curvature", "-"}, [](const Grading& g) { return g.cc(); }},
      {{"d90_over_d15", "D90 / D15", "-"},
       [](const Grading& g) { return g.diameter(0.90) / g.diameter(0.15); }},
  };
  return all;
}

struct AgainstOriginal {
  FieldQuantity quantity;
  double (*of)(const Grading& grading, const Grading& original);
};

template <int percent>
double relative(const Grading& grading, const Grading& original) {
  return grading.diameter(percent / 100.0) / original.diameter(percent / 100.0);
}

double kozeny_carman(const Grading& grading, const Grading& original) {
  return conductivity_ratio_kozeny_carman(pore_material(grading), pore_material(original));
}

double taylor(const Grading& grading, const Grading& original) {
  return conductivity_ratio_taylor(pore_material(grading), pore_material(original));
}

const std::vector<AgainstOriginal>& numbers_against_original() {
  static const std::vector<AgainstOriginal> all{
      {{"d10_rel", "D10 over that of the rock as dumped", "-"}, relative<10>},
      {{"d50_rel", "D50 over that of the rock as dumped", "-"}, relative<50>},
      {{"d80_rel", "D80 over that of the rock as dumped", "-"}, relative<80>},
      {{"d90_rel", "D90 over that of the rock as dumped", "-"}, relative<90>},
      {{"d95_rel", "D95 over that of the rock as dumped", "-"}, relative<95>},
      {{"chi", "segregation degree χ", "-"}, segregation_degree},
      {{"ksat_kcm_rel", "conductivity over that of the rock as dumped, Kozeny-Carman", "-"}, kozeny_carman},
      {{"ksat_taylor_rel", "conductivity over that of the rock as dumped, Taylor", "-"}, taylor},
  };
  return all;
}

// Of gradings with the fines of the sieved sample.
const std::vector<AgainstOriginal>& numbers_with_fines() {
  static const std::vector<AgainstOriginal> all{
      {{"ksat_kcm_rel_filled", "the same with fines, Kozeny-Carman", "-"}, kozeny_carman},
      {{"ksat_taylor_rel_filled", "the same with fines, Taylor", "-"}, taylor},
  };
  return all;
}

constexpr FieldQuantity kGivenChi{"chi_given", "segregation degree χ as given", "-"};

Grading with_fines(const Grading& grading, const FieldOptions& options) {
  return options.sieved ? with_sieved_fines(grading, *options.sieved, options.limit) : grading;
}

void add_curves(FieldSection& section, const std::vector<Grading>& curves, const FieldOptions& options) {
  if (curves.empty()) return;
  section.envelope = envelope(curves);
  section.curves.emplace(CurveKind::medians, median_curve(section.envelope, section.name + ", medians"));
  section.curves.emplace(CurveKind::means, mean_curve(section.envelope, section.name + ", means"));
  section.curves.emplace(CurveKind::mean_diameters,
                         mean_diameter_curve(curves, section.name + ", mean diameters"));
  if (options.sieved)
    for (const auto& [kind, curve] : section.curves) section.filled.emplace(kind, with_fines(curve, options));
}

/// The original of a picture: the grading given, or its whole slope.
const Grading* original_of(const SlopeGradings::Picture& picture, const FieldOptions& options) {
  if (options.original) return &*options.original;
  return picture.curves.front() ? &*picture.curves.front() : nullptr;
}

FieldSection section_of(const SlopeGradings& gradings, std::size_t k, const FieldOptions& options) {
  FieldSection section;
  section.name = k == 0 ? "whole" : fmt::format("S{}", k);
  section.x_over_l = k == 0 ? kNone : (2.0 * static_cast<double>(k) - 1) / (2.0 * gradings.sections);
  std::vector<Grading> curves;
  for (const SlopeGradings::Picture& picture : gradings.pictures) {
    const std::optional<Grading>& curve = picture.curves[k];
    if (curve) curves.push_back(*curve);
    for (const OfGrading& each : numbers_of_grading())
      section.values[each.quantity.name].push_back(curve ? each.of(*curve) : kNone);
    if (k == 0) continue;
    const Grading* original = original_of(picture, options);
    const bool known = curve && original != nullptr;
    for (const AgainstOriginal& each : numbers_against_original())
      section.values[each.quantity.name].push_back(known ? each.of(*curve, *original) : kNone);
    for (const AgainstOriginal& each : numbers_with_fines())
      section.values[each.quantity.name].push_back(
          known && options.sieved ? each.of(with_fines(*curve, options), with_fines(*original, options))
                                  : kNone);
    section.values[kGivenChi.name].push_back(picture.given_chi[k]);
  }
  add_curves(section, curves, options);
  return section;
}

void check(const SlopeGradings& gradings, const FieldOptions& options) {
  if (!(options.void_ratio > 0)) throw std::invalid_argument("the void ratio must be above 0");
  if (!options.original &&
      std::none_of(gradings.pictures.begin(), gradings.pictures.end(),
                   [](const SlopeGradings::Picture& picture) { return picture.curves.front().has_value(); }))
    throw std::invalid_argument(
        "no picture has its whole slope (section 0): chi and ratios need the rock as dumped; give it as "
        "--original GRADING.csv");
}

}  // namespace

const std::vector<FieldQuantity>& field_quantities() {
  static const std::vector<FieldQuantity> all = [] {
    std::vector<FieldQuantity> list;
    for (const OfGrading& each : numbers_of_grading()) list.push_back(each.quantity);
    for (const AgainstOriginal& each : numbers_against_original()) list.push_back(each.quantity);
    for (const AgainstOriginal& each : numbers_with_fines()) list.push_back(each.quantity);
    list.push_back(kGivenChi);
    return list;
  }();
  return all;
}

const FieldQuantity* field_quantity(const std::string& name) {
  const auto& all = field_quantities();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const FieldQuantity& q) { return q.name == name; });
  return found == all.end() ? nullptr : &*found;
}

PoreMaterial pore_material(const Grading& grading, double void_ratio) {
  return {grading.diameter(0.10), grading.diameter(0.50), grading.cu(), void_ratio};
}

double segregation_degree(const Grading& grading, const Grading& original) {
  const double d0 = original.mean_log_diameter();
  const Grading coarsest = original.scalped(original.diameter(0.75), original.max_diameter());
  return (grading.mean_log_diameter() - d0) / (coarsest.mean_log_diameter() - d0);
}

const Grading* FieldSection::curve(CurveKind kind, bool with_fines) const {
  const auto& all = with_fines ? filled : curves;
  const auto found = all.find(kind);
  return found == all.end() ? nullptr : &found->second;
}

const char* curve_in_words(CurveKind kind) {
  switch (kind) {
    case CurveKind::medians:
      return "medians";
    case CurveKind::means:
      return "means";
    case CurveKind::mean_diameters:
      break;
  }
  return "mean diameters";
}

const FieldSection* FieldAnalysis::section(const std::string& name) const {
  if (name == whole.name) return &whole;
  const auto found =
      std::find_if(sections.begin(), sections.end(), [&](const FieldSection& s) { return s.name == name; });
  return found == sections.end() ? nullptr : &*found;
}

std::optional<Grading> FieldAnalysis::as_dumped(CurveKind kind, bool fines) const {
  if (fines && !options.sieved) return std::nullopt;
  if (options.original) return fines ? with_fines(*options.original, options) : *options.original;
  const Grading* slope = whole.curve(kind, fines);
  return slope == nullptr ? std::nullopt : std::optional(*slope);
}

FieldAnalysis analyse_field(const SlopeGradings& gradings, const FieldOptions& options) {
  check(gradings, options);
  FieldAnalysis out;
  out.options = options;
  for (const SlopeGradings::Picture& picture : gradings.pictures) out.pictures.push_back(picture.name);
  out.whole = section_of(gradings, 0, options);
  if (out.whole.curves.empty() && options.original) add_curves(out.whole, {*options.original}, options);
  for (const SlopeGradings::Picture& picture : gradings.pictures) {
    const Grading* original = original_of(picture, options);
    out.d90_over_d15.push_back(original ? original->diameter(0.90) / original->diameter(0.15) : kNone);
  }
  for (std::size_t k = 1; k <= static_cast<std::size_t>(gradings.sections); ++k) {
    FieldSection section = section_of(gradings, k, options);
    section.chi_fit = fit_through_origin(out.d90_over_d15, section.values.at("chi"));
    section.chi_given_fit = fit_through_origin(out.d90_over_d15, section.values.at("chi_given"));
    out.sections.push_back(std::move(section));
  }
  // One width for all sections and all diameters, so that their charts compare.
  const FieldSection& reference = out.whole.envelope.size() > 1 && out.whole.spread("d50").moments.n > 1
                                      ? out.whole
                                      : out.sections.front();
  out.bin = bin_width(reference.values.at("d50"));
  out.ratio_bin = bin_width(reference.values.at("cu"));
  return out;
}

std::vector<double> ratio_over_pictures(const FieldSection& toe, const FieldSection& crest,
                                        const std::string& quantity) {
  const std::vector<double>&a = toe.values.at(quantity), &b = crest.values.at(quantity);
  std::vector<double> out;
  for (std::size_t i = 0; i < a.size(); ++i) out.push_back(a[i] / b[i]);
  return out;
}

}  // namespace scree
