#include "cli/ensemble/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cli/ensemble/design.h"
#include "cli/ensemble/output_scope.h"

namespace scree {
namespace {

class Calibrator {
 public:
  Calibrator(const CalibrationSpec& spec, const Simulator& simulate) : spec_(spec), simulate_(simulate) {
    for (const auto& target : spec.targets) scenarios_.insert(target.scenario);
  }

  CalibrationResult run() {
    if (spec_.method == CalibrationSpec::Method::grid)
      on_a_grid();
    else
      by_what_helps();
    return std::move(result_);
  }

 private:
  int dimensions() const { return static_cast<int>(spec_.parameters.size()); }

  // Simulates points, each with its seed, in every scenario.
  void add(const std::vector<std::pair<Eigen::VectorXd, std::uint64_t>>& points) {
    std::vector<CalibrationRun> runs;
    for (const auto& [at, seed] : points)
      for (const auto& scenario : scenarios_) runs.push_back({scenario, at, seed});
    const std::vector<std::vector<double>> values = simulate_(runs);
    result_.runs.insert(result_.runs.end(), runs.begin(), runs.end());
    result_.values.insert(result_.values.end(), values.begin(), values.end());
  }

  void learn() {
    result_.emulators.clear();
    std::vector<CalibrationTarget> targets;
    for (std::size_t t = 0; t < spec_.targets.size(); ++t) {
      std::vector<std::size_t> known;
      for (std::size_t k = 0; k < result_.runs.size(); ++k)
        if (std::isfinite(result_.values[k][t])) known.push_back(k);
      if (known.size() < 4)
        throw std::runtime_error(fmt::format("fewer than 4 simulations gave '{}'", spec_.targets[t].output));
      Eigen::MatrixXd x(static_cast<Eigen::Index>(known.size()), dimensions());
      Eigen::VectorXd y(static_cast<Eigen::Index>(known.size()));
      for (std::size_t k = 0; k < known.size(); ++k) {
        x.row(static_cast<Eigen::Index>(k)) = result_.runs[known[k]].at;
        y[static_cast<Eigen::Index>(k)] = result_.values[known[k]][t];
      }
      result_.emulators.push_back(std::make_shared<Emulator>(x, y));
      targets.push_back(
          {spec_.targets[t].value, spec_.targets[t].uncertainty, result_.emulators.back().get()});
    }
    result_.posterior = std::make_shared<Posterior>(targets, dimensions());
  }

  void on_a_grid() {
    const int side = spec_.grid_points;
    std::size_t nodes = 1;
    for (int k = 0; k < dimensions(); ++k) nodes *= static_cast<std::size_t>(side);
    std::vector<std::pair<Eigen::VectorXd, std::uint64_t>> points;
    for (std::size_t node = 0; node < nodes; ++node) {
      Eigen::VectorXd at(dimensions());
      std::size_t rest = node;
      for (int k = 0; k < dimensions(); ++k) {
        at[k] = static_cast<double>(rest % static_cast<std::size_t>(side)) / (side - 1);
        rest /= static_cast<std::size_t>(side);
      }
      for (const std::uint64_t seed : spec_.seeds) points.push_back({at, seed});
    }
    add(points);
    const std::size_t runs_of_node = spec_.seeds.size() * scenarios_.size();
    for (std::size_t t = 0; t < spec_.targets.size(); ++t) {
      result_.grid.emplace_back();
      for (std::size_t node = 0; node < nodes; ++node) {
        double sum = 0;
        int count = 0;
        for (std::size_t k = node * runs_of_node; k < (node + 1) * runs_of_node; ++k)
          if (std::isfinite(result_.values[k][t])) sum += result_.values[k][t], ++count;
        result_.grid.back().push_back(sum / count);
      }
    }
    learn();
  }

