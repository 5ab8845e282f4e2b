#include "analysis/pile/segregation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "analysis/pile/counted_grains.h"
#include "analysis/pile/permeability.h"
#include "analysis/pile/seen_surface.h"
#include "analysis/pile/slope_profile.h"

namespace scree {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double kUsualSlope = 37;  // degrees: the thesis's reference repose angle

std::optional<PassingCurve> curve_of(const NamedGrains& part, const Measurement& measured) {
  if (part.grains.empty()) return std::nullopt;
  const CountedGrains counted = count_grains(part.grains, measured, part.seen);
  if (counted.diameters.empty()) return std::nullopt;
  return PassingCurve(counted.diameters, counted.masses, measured.blur);
}

// What parts of a pile are compared with, where that is not the rock as dumped alone; none if nothing is
// seen.
std::optional<PassingCurve> mixed_reference(const NamedGrains& dumped, const NamedGrains& pile,
                                            const Measurement& measured) {
  CountedGrains mixed;
  const auto add = [&](const CountedGrains& part, double share) {
    if (!(share > 0)) return;
    const double mass = std::accumulate(part.masses.begin(), part.masses.end(), 0.0);
    mixed.diameters.insert(mixed.diameters.end(), part.diameters.begin(), part.diameters.end());
    for (const double each : part.masses) mixed.masses.push_back(each * share / mass);
  };
  add(count_grains(dumped.grains, measured), 1 - measured.own_reference);
  add(count_grains(pile.grains, measured, pile.seen), measured.own_reference);
  if (mixed.diameters.empty()) return std::nullopt;
  return PassingCurve(mixed.diameters, mixed.masses, measured.blur);
}

// Along whose normal a slope is seen, degrees.
double facing(const std::vector<Grain>& pile, double crest_height) {
  const auto line = slope_line(slope_profile(pile, crest_height), crest_height);
  return line && line->angle > 0 ? line->angle : kUsualSlope;
}

/// Preferred numbers R10 (ISO 3) from just below the smallest to just above the largest diameter; 1 m is
/// among them.
std::vector<double> sieves_for(double smallest, double largest) {
  constexpr std::array<double, 10> r10{1, 1.25, 1.6, 2, 2.5, 3.15, 4, 5, 6.3, 8};
  std::vector<double> all;
  for (int decade = -7; decade <= 3; ++decade)
    for (const double number : r10) all.push_back(number * std::pow(10.0, decade));
  auto first = std::upper_bound(all.begin(), all.end(), smallest);
  auto last = std::lower_bound(all.begin(), all.end(), largest);
  if (first != all.begin()) --first;
  if (last != all.end()) ++last;
  return {first, last};
}

/// At a void ratio of 1, which drops out of ratios.
PoreMaterial pore_material(const PassingCurve& curve) {
  return {curve.diameter(0.10), curve.diameter(0.50), curve.diameter(0.60) / curve.diameter(0.10), 1};
}

}  // namespace

NamedGrains all_grains_of(const std::vector<NamedGrains>& parts) {
  NamedGrains all;
  for (const NamedGrains& part : parts) {
    all.grains.insert(all.grains.end(), part.grains.begin(), part.grains.end());
    all.seen.insert(all.seen.end(), part.seen.begin(), part.seen.end());
  }
  return all;
}

