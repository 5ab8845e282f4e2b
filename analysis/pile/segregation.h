#pragma once
// Sections of a slope, their gradings, and the indices of segregation.
#include <string>
#include <vector>

#include "analysis/pile/passing_curve.h"
#include "sim/effects/measurement.h"
#include "sim/io/snapshot.h"

namespace scree {

/// One section of a slope.
struct Section {
  std::string name;     ///< S1 at the crest
  double x_over_l = 0;  ///< centre, (2k - 1) / (2n)
  double mass = 0;      ///< kg
  int grains = 0;
  double chi = 0;                                      ///< segregation degree; NaN when the section is empty
  double d10 = 0, d50 = 0, d80 = 0, d90 = 0, d95 = 0;  ///< m; NaN when empty
  double d10_rel = 0, d50_rel = 0, d80_rel = 0, d90_rel = 0, d95_rel = 0;  ///< over the reference's
  double d15 = 0, d60 = 0;                                                 ///< m
  double ksat_rel =
      0;  ///< conductivity over the reference's at equal void ratio (Kozeny-Carman); NaN when empty
  double share_above_1m = 0;    ///< of the mass of grains above 1 m in all sections; NaN without such grains
  std::vector<double> passing;  ///< shares at the sieves of SectionTable::sieves
};

/// All sections of one slope at one time.
struct SectionTable {
  std::vector<Section> sections;
  std::vector<double> sieves;  ///< m
  std::vector<double> original_passing;
  double d0_log = 0, dcq_log = 0;  ///< mean log10 d of the reference and of its coarsest quartile
  double original_above_1m = 0;    ///< share of the original mass above 1 m
  double mass_outside = 0;         ///< kg above the crest or outside the slope
  int dumps = 0;                   ///< dumps in the pile; 0: not known
};

/// Grains that make up a section.
struct NamedGrains {
  std::string name;
  double x_over_l = 0;
  std::vector<const Grain*> grains;
  std::vector<double> seen = {};  ///< of each grain (count_grains()); empty: measured through and through
};

/// Gradings and segregation of parts of a pile against `original` (every grain as dumped). chi = (log
/// d_section - log d_0) / (log d_CQ - log d_0), thesis chapter 3. `measured`: how diameters are measured, of
/// the parts and of the original alike. The reference of chi and of ratios is the original, or with
/// Measurement::own_reference `pile`, counted as one (null: all parts together); where nothing of that is
/// seen, the original. Throws std::invalid_argument when `original` is empty.
SectionTable tabulate(const std::vector<NamedGrains>& parts, const std::vector<Grain>& original,
                      const Measurement& measured = {}, const NamedGrains* pile = nullptr);

/// Slice of equal height that a grain lies in, 0 at the crest to n - 1 at the floor; -1 above the crest. A
/// small grain between the balls of the floor can lie below it: it belongs to the lowest slice.
/// `border_shift`: as in Measurement.
int slice_of(const Grain& grain, double crest_height, int n, double border_shift = 0);

/// Cuts the slope into `n` slices by height (n and crest_height above 0), each with what is seen of its
/// grains where that is measured. Grains above the crest are in none. Seen along the normal of the fitted
/// profile (slope_line()), or of a slope of 37 degrees where that is too short to tell or does not fall
/// towards +x.
std::vector<NamedGrains> slices_of(const std::vector<Grain>& pile, double crest_height, int n,
                                   const Measurement& measured);

/// All grains of parts.
NamedGrains all_grains_of(const std::vector<NamedGrains>& parts);

/// Cuts the slope into `n` slices of equal height between `crest_height` (S1) and 0 (Sn) and analyses each
/// against `original` (every grain as dumped). Grains above the crest height are outside (counted as
/// mass_outside).
SectionTable analyse_sections(const std::vector<Grain>& pile, const std::vector<Grain>& original,
                              double crest_height, int n, const Measurement& measured = {});

}  // namespace scree
