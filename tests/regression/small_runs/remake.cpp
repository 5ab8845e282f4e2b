// Makes small_runs.csv anew and shows what changed.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <stdexcept>

#include "tests/regression/small_runs/small_runs.h"

namespace {

using namespace scree;
using Table = std::map<std::string, SceneNumbers>;

struct Change {
  std::string scene, number;
  MeanStd stored, now;
  double shift = 0;  // of the means, in standard errors of their difference if the runs were other ones
};

// Same seeds on both sides: what did not change is the same to the last digit.
void show(const Table& stored, const Table& now) {
  int same = 0, fresh = 0, gone = 0;
  std::vector<Change> changed;
  for (const auto& [scene, numbers] : now) {
    const auto before = stored.find(scene);
    for (const auto& [name, values] : numbers) {
      if (before == stored.end() || !before->second.contains(name)) {
        ++fresh;
      } else if (before->second.at(name) == values) {
        ++same;
      } else {
        const MeanStd a = mean_std(before->second.at(name)), b = mean_std(values);
        changed.push_back(
            {scene, name, a, b, (b.mean - a.mean) / std::sqrt((a.std * a.std + b.std * b.std) / a.n)});
      }
    }
    if (before != stored.end())
      gone +=
          static_cast<int>(std::count_if(before->second.begin(), before->second.end(),
                                         [&](const auto& each) { return !numbers.contains(each.first); }));
  }
  std::stable_sort(changed.begin(), changed.end(),
                   [](const Change& a, const Change& b) { return std::abs(a.shift) > std::abs(b.shift); });
  fmt::print("\n{} numbers are the same, {} changed, {} are new, {} are gone\n", same, changed.size(), fresh,
             gone);
  if (changed.empty()) return;
  fmt::print("\n{:<20} {:<24} {:>12} {:>12} {:>10} {:>16}\n", "scene", "number", "stored", "now", "deviation",
             "standard errors");
  for (const Change& each : changed)
    fmt::print("{:<20} {:<24} {:>12.5g} {:>12.5g} {:>10.3g} {:>16.1f}\n", each.scene, each.number,
               each.stored.mean, each.now.mean, each.stored.std, each.shift);
}

// What the test would say of a changed scenario: whether the suite would notice.
int try_change(const std::vector<std::string>& scenes, const std::vector<std::string>& overrides) {
  const Table table = read_numbers(stored_numbers_file());
  std::vector<double> all;
  for (const std::string& scene : scenes) {
    if (!table.contains(scene)) throw std::runtime_error(scene + " is not stored");
    const SceneShift shift =
        shift_of(table.at(scene), run_scene(scene, kStoredSeeds + 1, kTestedSeeds, overrides));
    all.push_back(shift.p);
    fmt::print("{:<20} p {:.4f}  {}{}\n", scene, shift.p,
               shift.numbers.empty() ? "" : shift.numbers.front().name + " moved most",
               shift.broken.empty() ? "" : "; " + shift.broken.front());
    std::fflush(stdout);
  }
  fmt::print("together             p {:.2g}\n", together(all));
  return 0;
}

int remake(const std::vector<std::string>& scenes, bool write) {
  const std::vector<std::string> every = scene_names();
  Table table, now;
  if (std::filesystem::exists(stored_numbers_file())) table = read_numbers(stored_numbers_file());
  std::erase_if(table, [&](const auto& each) {
    return std::find(every.begin(), every.end(), each.first) == every.end();
  });
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    now[scenes[k]] = numbers_of(run_scene(scenes[k], 1, kStoredSeeds));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    fmt::print("{} of {}  {:<20} {:>3} numbers, about {:.0f} s left\n", k + 1, scenes.size(), scenes[k],
               now[scenes[k]].size(),
               seconds / static_cast<double>(k + 1) * static_cast<double>(scenes.size() - k - 1));
    std::fflush(stdout);
  }
  show(table, now);
  if (!write) return 0;
  for (const auto& [scene, numbers] : now) table[scene] = numbers;
  write_numbers(table, stored_numbers_file());
  fmt::print("\nwritten: {}\n", stored_numbers_file().string());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Runs the small scenes of the regression suite with seeds 1 to 40, shows what changed against "
      "small_runs.csv, and writes it anew");
  std::vector<std::string> scenes;
  std::vector<std::string> overrides;
  bool dry = false;
  app.add_option("scene", scenes, "Only these (names in tests/regression/small_runs/scenes); default: all")
      ->check(CLI::IsMember(scene_names()));
  app.add_flag("--dry", dry, "Show, but write nothing");
  app.add_option("--try", overrides,
                 "Instead: would the test notice this change? (scenario key=value, 8 seeds)")
      ->allow_extra_args(false);
  CLI11_PARSE(app, argc, argv);
  try {
    if (scenes.empty()) scenes = scene_names();
    return overrides.empty() ? remake(scenes, !dry) : try_change(scenes, overrides);
  } catch (const std::exception& error) {
    fmt::print(stderr, "remake_small_runs: {}\n", error.what());
    return 1;
  }
}
