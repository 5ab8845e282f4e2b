#include "analysis/field/field_tables.h"

#include <fmt/format.h>

#include <cmath>

#include "analysis/report/report_text.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

/// The whole slope, then the sections.
std::vector<const FieldSection*> parts_of(const FieldAnalysis& field) {
  std::vector<const FieldSection*> all{&field.whole};
  for (const FieldSection& section : field.sections) all.push_back(&section);
  return all;
}

std::string statistics(const FieldAnalysis& field) {
  std::string text =
      "section,quantity,unit,n,mean,std,median,low68,high68,low95,high95,min,max,p_normal,p_lognormal\n";
  for (const FieldSection* section : parts_of(field))
    for (const FieldQuantity& quantity : field_quantities()) {
      if (!section->has(quantity.name)) continue;
      const Spread s = section->spread(quantity.name);
      text += fmt::format(
          "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", section->name, quantity.name, quantity.unit,
          s.moments.n, number(s.moments.mean), number(s.moments.std), number(s.median), number(s.low68),
          number(s.high68), number(s.low95), number(s.high95), number(s.min), number(s.max),
          s.normal.known ? number(s.normal.p) : "", s.lognormal.known ? number(s.lognormal.p) : "");
    }
  return text;
}

std::string pictures(const FieldAnalysis& field) {
  std::string text = "image,section";
  for (const FieldQuantity& quantity : field_quantities())
    text += fmt::format(",{}{}", quantity.name, quantity.unit[0] == 'm' ? "_m" : "");
  text += '\n';
  for (std::size_t i = 0; i < field.pictures.size(); ++i)
    for (const FieldSection* section : parts_of(field)) {
      std::string row;
      bool any = false;
      for (const FieldQuantity& quantity : field_quantities()) {
        const auto found = section->values.find(quantity.name);
        const double value = found == section->values.end() ? NAN : found->second[i];
        any = any || std::isfinite(value);
        row += ',' + number(value);
      }
      if (any) text += fmt::format("{},{}{}\n", csv_field(field.pictures[i]), section->name, row);
    }
  return text;
}

std::string envelopes(const FieldAnalysis& field) {
  std::string text = "section,diameter_m,mean,std,median,low68,high68,low95,high95\n";
  for (const FieldSection* section : parts_of(field))
    for (const EnvelopePoint& p : section->envelope)
      text += fmt::format("{},{},{},{},{},{},{},{},{}\n", section->name, number(p.diameter), number(p.mean),
                          number(p.std), number(p.median), number(p.low68), number(p.high68), number(p.low95),
                          number(p.high95));
  return text;
}

std::string histograms(const FieldAnalysis& field) {
  std::string text = "quantity,section,from,to,share\n";
  for (const char* quantity : kHistogramQuantities)
    for (const FieldSection* section : parts_of(field)) {
      if (!section->has(quantity)) continue;
      const Histogram bins = histogram(section->values.at(quantity), field.bin_of(quantity));
      for (std::size_t k = 0; k < bins.shares.size(); ++k)
        text +=
            fmt::format("{},{},{},{},{}\n", quantity, section->name, number(bins.middle(k) - bins.width / 2),
                        number(bins.middle(k) + bins.width / 2), number(bins.shares[k]));
    }
  return text;
}

std::string chi_fits(const FieldAnalysis& field) {
  std::string text = "section,chi,n,slope,slope_error,r2,r2_about_mean\n";
  for (const FieldSection& section : field.sections)
    for (const bool given : {false, true}) {
      const OriginFit& fit = given ? section.chi_given_fit : section.chi_fit;
      if (fit.n > 1)
        text += fmt::format("{},{},{},{},{},{},{}\n", section.name, given ? "given" : "of gradings", fit.n,
                            number(fit.slope), number(fit.error), number(fit.r2), number(fit.r2_of_mean));
    }
  return text;
}

std::string conductivities(const FieldAnalysis& field) {
  std::string text =
      "section,curve,fines,d10_m,d50_m,cu,void_ratio,ksat_kcm_cm_per_s,ksat_kcm_m_per_s,ksat_taylor_m_per_s,"
      "ksat_kcm_rel,ksat_taylor_rel,ksat_taylor_rel_square\n";
  for (const ConductivityRow& r : conductivity_rows(field))
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", r.section, curve_in_words(r.kind),
                        r.filled ? "sieved" : "as seen", number(r.d10), number(r.d50), number(r.cu),
                        number(field.options.void_ratio), number(100 * r.kozeny_carman),
                        number(r.kozeny_carman), number(r.taylor), number(r.kozeny_carman_rel),
                        number(r.taylor_rel), number(r.taylor_rel_square));
  return text;
}

