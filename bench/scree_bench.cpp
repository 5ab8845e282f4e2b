// scree_bench: makes the start packings of the benchmarks and times scree on them.
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>

#include "bench/scenes.h"
#include "sim/world/rrlinear_world.h"

namespace {

double cpu_seconds() {
  rusage u{};
  getrusage(RUSAGE_SELF, &u);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(u.ru_utime) + seconds(u.ru_stime);
}
double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double peak_memory_mib() {
  rusage u{};
  getrusage(RUSAGE_SELF, &u);
  return static_cast<double>(u.ru_maxrss) / 1024.0;
}

// Between spheres.
double closed_contacts(const scree::PairList& pairs) {
  double count = 0;
  for (int i = 0; i < pairs.rows(); ++i)
    for (const scree::Neighbour& n : pairs.owned(i)) count += n.touching() ? 1 : 0;
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Makes the start packings of the benchmarks and times scree on them.");
  app.require_subcommand(1);
  std::string scene, file, state, drop;
  double amount = 0, seconds = 1.0, from = 0.0;
  scree::bench::SceneSettings settings;

  CLI::App* pack = app.add_subcommand("pack", "write a start packing");
  pack->add_option("scene", scene, "lab, field or heap")
      ->required()
      ->check(CLI::IsMember({"lab", "field", "heap"}));
  pack->add_option("file", file, "CSV to write")->required();
  pack->add_option("--amount", amount, "lab: kg (75); field: t (1200); heap: number of spheres (10000)");

  CLI::App* run = app.add_subcommand("run", "run a scene from its packing; one line of JSON on stdout");
  run->add_option("scene", scene, "lab, field or heap")
      ->required()
      ->check(CLI::IsMember({"lab", "field", "heap"}));
  run->add_option("file", file, "packing")->required();
  run->add_option("--seconds", seconds, "simulated seconds that are timed");
  run->add_option("--from", from, "simulated seconds before the clock starts");
  run->add_option("--time-step", settings.time_step, "s; 0: scree's own");
  run->add_option("--threads", settings.threads, "worker threads");
  run->add_flag("--sleep", settings.sleep, "spheres at rest sleep");
  run->add_option("--drop", drop, "packing that is put above the other when the clock starts");
  run->add_option("--state", state, "CSV of where the spheres are in the end");
  CLI11_PARSE(app, argc, argv);

  try {
    using namespace scree::bench;
    if (*pack) {
      Packing packing;
      if (scene == "lab") packing = lab_packing(amount > 0 ? amount : 75.0, 0.60);
      if (scene == "field") packing = field_packing(1000.0 * (amount > 0 ? amount : 1200.0));
      if (scene == "heap") packing = heap_packing(amount > 0 ? static_cast<int>(amount) : 10000);
      write_packing(packing, file);
      fmt::print("{} spheres\n", packing.size());
      return 0;
    }
    const Packing packing = read_packing(file);
    const auto made = make_scene(scene, packing, settings);
    auto* const world = dynamic_cast<scree::RrlinearWorld*>(made.get());
    world->advance_to(from);
    const auto before = world->statistics();
    const Packing load = drop.empty() ? Packing() : lifted_above(read_packing(drop), packing);
    const double cpu = cpu_seconds(), wall = wall_seconds();
    if (!load.empty()) world->add_spheres(load);
    world->advance_to(from + seconds);
    const double cpu_used = cpu_seconds() - cpu, wall_used = wall_seconds() - wall;
    const auto& after = world->statistics();
    const double steps = static_cast<double>(after.steps - before.steps), n = world->spheres().movable;
    fmt::print(
        "{{\"code\": \"scree\", \"scene\": \"{}\", \"spheres\": {}, \"threads\": {}, \"steps\": {}, "
        "\"cpu_s\": {:.3f}, "
        "\"wall_s\": {:.3f}, \"cpu_s_per_simulated_s\": {:.3f}, \"particle_steps_per_cpu_s\": {:.4g}, "
        "\"awake_particle_steps_per_cpu_s\": {:.4g}, \"ns_per_sphere_and_step\": {:.2f}, \"memory_mib\": "
        "{:.1f}, "
        "\"asleep\": {}, \"list_repairs\": {}, \"bytes_per_sphere\": {:.1f}, \"contacts_per_sphere\": "
        "{:.3f}}}\n",
        scene, n, settings.threads, steps, cpu_used, wall_used, cpu_used / seconds, n * steps / cpu_used,
        (after.particle_steps - before.particle_steps) / cpu_used, 1e9 * wall_used / (n * steps),
        peak_memory_mib(), after.asleep, after.list_repairs - before.list_repairs,
        static_cast<double>(world->bytes()) / n, closed_contacts(world->pairs()) / n);
    if (!state.empty()) {
      Packing end;
      for (const scree::Grain& g : world->snapshot().grains) {
        scree::NewSphere s;
        s.position = g.position;
        s.diameter = g.diameter;
        end.push_back(s);
      }
      write_packing(end, state);
    }
  } catch (const std::exception& e) {
    fmt::print(stderr, "scree_bench: {}\n", e.what());
    return 2;
  }
}
