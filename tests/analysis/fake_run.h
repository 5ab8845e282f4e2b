#pragma once
// A made-up end dumping with two seeds: a wedge of rock that coarsens towards the toe. Not physics, only
// numbers to show.
#include <cmath>
#include <random>

#include "analysis/results/results.h"

namespace scree {

inline SeedResult fake_seed(std::uint64_t number) {
  constexpr double height = 10, bench = 1.0 /* tan 45 */, pile = 0.781 /* tan 38 */;
  std::mt19937_64 random(number);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> scatter(0, 0.35);
  SeedResult seed;
  seed.seed = number;
  for (std::int64_t id = 0; id < 5000; ++id) {
    const double z = height * std::sqrt(share(random)) * 0.98;
    const double inner = (height - z) / bench, outer = inner + (height - z) * (1 / pile - 1 / bench) + 1.2;
    Grain grain;
    grain.id = id;
    grain.dump = 1 + static_cast<int>(id / 1250);
    grain.diameter = 0.12 * std::pow(10.0, 0.75 * (1 - z / height) + scatter(random));
    grain.diameter = std::min(std::max(grain.diameter, 0.08), 1.2);
    grain.position = Vec3(inner + (outer - inner) * share(random), 8 * (share(random) - 0.5), 0);
    grain.position.z() = std::max(z, grain.diameter / 2);
    grain.velocity = Vec3::Zero();
    grain.mass = 2700 * 3.14159265 / 6 * std::pow(grain.diameter, 3);
    seed.mass += grain.mass;
    seed.final_state.grains.push_back(grain);
  }
  seed.original = seed.final_state.grains;
  seed.particles = 5000;
  seed.fixed.resize(1200);
  seed.steps = 400000;
  seed.particle_steps = 1.2e9;
  seed.wall_seconds = 420;
  seed.simulated_seconds = 61.5;
  seed.time_step_min = 1.4e-4;
  seed.time_step_max = 1.6e-4;
  seed.largest_overlap_ratio = 0.031;
  seed.lost_particles = 3;
  seed.lost_mass = 240;
  seed.at_rest = true;
  seed.sections = {analyse_sections(seed.final_state.grains, seed.original, height, 6),
                   analyse_sections(seed.final_state.grains, seed.original, height, 3)};
  for (double x = 0; x < 14; x += 0.5) seed.profile.push_back({x, std::max(0.0, height - pile * (x - 1.2))});
  seed.slope_angle = 37.6 + 0.3 * static_cast<double>(number % 3);
  return seed;
}

inline Comparison fake_comparison(const char* quantity, const char* section, const char* kind, double value,
                                  std::optional<double> std, double simulated, std::optional<double> z) {
  Comparison row;
  row.reference = {
      kind[0] == 'p' ? "A1" : "cm_field_6sec", quantity, section, kind, value, std, "-", "eq", "table 5.3"};
  row.simulated = simulated;
  row.simulated_std = 0.11;
  row.z = z;
  return row;
}

inline RunResult fake_run() {
  RunResult run;
  run.title = "Four truck loads over a 10 m bench <script>alert('x')</script>";
  run.scenario = "end_dump_10m";
  run.engine = "rrlinear";
  run.version = "0.1.0";
  run.seeds = {fake_seed(10001), fake_seed(10002)};
  run.bench_height = 10;
  run.wall_seconds = 845;
  run.comparison = {fake_comparison("chi", "S1", "pfc3d", -1.04, 0.33, -0.95, 0.26),
                    fake_comparison("chi", "S6", "pfc3d", 0.26, 0.09, 0.31, 0.35),
                    fake_comparison("chi", "S1", "measured", -0.77, 0.39, -0.95, -0.44),
                    fake_comparison("chi", "S4", "measured", -0.29, 0.21, 0.05, 1.43),
                    fake_comparison("chi", "S6", "measured", 0.56, 0.08, 0.31, -1.84),
                    fake_comparison("d50_rel", "S1", "measured", 0.38, 0.12, 0.92, 3.32),
                    fake_comparison("d50_rel", "S6", "measured", 1.9, std::nullopt, 1.37, std::nullopt)};
  run.notes = {"240 kg of rock (0.3 % & 3 grains) left the model."};
  return run;
}

}  // namespace scree