SectionTable tabulate(const std::vector<NamedGrains>& parts, const std::vector<Grain>& original,
                      const Measurement& measured, const NamedGrains* pile) {
  if (original.empty()) throw std::invalid_argument("the original material has no grain");
  NamedGrains all;
  all.grains.reserve(original.size());
  for (const Grain& grain : original) all.grains.push_back(&grain);
  const PassingCurve dumped = *curve_of(all, measured);
  const auto mixed = measured.own_reference > 0
                         ? mixed_reference(all, pile != nullptr ? *pile : all_grains_of(parts), measured)
                         : std::nullopt;
  const PassingCurve& whole = mixed ? *mixed : dumped;

  SectionTable table;
  table.d0_log = whole.mean_log_diameter();
  table.dcq_log = whole.coarsest_quartile_log_diameter();
  const auto [smallest, largest] =
      std::minmax_element(original.begin(), original.end(),
                          [](const Grain& a, const Grain& b) { return a.diameter < b.diameter; });
  table.sieves = sieves_for(smallest->diameter, largest->diameter);
  for (const double sieve : table.sieves) table.original_passing.push_back(dumped.passing(sieve));

  const double spread = table.dcq_log - table.d0_log;
  for (const NamedGrains& part : parts) {
    Section section;
    section.name = part.name;
    section.x_over_l = part.x_over_l;
    section.grains = static_cast<int>(part.grains.size());
    const auto curve = curve_of(part, measured);
    const auto diameter = [&](double p) { return curve ? curve->diameter(p) : nan; };
    if (curve)
      section.mass = curve->mass();
    else
      for (const Grain* grain : part.grains) section.mass += grain->mass;
    // A material of one size has no coarser quartile to segregate: chi is not defined.
    section.chi = curve && spread > 0 ? (curve->mean_log_diameter() - table.d0_log) / spread : nan;
    section.d10 = diameter(0.10);
    section.d15 = diameter(0.15);
    section.d50 = diameter(0.50);
    section.d60 = diameter(0.60);
    section.d80 = diameter(0.80);
    section.d90 = diameter(0.90);
    section.d95 = diameter(0.95);
    section.d10_rel = section.d10 / whole.diameter(0.10);
    section.d50_rel = section.d50 / whole.diameter(0.50);
    section.d80_rel = section.d80 / whole.diameter(0.80);
    section.d90_rel = section.d90 / whole.diameter(0.90);
    section.d95_rel = section.d95 / whole.diameter(0.95);
    section.ksat_rel =
        curve ? conductivity_ratio_kozeny_carman(pore_material(*curve), pore_material(whole)) : nan;
    for (const double sieve : table.sieves) section.passing.push_back(curve ? curve->passing(sieve) : nan);
    section.share_above_1m =
        curve ? section.mass * (1 - curve->passing(1)) : 0;  // kg, until the sum is known
    table.sections.push_back(std::move(section));
  }
  table.original_above_1m = 1 - dumped.passing(1);
  double above = 0;
  for (const Section& section : table.sections) above += section.share_above_1m;
  for (Section& section : table.sections)
    section.share_above_1m = above > 0 ? section.share_above_1m / above : nan;
  return table;
}

int slice_of(const Grain& grain, double crest_height, int n, double border_shift) {
  const double below_crest = (crest_height - grain.position.z()) / crest_height;
  if (!(below_crest >= 0)) return -1;  // above the crest, or no number
  return static_cast<int>(std::clamp(below_crest * n - border_shift, 0.0, n - 1.0));
}

std::vector<NamedGrains> slices_of(const std::vector<Grain>& pile, double crest_height, int n,
                                   const Measurement& measured) {
  std::vector<NamedGrains> slices;
  for (int k = 0; k < n; ++k) slices.push_back({fmt::format("S{}", k + 1), (2.0 * k + 1) / (2.0 * n), {}});
  std::vector<double> seen;
  if (measured.surface_share > 0) seen = seen_shares(pile, facing(pile, crest_height));
  for (std::size_t g = 0; g < pile.size(); ++g) {
    const int slice = slice_of(pile[g], crest_height, n, measured.border_shift);
    if (slice < 0) continue;
    slices[static_cast<std::size_t>(slice)].grains.push_back(&pile[g]);
    if (!seen.empty()) slices[static_cast<std::size_t>(slice)].seen.push_back(seen[g]);
  }
  return slices;
}

SectionTable analyse_sections(const std::vector<Grain>& pile, const std::vector<Grain>& original,
                              double crest_height, int n, const Measurement& measured) {
  if (n < 1) throw std::invalid_argument(fmt::format("{} sections: at least 1 is needed", n));
  if (!(crest_height > 0))
    throw std::invalid_argument(fmt::format("crest height {} m must be above 0", crest_height));
  SectionTable table = tabulate(slices_of(pile, crest_height, n, measured), original, measured);
  for (const Grain& grain : pile)
    if (slice_of(grain, crest_height, n) < 0) table.mass_outside += grain.mass;
  return table;
}

}  // namespace scree
