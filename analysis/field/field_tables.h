#pragma once
// A field analysis as CSV tables.
#include <filesystem>
#include <vector>

#include "analysis/field/field_analysis.h"
#include "analysis/field/printed_values.h"

namespace scree {

/// A curve that stands for a section, its conductivity, and that over that of the rock as dumped.
struct ConductivityRow {
  std::string section;
  CurveKind kind = CurveKind::medians;
  bool filled = false;                   ///< with fines of the sieved sample
  double d10 = 0, d50 = 0, cu = 0;       ///< m, m, -
  double kozeny_carman = 0, taylor = 0;  ///< m/s
  double kozeny_carman_rel = 0;
  double taylor_rel = 0;         ///< with the thesis's power of D50
  double taylor_rel_square = 0;  ///< with the square of the source
};
std::vector<ConductivityRow> conductivity_rows(const FieldAnalysis& field);

/// The quantities whose histograms are shown and written: those with a mode worth looking for.
inline constexpr const char* kHistogramQuantities[] = {"d10", "d50", "d80", "cu"};

/// Writes into a folder that is there: sections.csv (statistics over pictures), pictures.csv (every number of
/// every picture), envelopes.csv, histograms.csv, chi_fit.csv, ksat.csv; chi_given.csv if degrees of
/// segregation were given, printed.csv if there are any, and gradings for scenarios: median_whole.csv and,
/// with a sieved sample, corrected_whole.csv. Throws std::runtime_error if a file cannot be written.
void write_field_tables(const FieldAnalysis& field, const std::vector<HeldValue>& printed,
                        const std::filesystem::path& folder);

/// "as printed", "within the rounding of the table", "differs", "not in the table".
const char* verdict_in_words(PrintedVerdict verdict);

}  // namespace scree
