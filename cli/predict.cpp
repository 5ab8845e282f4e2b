// scree predict: what a sweep's scenario would give at other values, from its finished runs alone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "analysis/statistics/convex_hull.h"
#include "analysis/statistics/emulator.h"
#include "cli/commands.h"
#include "cli/ensemble/output_scope.h"
#include "cli/ensemble/sweep_results.h"
#include "cli/ensemble_console.h"
#include "cli/option_values.h"

namespace {

struct Axis {
  double low = INFINITY, high = -INFINITY;
  double share(double value) const { return high > low ? (value - low) / (high - low) : 0.0; }
  double value(double share) const { return low + share * (high - low); }
};

constexpr double kOutside = 1e-4;  // of the ranges: beyond what rounding does to a point on the edge
constexpr double kBeside = 0.5;  // of the way from one run to the next: so far beside them it is extrapolated

int refuse(const std::string& message) {
  fmt::print(stderr, "{}\n", message);
  return kBadInput;
}

// Largest distance from a point to the nearest other one; rows are points.
double widest_gap(const Eigen::MatrixXd& x) {
  double widest = 0;
  for (Eigen::Index a = 0; a < x.rows(); ++a) {
    double nearest = std::numeric_limits<double>::infinity();
    for (Eigen::Index b = 0; b < x.rows(); ++b)
      if (const double distance = (x.row(a) - x.row(b)).norm(); distance > 0)
        nearest = std::min(nearest, distance);
    if (std::isfinite(nearest)) widest = std::max(widest, nearest);
  }
  return widest;
}

}  // namespace

int run_predict(const PredictOptions& options) {
  if (!is_of_kind(options.file, scree::FileKind::sweep)) return kBadInput;
  const scree::SweepResult loaded = scree::load_sweep(options.file, asset_dir());
  if (!nothing_wrong(loaded.errors)) return kBadInput;
  const scree::Sweep& sweep = loaded.sweep;
  const std::string output = options.output.empty() ? "angle_deg" : options.output;

  if (const std::string why = scree::why_not_given(sweep, output); !why.empty())
    return refuse(fmt::format("--output {}: {}", output, why));
  if (std::ssize(sweep.parameters) > scree::Emulator::kMostDimensions)
    return refuse(fmt::format("{} parameters; {} are the most for a prediction", sweep.parameters.size(),
                              scree::Emulator::kMostDimensions));

  std::vector<Axis> axes(sweep.parameters.size());
  std::vector<std::vector<double>> at;
  std::vector<double> values;
  std::vector<scree::PointResults> points;
  if (options.from.empty()) {
    const auto store = open_store(options.store, StoreUse::look);
    if (!store) return kBadInput;
    points = scree::look_up(sweep, scree::requests_of(sweep, asset_dir()), *store);
  } else {
    try {
      points = scree::read_sweep_csv(sweep, options.from);
    } catch (const std::runtime_error& error) {
      return refuse(error.what());
    }
  }
  for (const scree::PointResults& results : points) {
    const scree::SweepPoint& point = *results.point;
    std::vector<double> numbers;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const auto number = number_of(point.values[k]);
      if (!number)
        return refuse(fmt::format("{}: '{}' is no number; only numbers can be predicted between",
                                  sweep.parameters[k], point.values[k]));
      numbers.push_back(*number);
    }
    for (const scree::Outputs& seed : scree::finished(results).seeds) {
      if (!seed.contains(output)) continue;
      at.push_back(numbers);
      values.push_back(seed.at(output));
      for (std::size_t k = 0; k < axes.size(); ++k) {
        axes[k].low = std::min(axes[k].low, numbers[k]);
        axes[k].high = std::max(axes[k].high, numbers[k]);
      }
    }
  }
  if (values.size() < 4)
    return refuse(fmt::format("there are {} runs of this sweep with '{}', 4 are needed; run: scree sweep {}",
                              values.size(), output, options.file.string()));

  if (std::ssize(values) > scree::Emulator::kMostPoints)
    return refuse(fmt::format("there are {} runs of this sweep; {} are the most for a prediction",
                              values.size(), scree::Emulator::kMostPoints));

  std::map<std::string, double> asked;
  for (const std::string& text : options.values) {
    const auto equals = text.find('=');
    const auto number = equals == std::string::npos ? std::nullopt : number_of(text.substr(equals + 1));
    if (!number) return refuse(fmt::format("'{}': write it as material.mu=0.25", text));
    const std::string name = text.substr(0, equals);
    if (std::find(sweep.parameters.begin(), sweep.parameters.end(), name) == sweep.parameters.end())
      return refuse(fmt::format("{}: is no parameter of this sweep; there are {}", name,
                                fmt::join(sweep.parameters, ", ")));
    if (!asked.emplace(text.substr(0, equals), *number).second)
      return refuse(fmt::format("{} is given twice", text.substr(0, equals)));
  }
  Eigen::VectorXd point(static_cast<Eigen::Index>(axes.size()));
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const std::string& name = sweep.parameters[k];
    if (!asked.contains(name))
      return refuse(
          fmt::format("a value of {} is needed (between {} and {})", name, axes[k].low, axes[k].high));
    const double value = asked.at(name);
    if (!(value >= axes[k].low && value <= axes[k].high))
      return refuse(fmt::format("{}={} is outside of what was simulated, {} to {}", name, value, axes[k].low,
                                axes[k].high));
    point[static_cast<Eigen::Index>(k)] = axes[k].share(value);
  }

  Eigen::MatrixXd x(static_cast<Eigen::Index>(values.size()), static_cast<Eigen::Index>(axes.size()));
  for (std::size_t r = 0; r < values.size(); ++r)
    for (std::size_t k = 0; k < axes.size(); ++k)
      x(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(k)) = axes[k].share(at[r][k]);
  // Within the ranges of all parameters there may be no runs around it: beside points along a diagonal, say.
  const Eigen::VectorXd inside = scree::nearest_in_hull(x, point);
  const double outside = (inside - point).norm();
  if (outside > kOutside + kBeside * widest_gap(x)) {
    std::vector<std::string> nearest;
    for (std::size_t k = 0; k < axes.size(); ++k)
      nearest.push_back(
          fmt::format("{}={:.6g}", sweep.parameters[k], axes[k].value(inside[static_cast<Eigen::Index>(k)])));
    return refuse(fmt::format("{}: lies outside of what was simulated; the nearest within it: {}",
                              fmt::join(options.values, " "), fmt::join(nearest, " ")));
  }
  const scree::Emulator emulator(
      x, Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  const scree::Prediction p = emulator.at(point);
  const double one = scree::kDeviations90 * std::hypot(p.std, p.noise), mean = scree::kDeviations90 * p.std;
  fmt::print("{} = {:.4g}\n", output, p.mean);
  fmt::print("90 % interval of the mean over seeds: {:.4g} to {:.4g}\n", p.mean - mean, p.mean + mean);
  fmt::print("90 % interval of one seed:            {:.4g} to {:.4g}\n", p.mean - one, p.mean + one);
  fmt::print("from {} runs\n", values.size());
  if (outside > kOutside)
    fmt::print("note: no runs lie all around this point, as in a corner: it is extrapolated\n");
  return kOk;
}
