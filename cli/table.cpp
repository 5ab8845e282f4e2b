#include "cli/table.h"

#include <fmt/format.h>

#include <cmath>

#include "analysis/report/report_text.h"
#include "analysis/results/summary.h"

namespace scree {
namespace {

// Three digits of the value, the deviation with the same decimals.
std::string with_std(double mean, std::optional<double> std) {
  const int decimals = decimals_of(mean);
  if (std && !std::isnan(*std)) return fmt::format("{:.{}f} +- {:.{}f}", mean, decimals, *std, decimals);
  return fmt::format("{:.{}f}", mean, decimals);
}

std::string printed(const ReferenceValue& reference) {
  switch (meaning_of(reference)) {
    case Meaning::at_least:
      return ">= " + with_std(reference.value, reference.std);
    case Meaning::at_most:
      return "<= " + with_std(reference.value, reference.std);
    case Meaning::range:
      return with_std(reference.value, std::nullopt) + " to " +
             with_std(reference.upper.value(), std::nullopt);
    default:
      return with_std(reference.value, reference.std);
  }
}

}  // namespace

void print_comparison(const std::vector<Comparison>& comparison) {
  if (comparison.empty()) return;
  fmt::print("\n{:<16} {:<19} {:<8} {:<9} {:>17} {:>17} {:>7}  {}\n", "case", "value", "section", "kind",
             "printed", "simulated", "z", "verdict");
  for (const Comparison& c : comparison)
    fmt::print("{:<16} {:<19} {:<8} {:<9} {:>17} {:>17} {:>7}  {}\n", c.reference.case_name,
               c.reference.quantity, c.reference.section, c.reference.kind, printed(c.reference),
               with_std(c.simulated, c.simulated_std), c.z ? fmt::format("{:+.1f}", *c.z) : "-",
               in_words(verdict(c)));
}

void print_result(const RunResult& result) {
  for (const std::string& effect : result.effects) fmt::print("effect {}\n", effect);
  for (const SeedResult& s : result.seeds)
    fmt::print(
        "seed {}: {} spheres, {:.1f} s simulated in {:.1f} s, {:.1f} M particle-steps/s, largest overlap "
        "{:.0f} %, energy {}, lost {}{}\n",
        s.seed, s.particles, s.simulated_seconds, s.wall_seconds, s.particle_steps / s.wall_seconds / 1e6,
        100 * s.largest_overlap_ratio,
        s.energy ? energy_in_words(s.energy->relative_error, s.energy->closed) : "- (impulse)",
        s.lost_particles, s.at_rest ? "" : "  (not at rest)");
  if (const SectionTable* layout = section_layout(result, 0)) {
    fmt::print("\n{:<8} {:>6} {:>9} {:>16} {:>8} {:>9}\n", "section", "x/L", "mass t", "chi", "D50 m",
               "D50/D50'");
    for (std::size_t k = 0; k < layout->sections.size(); ++k) {
      const auto mean = [&](auto get) { return mean_std(over_seeds(result, 0, k, get)); };
      const MeanStd chi = mean([](const Section& x) { return x.chi; });
      fmt::print("{:<8} {:>6.2f} {:>9.1f} {:>16} {:>8.3f} {:>9.2f}\n", layout->sections[k].name,
                 layout->sections[k].x_over_l, mean([](const Section& x) { return x.mass / 1000; }).mean,
                 with_std(chi.mean, chi.std), mean([](const Section& x) { return x.d50; }).mean,
                 mean([](const Section& x) { return x.d50_rel; }).mean);
    }
    if (const double outside = share_in_no_section(result); outside > kMuchInNoSection)
      fmt::print("{:.0f} % of the rock lies above the crest's height and belongs to no section\n",
                 100 * outside);
  }
  std::vector<double> rebound;
  for (const SeedResult& s : result.seeds)
    if (s.rebound_height) rebound.push_back(*s.rebound_height);
  if (!rebound.empty()) {
    const MeanStd height = mean_std(rebound);
    fmt::print("\nrebound height {} m\n", with_std(height.mean, height.std));
  }
  std::vector<double> angle, over, half;
  for (const SeedResult& s : result.seeds)
    if (s.repose) {
      angle.push_back(s.repose->angle);
      over.push_back(s.repose->height_over_radius);
      half.push_back(s.repose->half_coverage);
    }
  if (!angle.empty()) {
    const auto degrees = [](const MeanStd& a) { return a.n > 0 ? with_std(a.mean, a.std) : "-"; };
    const MeanStd a = mean_std(angle);
    fmt::print("\n{}; height over radius {}; over half-covered radius {}\n",
               a.n > 0 ? fmt::format("repose angle (slope of the flank) {} deg", degrees(a))
                       : "no repose angle (reason below)",
               degrees(mean_std(over)), degrees(mean_std(half)));
  }
  print_comparison(result.comparison);
  for (const std::string& failure : result.failures) fmt::print("\nFAILED: {}\n", failure);
  for (const std::string& note : result.notes) fmt::print("\nnote: {}\n", note);
}

}  // namespace scree
