#include "cli/ensemble/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cli/ensemble/design.h"

namespace scree {
namespace {

class Calibrator {
 public:
  Calibrator(const CalibrationSpec& spec, const Simulator& simulate, int side_by_side)
      : spec_(spec), simulate_(simulate), side_by_side_(side_by_side) {
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
        throw std::runtime_error(
            fmt::format("fewer than 4 simulations gave '{}'; is that a number of this scenario? (scree sweep "
                        "FILE --failed says why runs fail)",
                        spec_.targets[t].output));
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
    while (static_cast<int>(used) < spec_.most_simulations &&
           result_.posterior->excess_uncertainty() > spec_.enough) {
      points.clear();
      for (const Eigen::VectorXd& at : result_.posterior->next_points(
               std::min(side_by_side_, spec_.most_simulations - static_cast<int>(used))))
        points.push_back({at, next_seed()});
      add(points);
      learn();
    }
  }

  const CalibrationSpec& spec_;
  const Simulator& simulate_;
  int side_by_side_;
  std::set<std::filesystem::path> scenarios_;
  CalibrationResult result_;
};

}  // namespace

double parameter_value(const CalibrationSpec& spec, int parameter, double share) {
  const FileReader::Span& span = spec.parameters[static_cast<std::size_t>(parameter)];
  return span.from + share * (span.to - span.from);
}

CalibrationResult calibrate(const CalibrationSpec& spec, const Simulator& simulate, int side_by_side) {
  return Calibrator(spec, simulate, side_by_side).run();
}

}  // namespace scree
