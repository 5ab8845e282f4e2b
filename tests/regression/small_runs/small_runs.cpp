#include "tests/regression/small_runs/small_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <exception>
#include <limits>
#include <map>
#include <numeric>
#include <regex>
#include <stdexcept>
#include <thread>

#include "cli/results_of.h"
#include "scree_version.h"
#include "sim/io/text_file.h"
#include "sim/material/csv_table.h"
#include "sim/material/random.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = SCREE_SOURCE_DIR;
const fs::path kHere = kSource / "tests" / "regression" / "small_runs";
constexpr double kSame = 1e-6;      // relative, of a number that no seed changes
constexpr double kNothing = 1e-12;  // a sum that should be 0
constexpr int kDigits = 7;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Outputs run_once(const Scenario& scenario, std::uint64_t seed) {
  std::optional<FlowRecorder> flow = make_flow_recorder(scenario);
  RunHooks hooks;
  if (flow) hooks.look = [&](const Snapshot& snapshot) { flow->add(snapshot); };
  RunOutcome outcome = run_scenario(scenario, seed, 1, hooks);
  const SeedResult result = analyse(scenario, seed, std::move(outcome), std::move(flow));
  if (!result.failures.empty())
    throw std::runtime_error(fmt::format("{}, seed {}: {}", scenario.title, seed, result.failures.front()));
  return outputs_of(result);
}

// As the table holds it.
double rounded(double value) {
  return std::abs(value) < kNothing ? 0 : std::stod(fmt::format("{:.{}g}", value, kDigits));
}

// Ranks, equal values sharing theirs, less their mean, over their deviation; none if all are equal.
std::vector<double> standard_ranks(const std::vector<double>& values) {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(values.size());
  std::vector<double> ranks;
  double squares = 0;
  for (const double value : values) {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), value);
    const auto rank = static_cast<double>((first - sorted.begin()) + (last - sorted.begin()) - 1) / 2;
    ranks.push_back(rank - (n - 1) / 2);
    squares += ranks.back() * ranks.back();
  }
  if (squares == 0) return {};
  for (double& rank : ranks) rank /= std::sqrt(squares / n);
  return ranks;
}

// Over its own deviation: of `count` of `ranks`, drawn without putting back.
double mean_of_last(const std::vector<double>& ranks, std::size_t count) {
  const auto n = static_cast<double>(ranks.size()), m = static_cast<double>(count);
  const double sum = std::accumulate(ranks.end() - static_cast<std::ptrdiff_t>(count), ranks.end(), 0.0);
  return sum / m / std::sqrt((n - m) / (m * (n - 1)));
}

}  // namespace

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(kHere / "scenes"))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<Outputs> run_scene(const std::string& scene, std::uint64_t first, int count,
                               const std::vector<std::string>& overrides) {
  const ScenarioResult loaded =
      load_scenario(kHere / "scenes" / (scene + ".yaml"), overrides, kSource / "assets");
  if (!loaded.errors.empty()) throw std::invalid_argument(loaded.errors.front().text());
  std::vector<Outputs> runs(static_cast<std::size_t>(count));
  std::array<std::exception_ptr, 2> failed;
  const auto half = [&](std::size_t which) {
    try {
      for (std::size_t k = which; k < runs.size(); k += 2) runs[k] = run_once(loaded.scenario, first + k);
    } catch (...) {
      failed[which] = std::current_exception();
    }
  };
  std::thread other(half, 1);
  half(0);
  other.join();
  for (const std::exception_ptr& each : failed)
    if (each) std::rethrow_exception(each);
  return runs;
}

SceneNumbers numbers_of(const std::vector<Outputs>& runs, double least_share) {
  static const std::regex left_out(
      "particles|dumps|sections|share_above_1m_orig|layer_variance_.*|"
      "(grains|ksat_rel|lateral_chi_range|d[0-9]+_m|d15.*|d60.*|d80.*|d95.*)_(S[0-9].*|top|middle|bottom)");
  SceneNumbers numbers;
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (const auto& [name, value] : runs[k])
      if (!std::regex_match(name, left_out))
        numbers.try_emplace(name, runs.size(), nan).first->second[k] = rounded(value);
  std::erase_if(numbers, [&](const auto& number) {
    const auto there = std::count_if(number.second.begin(), number.second.end(),
                                     [](double value) { return !std::isnan(value); });
    return static_cast<double>(there) < least_share * static_cast<double>(number.second.size());
  });
  return numbers;
}

fs::path stored_numbers_file() {
  return kHere / "small_runs.csv";
}

