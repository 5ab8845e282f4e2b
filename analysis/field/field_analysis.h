#pragma once
// A slope in many pictures: how its sections differ from the whole, and from picture to picture.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analysis/field/envelope.h"
#include "analysis/field/origin_fit.h"
#include "analysis/field/slope_gradings.h"
#include "analysis/field/spread.h"
#include "analysis/pile/permeability.h"

namespace scree {

/// A number of one grading.
struct FieldQuantity {
  const char *name, *words;
  const char* unit;  ///< m, -, m/s
};

/// d10, d15, d30, d50, d60, d80, d90, d95 (m), cu, cc, d90_over_d15; and against the original material, which
/// is the picture's own whole slope or a grading given: d10_rel, d50_rel, d80_rel, d90_rel, d95_rel, chi, and
/// conductivities at equal void ratio ksat_kcm_rel, ksat_taylor_rel (analysis/pile/permeability.h), and the
/// same of both gradings with the fines of the sieved sample, ksat_kcm_rel_filled, ksat_taylor_rel_filled;
/// chi_given as it stands in the table.
const std::vector<FieldQuantity>& field_quantities();
/// The one of this name; null if there is none.
const FieldQuantity* field_quantity(const std::string& name);

/// Degree of segregation of a grading against the original, (log d - log d_0) / (log d_CQ - log d_0), as in
/// analysis/pile/segregation.h.
double segregation_degree(const Grading& grading, const Grading& original);

/// What formulae of conductivity need of a grading, at a void ratio.
PoreMaterial pore_material(const Grading& grading, double void_ratio = 1);

/// How the analysis is done.
struct FieldOptions {
  std::optional<Grading> original;  ///< of the rock as dumped; without it each picture's whole slope
  std::optional<Grading> sieved;    ///< sample that the fines are taken from, with
  double limit = 0;                 ///< m, below which pictures do not see
  double void_ratio = 0.3;          ///< of all conductivities; drops out of ratios
};

/// Curves that can stand for a section in all pictures.
enum class CurveKind {
  medians,         ///< of the shares passing at a diameter
  means,           ///< of the same
  mean_diameters,  ///< means of the diameters at a share
};
inline constexpr CurveKind kCurveKinds[] = {CurveKind::medians, CurveKind::means, CurveKind::mean_diameters};
/// "medians", "means", "mean diameters".
const char* curve_in_words(CurveKind kind);

/// One section, or the whole slope, over all pictures.
struct FieldSection {
  std::string name;                                   ///< whole, S1 ...
  double x_over_l = 0;                                ///< middle, 0 at the crest; NaN of the whole slope
  std::map<std::string, std::vector<double>> values;  ///< by quantity: one a picture, NaN where it has none
  std::vector<EnvelopePoint> envelope;                ///< of the curves, as measured
  std::map<CurveKind, Grading> curves;                ///< as seen
  std::map<CurveKind, Grading> filled;                ///< with fines of the sieved sample
  OriginFit chi_fit, chi_given_fit;  ///< of chi against D90 / D15 of the original, through the origin

  Spread spread(const std::string& quantity) const { return spread_over(values.at(quantity)); }
  /// A picture at least has this quantity here.
  bool has(const std::string& quantity) const {
    const auto found = values.find(quantity);
    return found != values.end() && mean_std(found->second).n > 0;
  }
  /// The curve that stands for the section, with fines or as seen; null if there is none.
  const Grading* curve(CurveKind kind, bool with_fines) const;
};

struct FieldAnalysis {
  std::vector<std::string> pictures;
  std::vector<double> d90_over_d15;    ///< of the original material of each picture
  FieldSection whole;                  ///< without pictures' whole slopes: the original grading alone
  std::vector<FieldSection> sections;  ///< from the crest
  FieldOptions options;
  double bin = 1, ratio_bin = 1;  ///< width of bins for diameters (m), for cu
  double bin_of(const std::string& quantity) const { return quantity == "cu" ? ratio_bin : bin; }
  const FieldSection* section(const std::string& name) const;  ///< null if there is none
  /// What a curve of a section is held against: the original grading, or the same curve of the whole slopes.
  std::optional<Grading> as_dumped(CurveKind kind, bool with_fines) const;
};

/// Throws std::invalid_argument when pictures have neither a whole slope nor an original grading is given, or
/// a limit and a sieved sample do not fit.
FieldAnalysis analyse_field(const SlopeGradings& gradings, const FieldOptions& options);

/// A quantity of `toe` over that of `crest`, picture by picture.
std::vector<double> ratio_over_pictures(const FieldSection& toe, const FieldSection& crest,
                                        const std::string& quantity);

}  // namespace scree
