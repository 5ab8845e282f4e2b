#include "cli/snapshot_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "analysis/results/outputs.h"
#include "cli/results_of.h"

namespace scree {
namespace {

constexpr double kOtherRock = 4;     // times the D50 of the scenario: other rock, or other units
constexpr double kMuchAbove = 0.2;   // of the mass above the crest: the pile and the bench do not fit
constexpr double kMuchBehind = 0.1;  // of the mass inside the bench
constexpr double kFewNear = 0.05;    // of the mass, where a pile has no more of it near its bench
constexpr double kReachOfToe = 0.5;  // of the bench's height: what is near its toe

constexpr std::array kOfDumps{"layer_coarsening_down", "layer_variance_between", "layer_variance_by_chance",
                              "point1_toe_width_m"};

// A pile at another place than its bench: mirrored, or shifted along x. chi goes by height and is the same.
void note_misplaced(const BenchSpec& bench, const std::vector<Grain>& pile, std::vector<std::string>& notes) {
  const double toe = BenchOutline{bench.height, bench.slope_deg}.toe();
  const double far = toe + kReachOfToe * bench.height;
  // Rock may lie between the balls of the top.
  const double top = bench.height - (bench.base_layer == BaseLayer::none ? 0 : bench.ball_diameter);
  double mass = 0, behind = 0, beyond = 0;
  for (const Grain& grain : pile) {
    const Vec3& at = grain.position;
    mass += grain.mass;
    if (at.x() < 0 && at.z() + 0.5 * grain.diameter < top) behind += grain.mass;
    if (at.x() > far) beyond += grain.mass;
  }
  if (behind > kMuchBehind * mass)
    notes.push_back(
        fmt::format("{:.0f} % of the mass lies behind the crest (x < 0) below the bench's top, inside the "
                    "bench: its crest must be at x = 0, dumped towards +x (--shift moves the pile)",
                    100 * behind / mass));
  if (beyond > (1 - kFewNear) * mass)
    notes.push_back(
        fmt::format("{:.0f} % of the mass lies more than {:.3g} m beyond the toe (x = {:.3g} m): the bench's "
                    "crest must be at x = 0 (--shift moves the pile)",
                    100 * beyond / mass, far - toe, toe));
}

void note_misfit(const Scenario& scenario, const SeedResult& seed, std::vector<std::string>& notes) {
  if (!scenario.grading_file.empty() && !seed.final_state.grains.empty()) {
    std::vector<double> diameters, masses;
    for (const Grain& grain : seed.final_state.grains) {
      diameters.push_back(grain.diameter);
      masses.push_back(grain.mass);
    }
    const double pile = PassingCurve(diameters, masses).diameter(0.5),
                 dumped = grading_of(scenario).diameter(0.5);
    if (pile > kOtherRock * dumped || dumped > kOtherRock * pile)
      notes.push_back(fmt::format(
          "D50 of this pile is {:.3g} m, that of the scenario's grading {:.3g} m: is it this rock, "
          "and are the units right (--length-unit)?",
          pile, dumped));
  }
  double lowest = std::numeric_limits<double>::max(), largest = 0, mass = 0;
  for (const Grain& grain : seed.final_state.grains) {
    lowest = std::min(lowest, grain.position.z() - 0.5 * grain.diameter);
    largest = std::max(largest, grain.diameter);
    mass += grain.mass;
  }
  if (std::abs(lowest) > largest)
    notes.push_back(fmt::format(
        "the lowest grain ends at z = {:.3g} m; the floor must be z = 0 (--shift moves the pile)", lowest));
  if (bench_of(scenario) != nullptr && !seed.sections.empty() &&
      seed.sections.front().mass_outside > kMuchAbove * mass)
    notes.push_back(
        fmt::format("{:.0f} % of the mass lies above the crest ({:g} m): is it this bench, its crest at x = "
                    "0, its floor at z = 0, dumped towards +x?",
                    100 * seed.sections.front().mass_outside / mass, bench_of(scenario)->height));
  if (const BenchSpec* bench = bench_of(scenario)) note_misplaced(*bench, seed.final_state.grains, notes);
  if (const std::string why = why_no_slope_angle(scenario, seed); !why.empty()) notes.push_back(why);
}

}  // namespace

std::vector<Grain> grains_of(const Grading& grading, double mass, int count) {
  std::vector<Grain> grains(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    Grain& grain = grains[static_cast<std::size_t>(k)];
    grain.id = k;
    grain.diameter = grading.diameter((k + 0.5) / count);
    grain.mass = mass / count;
    grain.dump = 1;
  }
  return grains;
}

Outputs outputs_of_snapshot(const Scenario& scenario, SnapshotRead read, std::vector<std::string>& notes) {
  if (std::holds_alternative<DropTest>(scenario.experiment))
    throw std::invalid_argument("a drop test leaves no pile; its rebound is measured");
  RunOutcome outcome;
  outcome.final_state = std::move(read.snapshot);
  outcome.fixed = std::move(read.fixed);
  if (!read.original.empty()) {
    outcome.original = std::move(read.original);
  } else if (!scenario.grading_file.empty()) {
    double mass = 0;
    for (const Grain& grain : outcome.final_state.grains) mass += grain.mass;
    outcome.original = grains_of(grading_of(scenario), mass);
  } else {
    outcome.original = outcome.final_state.grains;
  }
  const SeedResult seed = analyse(scenario, 0, std::move(outcome), std::nullopt);
  note_misfit(scenario, seed, notes);
  Outputs outputs = outputs_of(seed);
  std::erase_if(outputs, [](const auto& output) { return is_of_the_run(output.first); });
  outputs.erase("carried_back_t");  // it is not in the pile
  if (!read.has_dumps)
    for (const char* name : kOfDumps) outputs.erase(name);
  if (outputs.empty()) throw std::invalid_argument("nothing of the pile can be read: is it this experiment?");
  return outputs;
}

}  // namespace scree