std::map<std::string, SceneNumbers> read_numbers(const fs::path& file) {
  std::vector<std::string> columns{"scene", "output"};
  for (int seed = 1; seed <= kStoredSeeds; ++seed) columns.push_back(std::to_string(seed));
  std::map<std::string, SceneNumbers> scenes;
  for (CsvTable table(file, columns); table.next();) {
    std::vector<double>& values = scenes[table.text("scene")][table.text("output")];
    if (!values.empty()) table.fail("this number is there already");
    for (int seed = 1; seed <= kStoredSeeds; ++seed)
      values.push_back(table.optional_number(std::to_string(seed)).value_or(nan));
  }
  return scenes;
}

void write_numbers(const std::map<std::string, SceneNumbers>& scenes, const fs::path& file) {
  std::string text = "scene,output";
  for (int seed = 1; seed <= kStoredSeeds; ++seed) text += fmt::format(",{}", seed);
  text += '\n';
  for (const auto& [scene, numbers] : scenes)
    for (const auto& [output, values] : numbers) {
      text += scene + ',' + output;
      for (const double value : values)
        text += std::isnan(value) ? "," : fmt::format(",{:.{}g}", value, kDigits);
      text += '\n';
    }
  write_text_file(file, text);
}

SceneShift shift_of(const SceneNumbers& stored, const SceneNumbers& now) {
  SceneShift shift;
  std::vector<std::vector<double>> ranks;  // of the numbers that vary; the tested runs last
  const std::size_t tested = now.empty() ? 0 : now.begin()->second.size();
  for (const auto& [name, before] : stored) {
    const auto found = now.find(name);
    std::vector<double> after = found == now.end() ? std::vector<double>(tested, nan) : found->second;
    if (found == now.end() &&
        std::none_of(before.begin(), before.end(), [](double v) { return std::isnan(v); }))
      shift.broken.push_back(name + " is not given any more");
    const auto [low, high] = std::minmax_element(before.begin(), before.end());
    if (const double same = *low; same == *high) {
      const auto is_same = [&](double value) { return std::abs(value - same) <= kSame * std::abs(same); };
      if (std::none_of(after.begin(), after.end(), is_same))
        shift.broken.push_back(
            fmt::format("{} is {} in the first run, and was {} in all", name, after.front(), same));
      std::replace_if(after.begin(), after.end(), is_same, same);
    }
    SceneShift::Number moved{name, mean_std(before), mean_std(after), 0};
    std::vector<double> all = before;
    all.insert(all.end(), after.begin(), after.end());
    for (double& value : all)
      if (std::isnan(value)) value = -std::numeric_limits<double>::infinity();
    if (std::vector<double> of_all = standard_ranks(all); !of_all.empty()) {
      moved.z = mean_of_last(of_all, tested);
      ranks.push_back(std::move(of_all));
    }
    shift.numbers.push_back(moved);
  }
  std::stable_sort(shift.numbers.begin(), shift.numbers.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.z) > std::abs(b.z); });
  if (ranks.empty()) return shift;

  std::vector<std::size_t> order(ranks.front().size());
  std::iota(order.begin(), order.end(), 0u);
  struct Distance {
    double squares = 0, largest = 0;
  };
  const auto distance = [&] {
    Distance here;
    for (const std::vector<double>& each : ranks) {
      double sum = 0;
      for (std::size_t k = order.size() - tested; k < order.size(); ++k) sum += each[order[k]];
      here.squares += sum * sum;
      here.largest = std::max(here.largest, std::abs(sum));
    }
    return here;
  };
  constexpr double kRounding = 1 - 1e-12;  // sums of the same ranks in another order
  const Distance here = distance();
  Random draw(1, 0, RandomPurpose::design);
  int squares = 1, largest = 1;
  for (int k = 0; k < kDraws; ++k) {
    for (std::size_t last = order.size() - 1; last >= order.size() - tested; --last)
      std::swap(order[last], order[draw.bits() % (last + 1)]);
    const Distance drawn = distance();
    squares += drawn.squares >= kRounding * here.squares ? 1 : 0;
    largest += drawn.largest >= kRounding * here.largest ? 1 : 0;
  }
  shift.p = std::min(1.0, 2.0 * std::min(squares, largest) / (1 + kDraws));
  return shift;
}

SceneShift shift_of_tested(const std::map<std::string, SceneNumbers>& stored, const std::string& scene,
                           const std::vector<std::string>& overrides) {
  const auto found = stored.find(scene);
  if (found == stored.end()) throw std::invalid_argument(scene + " is not stored");
  return shift_of(found->second, numbers_of(run_scene(scene, kStoredSeeds + 1, kTestedSeeds, overrides)));
}

double together(const std::vector<double>& p) {
  double sum = 0;
  for (const double each : p) sum -= 2 * std::log(each);
  return boost::math::cdf(
      boost::math::complement(boost::math::chi_squared(2 * static_cast<double>(p.size())), sum));
}

}  // namespace scree