std::string given_chi(const FieldAnalysis& field) {
  std::string text = "image,section,given,of_gradings,difference\n";
  for (std::size_t i = 0; i < field.pictures.size(); ++i)
    for (const FieldSection& section : field.sections) {
      const double given = section.values.at("chi_given")[i], ours = section.values.at("chi")[i];
      if (std::isfinite(given) || std::isfinite(ours))
        text += fmt::format("{},{},{},{},{}\n", csv_field(field.pictures[i]), section.name, number(given),
                            number(ours), number(ours - given));
    }
  return text;
}

std::string printed_table(const std::vector<HeldValue>& printed) {
  std::string text = "name,what,printed,rounding,ours,low,high,unit,verdict,source\n";
  for (const HeldValue& held : printed)
    text += fmt::format(
        "{},{},{},{},{},{},{},{},{},{}\n", csv_field(held.printed.name), csv_field(held.printed.what),
        number(held.printed.value), number(held.printed.rounding), held.ours ? number(*held.ours) : "",
        held.ours ? number(held.low) : "", held.ours ? number(held.high) : "", csv_field(held.printed.unit),
        verdict_in_words(held.verdict), csv_field(held.printed.source));
  return text;
}

std::string grading_file(const Grading& grading, const std::string& what) {
  std::string text = fmt::format("# {}\ndiameter_mm,passing_pct\n", what);
  for (const Grading::Point& point : grading.points())
    text += fmt::format("{:.9g},{:.9g}\n", 1000 * point.diameter, 100 * point.passing);
  return text;
}

}  // namespace

std::vector<ConductivityRow> conductivity_rows(const FieldAnalysis& field) {
  std::vector<ConductivityRow> rows;
  const double e = field.options.void_ratio;
  for (const bool filled : {false, true})
    for (const CurveKind kind : kCurveKinds) {
      const auto dumped = field.as_dumped(kind, filled);
      for (const FieldSection* section : parts_of(field)) {
        const Grading* curve = section->curve(kind, filled);
        if (curve == nullptr || !dumped) continue;
        const PoreMaterial here = pore_material(*curve, e), there = pore_material(*dumped, e);
        rows.push_back({section->name, kind, filled, here.d10, here.d50, here.cu,
                        conductivity_kozeny_carman(here), conductivity_taylor(here),
                        conductivity_ratio_kozeny_carman(here, there), conductivity_ratio_taylor(here, there),
                        conductivity_ratio_taylor(here, there, 2)});
      }
    }
  return rows;
}

const char* verdict_in_words(PrintedVerdict verdict) {
  switch (verdict) {
    case PrintedVerdict::as_printed:
      return "as printed";
    case PrintedVerdict::within_reach:
      return "within the rounding of the table";
    case PrintedVerdict::differs:
      return "differs";
    case PrintedVerdict::not_computable:
      break;
  }
  return "not in the table";
}

void write_field_tables(const FieldAnalysis& field, const std::vector<HeldValue>& printed,
                        const std::filesystem::path& folder) {
  write_text_file(folder / "sections.csv", statistics(field));
  write_text_file(folder / "pictures.csv", pictures(field));
  write_text_file(folder / "envelopes.csv", envelopes(field));
  write_text_file(folder / "histograms.csv", histograms(field));
  write_text_file(folder / "chi_fit.csv", chi_fits(field));
  write_text_file(folder / "ksat.csv", conductivities(field));
  if (field.sections.front().has("chi_given")) write_text_file(folder / "chi_given.csv", given_chi(field));
  if (!printed.empty()) write_text_file(folder / "printed.csv", printed_table(printed));
  if (const Grading* seen = field.whole.curve(CurveKind::medians, false))
    write_text_file(folder / "median_whole.csv",
                    grading_file(*seen, "Medians over pictures of the shares passing."));
  if (const Grading* filled = field.whole.curve(CurveKind::medians, true))
    write_text_file(
        folder / "corrected_whole.csv",
        grading_file(*filled, fmt::format("Medians over pictures; below {:.6g} m as the sieved sample.",
                                          field.options.limit)));
}

}  // namespace scree
