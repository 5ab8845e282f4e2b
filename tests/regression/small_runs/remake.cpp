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

constexpr double kStoredShare = 0.5;

struct Change {
  std::string scene, number;
  MeanStd stored, now, difference;  // the last seed by seed
  double size() const { return std::abs(difference.mean) / (difference.std / std::sqrt(difference.n)); }
};

void list(const char* what, const std::vector<std::string>& names) {
  if (!names.empty()) fmt::print("{}: {}\n", what, fmt::join(names, ", "));
}

// Same seeds on both sides: what did not change is the same to the last digit.
void show(const Table& stored, const Table& now) {
  int same = 0;
  std::vector<std::string> fresh, gone;
  std::vector<Change> changed;
  for (const auto& [scene, numbers] : now) {
    const SceneNumbers none;
    const auto found = stored.find(scene);
    const SceneNumbers& before = found == stored.end() ? none : found->second;
    for (const auto& [name, values] : before)
      if (!numbers.contains(name)) gone.push_back(scene + " " + name);
    for (const auto& [name, values] : numbers) {
      if (!before.contains(name)) {
        fresh.push_back(scene + " " + name);
        continue;
      }
      std::vector<double> difference;
      bool equal = true;
      for (std::size_t k = 0; k < values.size(); ++k) {
        const double a = before.at(name)[k], b = values[k];
        difference.push_back(b - a);
        equal = equal && (a == b || (std::isnan(a) && std::isnan(b)));
      }
      if (equal)
        ++same;
      else
        changed.push_back({scene, name, mean_std(before.at(name)), mean_std(values), mean_std(difference)});
    }
  }
  std::stable_sort(changed.begin(), changed.end(),
                   [](const Change& a, const Change& b) { return a.size() > b.size(); });
  fmt::print("\n{} numbers are the same, {} changed, {} are new, {} are gone\n", same, changed.size(),
             fresh.size(), gone.size());
  list("new", fresh);
  list("gone", gone);
  if (changed.empty()) return;
  fmt::print("\n{:<20} {:<24} {:>12} {:>12} {:>10} {:>24}\n", "scene", "number", "stored", "now", "deviation",
             "difference, seed by seed");
  for (const Change& each : changed)
    fmt::print("{:<20} {:<24} {:>12.5g} {:>12.5g} {:>10.3g} {:>12.3g} +- {:.2g}\n", each.scene, each.number,
               each.stored.mean, each.now.mean, each.stored.std, each.difference.mean,
               each.difference.std / std::sqrt(each.difference.n));
}

// What the test would say of a changed scenario: whether the suite would notice.
int try_change(const std::vector<std::string>& scenes, const std::vector<std::string>& overrides) {
  const Table table = read_numbers(stored_numbers_file());
  std::vector<double> all;
  for (const std::string& scene : scenes) {
    const SceneShift shift = shift_of_tested(table, scene, overrides);
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
  bool failed = false;
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t k = 0; k < scenes.size(); ++k) {
    try {
      now[scenes[k]] = numbers_of(run_scene(scenes[k], 1, kStoredSeeds), kStoredShare);
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}: {}; what is stored of it stays\n", scenes[k], error.what());
      failed = true;
      continue;
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    fmt::print("{} of {}  {:<20} {:>3} numbers, about {:.0f} s left\n", k + 1, scenes.size(), scenes[k],
               now[scenes[k]].size(),
               seconds / static_cast<double>(k + 1) * static_cast<double>(scenes.size() - k - 1));
    std::fflush(stdout);
  }
  show(table, now);
  if (!write) return failed ? 1 : 0;
  for (const auto& [scene, numbers] : now) table[scene] = numbers;
  write_numbers(table, stored_numbers_file());
  fmt::print("\nwritten: {}\n", stored_numbers_file().string());
  return failed ? 1 : 0;
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
  CLI::Option* const dry_flag = app.add_flag("--dry", dry, "Show, but write nothing");
  app.add_option("--try", overrides,
                 "Instead: would the test notice this change? (scenario key=value, 8 seeds)")
      ->allow_extra_args(false)
      ->excludes(dry_flag);
  CLI11_PARSE(app, argc, argv);
  try {
    if (scenes.empty()) scenes = scene_names();
    return overrides.empty() ? remake(scenes, !dry) : try_change(scenes, overrides);
  } catch (const std::exception& error) {
    fmt::print(stderr, "remake_small_runs: {}\n", error.what());
    return 1;
  }
}