  void by_what_helps() {
    std::size_t used = 0;
    // Those of the file first, then the integers that follow: no simulation is done, or counted, twice.
    const std::uint64_t last = *std::max_element(spec_.seeds.begin(), spec_.seeds.end());
    const auto next_seed = [&] {
      const std::size_t k = used++;
      return k < spec_.seeds.size() ? spec_.seeds[k] : last + 1 + (k - spec_.seeds.size());
    };
    std::vector<std::pair<Eigen::VectorXd, std::uint64_t>> points;
    for (const auto& unit : sobol(spec_.first_points, dimensions()))
      points.push_back({Eigen::Map<const Eigen::VectorXd>(unit.data(), dimensions()), next_seed()});
    add(points);
    learn();
    const int each = static_cast<int>(scenarios_.size()), most = spec_.most_simulations / each;  // points
    while (static_cast<int>(used) < most && result_.posterior->excess_uncertainty() > spec_.enough) {
      points.clear();
      for (const Eigen::VectorXd& at :
           result_.posterior->next_points(std::min(spec_.together, most - static_cast<int>(used))))
        points.push_back({at, next_seed()});
      add(points);
      learn();
    }
  }

  const CalibrationSpec& spec_;
  const Simulator& simulate_;
  std::set<std::filesystem::path> scenarios_;
  CalibrationResult result_;
};

}  // namespace

namespace {

constexpr double kShare = 0.9;  // of the probability that an interval holds

ParameterMap map_of(const CalibrationSpec& spec, const CalibrationResult& result) {
  ParameterMap map;
  const bool grid = !result.grid.empty();
  const int side = grid ? spec.grid_points : result.posterior->side();
  for (int k = 0; k < side; ++k) {
    const double share = static_cast<double>(k) / (side - 1);
    map.x.push_back(parameter_value(spec, 0, share));
    map.y.push_back(parameter_value(spec, 1, share));
  }
  for (int j = 0; j < side; ++j) {
    map.value.emplace_back();
    for (int i = 0; i < side; ++i) {
      const auto node = static_cast<std::size_t>(j * side + i);
      map.value.back().push_back(grid ? result.grid[0][node] : result.posterior->prediction(node, 0).mean);
    }
  }
  return map;
}

// Of the probability on the line on which both parameters are equal; none if that line misses the nodes.
std::optional<std::array<double, 2>> interval_where_equal(const CalibrationSpec& spec,
                                                          const Posterior& posterior) {
  const auto &a = spec.parameters[0], &b = spec.parameters[1];
  std::vector<std::pair<double, double>> along;  // value, density
  double sum = 0;
  for (std::size_t node = 0; node < posterior.size(); ++node) {
    const Eigen::VectorXd at = posterior.point(node);
    const double off = (a.from + at[0] * (a.to - a.from)) - (b.from + at[1] * (b.to - b.from));
    if (std::abs(off) > 1e-9 * (a.to - a.from)) continue;
    along.emplace_back(a.from + at[0] * (a.to - a.from), posterior.density(node));
    sum += posterior.density(node);
  }
  if (along.size() < 5 || !(sum > 0)) return std::nullopt;
  std::sort(along.begin(), along.end());
  std::array<double, 2> ends{along.front().first, along.back().first};
  double below = 0;
  for (const auto& [at, density] : along) {
    if (below < 0.5 * (1 - kShare) * sum) ends[0] = at;
    if (below < 0.5 * (1 + kShare) * sum) ends[1] = at;
    below += density;
  }
  return ends;
}

bool are_mu_and_mu_r(const std::vector<FileReader::Span>& parameters) {
  return parameters.size() == 2 && parameters[0].key != parameters[1].key &&
         std::all_of(parameters.begin(), parameters.end(), [](const FileReader::Span& p) {
           return p.key == "material.mu" || p.key == "material.mu_r";
         });
}

}  // namespace

CalibrationAnswer answer_of(const CalibrationSpec& spec, const CalibrationResult& result) {
  CalibrationAnswer answer;
  const Posterior& posterior = *result.posterior;
  const auto dimensions = static_cast<int>(spec.parameters.size());
  const double level = spec.targets[0].value;
  const bool one_target = spec.targets.size() == 1;  // else what gives the first alone is no answer
  const auto found = [](double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; };
  if (dimensions == 1 && one_target && !result.grid.empty()) {
    std::vector<double> x;
    for (int k = 0; k < spec.grid_points; ++k)
      x.push_back(parameter_value(spec, 0, static_cast<double>(k) / (spec.grid_points - 1)));
    answer.interpolated = found(crossing(x, result.grid[0], level));
  }
  if (dimensions == 2) {
    answer.map = map_of(spec, result);
    answer.line = level_pairs(*answer.map, level);
    if (one_target && are_mu_and_mu_r(spec.parameters))
      answer.equal = found(level_where_equal(*answer.map, level));
    if (answer.equal) answer.equal_interval = interval_where_equal(spec, posterior);
  }
  // Of three parameters some are often not determined: their most likely value would be any.
  Eigen::VectorXd at = dimensions == 2 ? posterior.most_likely() : posterior.mean();
  if (answer.interpolated) {
    const FileReader::Span& span = spec.parameters[0];
    at[0] = (*answer.interpolated - span.from) / (span.to - span.from);
  }
  if (answer.equal)
    for (int k = 0; k < dimensions; ++k) {
      const FileReader::Span& span = spec.parameters[static_cast<std::size_t>(k)];
      at[k] = (*answer.equal - span.from) / (span.to - span.from);
    }
  for (int k = 0; k < dimensions; ++k) {
    answer.value.push_back(parameter_value(spec, k, at[k]));
    const auto [low, high] = posterior.interval(k, kShare);
    answer.interval.push_back({parameter_value(spec, k, low), parameter_value(spec, k, high)});
    answer.cut_off.push_back(posterior.cut_off(k));
  }
  for (std::size_t t = 0; t < spec.targets.size(); ++t) {
    answer.at_value.push_back(result.emulators[t]->at(at));
    const Prediction& p = answer.at_value.back();
    answer.missed_by.push_back((p.mean - spec.targets[t].value) /
                               std::hypot(p.std, spec.targets[t].uncertainty));
  }
  return answer;
}

double parameter_value(const CalibrationSpec& spec, int parameter, double share) {
  const FileReader::Span& span = spec.parameters[static_cast<std::size_t>(parameter)];
  return span.from + share * (span.to - span.from);
}

std::vector<std::string> names_of(const CalibrationSpec& spec) {
  std::vector<std::string> names;
  for (const auto& span : spec.parameters) names.push_back(span.key);
  return names;
}

std::vector<double> values_at(const CalibrationSpec& spec, const Eigen::VectorXd& shares) {
  std::vector<double> values;
  for (int k = 0; k < shares.size(); ++k) values.push_back(parameter_value(spec, k, shares[k]));
  return values;
}

ScenarioResult calibrated_scenario(const CalibrationSpec& spec, const std::filesystem::path& scenario,
                                   const std::vector<double>& values,
                                   const std::filesystem::path& asset_dir) {
  std::vector<std::string> texts;
  for (const double value : values) texts.push_back(fmt::format("{:.6g}", value));
  return load_scenario(scenario, overrides_of(spec.variation, names_of(spec), texts), asset_dir,
                       ReadFor::numbers);
}

std::string why_not_run(const CalibrationSpec& spec, const std::filesystem::path& asset_dir) {
  for (const auto& target : spec.targets) {
    for (const double share : {0.0, 1.0}) {
      const Eigen::VectorXd end =
          Eigen::VectorXd::Constant(static_cast<Eigen::Index>(spec.parameters.size()), share);
      const ScenarioResult loaded =
          calibrated_scenario(spec, target.scenario, values_at(spec, end), asset_dir);
      if (!loaded.errors.empty()) return loaded.errors.front().text();
      if (const std::string why = why_not_given(loaded.scenario, target.output); !why.empty())
        return fmt::format("output '{}': {}", target.output, why);
    }
  }
  return {};
}

CalibrationResult calibrate(const CalibrationSpec& spec, const Simulator& simulate) {
  return Calibrator(spec, simulate).run();
}

}  // namespace scree
