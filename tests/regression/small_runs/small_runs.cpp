#include "tests/regression/small_runs/small_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <charconv>
#include <cmath>
#include <exception>
#include <fstream>
#include <map>
#include <numeric>
#include <random>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "cli/results_of.h"
#include "scree_version.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = SCREE_SOURCE_DIR;
const fs::path kHere = kSource / "tests" / "regression" / "small_runs";
constexpr double kSame = 1e-6;      // relative, of a number that no seed changes
constexpr double kNothing = 1e-12;  // a sum that should be 0
constexpr int kDigits = 7;
constexpr int kDraws = 9999;

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

double number(const std::string& text) {
  double value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::invalid_argument("not a number: " + text);
  return value;
}

// As the table holds it.
double rounded(double value) {
  return std::abs(value) < kNothing ? 0 : number(fmt::format("{:.{}g}", value, kDigits));
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

SceneNumbers numbers_of(const std::vector<Outputs>& runs) {
  static const std::regex left_out(
      "largest_overlap_ratio|lost_mass_t|runaways|dumps|sections|layer_variance_.*|"
      "(grains|ksat_rel|lateral_chi_range|d[0-9]+_m|d15.*|d60.*|d80.*|d95.*)_(S[0-9].*|top|middle|bottom)");
  SceneNumbers numbers;
  for (const auto& [name, value] : runs.front()) {
    if (std::regex_match(name, left_out)) continue;
    std::vector<double> values;
    for (const Outputs& run : runs)
      if (const auto found = run.find(name); found != run.end()) values.push_back(rounded(found->second));
    if (values.size() == runs.size()) numbers[name] = values;
  }
  return numbers;
}

fs::path stored_numbers_file() {
  return kHere / "small_runs.csv";
}

std::map<std::string, SceneNumbers> read_numbers(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line) || !line.starts_with("scene,output,1,"))
    throw std::runtime_error(
        fmt::format("{}:1: the first line does not begin with scene,output,1", file.string()));
  std::map<std::string, SceneNumbers> scenes;
  for (int row = 2; std::getline(stream, line); ++row) {
    std::istringstream fields(line);
    std::string scene, output, field;
    std::getline(fields, scene, ',');
    std::getline(fields, output, ',');
    std::vector<double>& values = scenes[scene][output];
    try {
      while (std::getline(fields, field, ',')) values.push_back(number(field));
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(fmt::format("{}:{}: {}", file.string(), row, error.what()));
    }
    if (values.size() != kStoredSeeds)
      throw std::runtime_error(
          fmt::format("{}:{}: {} values instead of {}", file.string(), row, values.size(), kStoredSeeds));
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
      for (const double value : values) text += fmt::format(",{:.{}g}", value, kDigits);
      text += '\n';
    }
  write_text_file(file, text);
}

SceneShift shift_of(const SceneNumbers& stored, const std::vector<Outputs>& runs) {
  SceneShift shift;
  std::vector<std::vector<double>> ranks;  // of the numbers that vary, standardised; the tested runs last
  for (const auto& [name, before] : stored) {
    SceneShift::Number moved{name, mean_std(before), {}, 0};
    std::vector<double> now;
    for (const Outputs& run : runs)
      if (const auto found = run.find(name); found != run.end()) now.push_back(rounded(found->second));
    if (now.empty()) {
      shift.broken.push_back(name + " is not given any more");
      continue;
    }
    moved.now = mean_std(now);
    const auto [low, high] = std::minmax_element(before.begin(), before.end());
    const double same = *low, allowed = kSame * std::abs(same);
    if (*low == *high &&
        std::none_of(now.begin(), now.end(), [&](double value) { return std::abs(value - same) <= allowed; }))
      shift.broken.push_back(fmt::format("{} is {} to {}, and was {} with every seed", name,
                                         *std::min_element(now.begin(), now.end()),
                                         *std::max_element(now.begin(), now.end()), same));
    if (now.size() == runs.size()) {
      std::vector<double> all = before;
      all.insert(all.end(), now.begin(), now.end());
      if (std::vector<double> of_all = standard_ranks(all); !of_all.empty()) {
        moved.z = mean_of_last(of_all, now.size());
        ranks.push_back(std::move(of_all));
      }
    }
    shift.numbers.push_back(moved);
  }
  std::stable_sort(shift.numbers.begin(), shift.numbers.end(),
                   [](const auto& a, const auto& b) { return std::abs(a.z) > std::abs(b.z); });
  if (ranks.empty()) return shift;

  std::vector<std::size_t> order(ranks.front().size());
  std::iota(order.begin(), order.end(), 0u);
  const std::size_t count = runs.size();
  const auto squares = [&] {
    double sum = 0;
    for (const std::vector<double>& each : ranks) {
      double mean = 0;
      for (std::size_t k = order.size() - count; k < order.size(); ++k) mean += each[order[k]];
      sum += mean * mean;
    }
    return sum;
  };
  const double here = squares();
  std::mt19937_64 draw(1);
  int as_far = 1;
  for (int k = 0; k < kDraws; ++k) {
    for (std::size_t last = order.size() - 1; last >= order.size() - count; --last)
      std::swap(order[last], order[draw() % (last + 1)]);
    if (squares() >= here) ++as_far;
  }
  shift.p = static_cast<double>(as_far) / (1 + kDraws);
  return shift;
}

double together(const std::vector<double>& p) {
  double sum = 0;
  for (const double each : p) sum -= 2 * std::log(each);
  return boost::math::cdf(
      boost::math::complement(boost::math::chi_squared(2 * static_cast<double>(p.size())), sum));
}

}  // namespace scree
