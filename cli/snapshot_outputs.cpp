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

constexpr double kOtherRock = 4;    // times the D50 of the scenario: other rock, or other units
constexpr double kMuchAbove = 0.2;  // of the mass above the crest: the pile and the bench do not fit

constexpr std::array kOfDumps{"layer_coarsening_down", "layer_variance_between", "layer_variance_by_chance",
                              "point1_toe_width_m"};

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
