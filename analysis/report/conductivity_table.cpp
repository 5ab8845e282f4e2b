#include "analysis/report/conductivity_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/pile/permeability.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "";
}

PoreMaterial as_dumped(const std::vector<Grain>& grains) {
  std::vector<double> diameters, masses;
  for (const Grain& grain : grains) diameters.push_back(grain.diameter), masses.push_back(grain.mass);
  const PassingCurve curve(std::move(diameters), masses);
  return {curve.diameter(0.1), curve.diameter(0.5), curve.diameter(0.6) / curve.diameter(0.1), 1};
}

/// Numbers of one part; NaN where there are none.
struct Row {
  double x = NAN, z = NAN, porosity = NAN, d10 = NAN, d50 = NAN, cu = NAN;
  double kcm_rel = NAN, taylor_rel = NAN, kcm_voids = NAN, taylor_voids = NAN, kcm = NAN, taylor = NAN;
};

Row row_of(const PoreMaterial& part, const PoreMaterial& original) {
  Row row;
  row.d10 = part.d10, row.d50 = part.d50, row.cu = part.cu;
  row.kcm_rel = conductivity_ratio_kozeny_carman(part, original);
  row.taylor_rel = conductivity_ratio_taylor(part, original);
  return row;
}

void add_absolute(Row& row, PoreMaterial part, double porosity) {
  if (!(porosity > 0 && porosity < 1)) return;  // soft grains may leave no void
  part.void_ratio = void_ratio(porosity);
  row.kcm = conductivity_kozeny_carman(part);
  row.taylor = conductivity_taylor(part);
}

std::string text_of(std::uint64_t seed, const std::string& part, const Row& r) {
  std::string text = fmt::format("{},{}", seed, part);
  for (const double value : {r.x, r.z, r.porosity, r.d10, r.d50, r.cu, r.kcm_rel, r.taylor_rel, r.kcm_voids,
                             r.taylor_voids, r.kcm, r.taylor})
    text += ',' + number(value);
  return text + "\n";
}

std::string sections_of(const SeedResult& seed, const PoreMaterial& original) {
  std::string text;
  std::optional<Row> crest, toe;
  const double porosity = seed.inside ? seed.inside->mean_porosity : NAN;
  const std::vector<Section>& sections = seed.sections.front().sections;
  for (const Section& section : sections) {
    if (!std::isfinite(section.d10)) continue;
    const PoreMaterial part{section.d10, section.d50, section.d60 / section.d10, 1};
    Row row = row_of(part, original);
    add_absolute(row, part, porosity);
    text += text_of(seed.seed, section.name, row);
    if (&section == &sections.front()) crest = row;
    if (&section == &sections.back()) toe = row;
  }
  if (!crest || !toe || sections.size() < 2) return text;
  Row ratio;
  ratio.d10 = toe->d10 / crest->d10, ratio.d50 = toe->d50 / crest->d50, ratio.cu = toe->cu / crest->cu;
  ratio.kcm_rel = toe->kcm_rel / crest->kcm_rel, ratio.taylor_rel = toe->taylor_rel / crest->taylor_rel;
  return text + text_of(seed.seed, fmt::format("{}/{}", sections.back().name, sections.front().name), ratio);
}

std::string cells_of(const SeedResult& seed, const PoreMaterial& original) {
  if (!seed.inside) return "";
  std::string text;
  const Inside& inside = *seed.inside;
  for (int k = 0; k < inside.nz; ++k)
    for (int i = 0; i < inside.nx; ++i) {
      const InsideCell& cell = inside.at(i, k);
      if (!std::isfinite(cell.d10)) continue;
      const PoreMaterial part{cell.d10, cell.d50, cell.cu, 1};
      Row row = row_of(part, original);
      row.x = inside.x0 + (i + 0.5) * inside.section.cell,
      row.z = inside.z0 + (k + 0.5) * inside.section.cell;
      row.porosity = cell.porosity;
      row.kcm_voids = cell.ksat_kozeny_carman, row.taylor_voids = cell.ksat_taylor;
      add_absolute(row, part, cell.porosity);
      text += text_of(seed.seed, "cell", row);
    }
  return text;
}

}  // namespace

void write_conductivity_csv(const RunResult& result, const std::filesystem::path& file) {
  std::string text;
  for (const SeedResult& seed : result.seeds) {
    if (seed.sections.empty() || seed.original.empty()) continue;
    const PoreMaterial original = as_dumped(seed.original);
    text += sections_of(seed, original) + cells_of(seed, original);
  }
  if (text.empty()) return;
  write_text_file(file,
                  "seed,part,x_m,z_m,porosity,d10_m,d50_m,cu,ksat_kcm_rel,ksat_taylor_rel,ksat_kcm_rel_voids,"
                  "ksat_taylor_rel_voids,ksat_kcm_m_per_s,ksat_taylor_m_per_s\n" +
                      text);
}

}  // namespace scree
