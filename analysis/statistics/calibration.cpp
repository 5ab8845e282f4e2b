#include "analysis/statistics/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace scree {
namespace {
constexpr int kSides[] = {401, 61, 21};  // nodes along an axis in 1, 2, 3 dimensions
constexpr int kLines = 100;              // along an axis, on which a level is looked for
constexpr double kReach = 0.1;           // of an axis: how far one more simulation teaches something
}  // namespace

Posterior::Posterior(const std::vector<CalibrationTarget>& targets, int dimensions)
    : dimensions_(dimensions), targets_(targets.size()) {
  if (dimensions < 1 || dimensions > 3 || targets.empty())
    throw std::invalid_argument("a posterior has 1 to 3 parameters and a target");
  side_ = kSides[dimensions - 1];
  std::size_t nodes = 1;
  for (int k = 0; k < dimensions; ++k) nodes *= static_cast<std::size_t>(side_);
  for (const CalibrationTarget& t : targets) uncertainty_.push_back(t.uncertainty);
  density_.resize(nodes);
  predictions_.resize(nodes * targets_);
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t node = 0; node < nodes; ++node) {
    double log_likelihood = 0;
    for (std::size_t t = 0; t < targets_; ++t) {
      const Prediction p = targets[t].emulator->at(point(node));
      predictions_[node * targets_ + t] = p;
      const double variance = targets[t].uncertainty * targets[t].uncertainty + p.std * p.std;
      const double off = p.mean - targets[t].value;
      log_likelihood -= 0.5 * (off * off / variance + std::log(variance));
    }
    density_[node] = log_likelihood;
    best = std::max(best, log_likelihood);
  }
  double sum = 0;
  for (double& value : density_) sum += value = std::exp(value - best);
  for (double& value : density_) value /= sum;
}

Eigen::VectorXd Posterior::point(std::size_t node) const {
  Eigen::VectorXd x(dimensions_);
  for (int k = 0; k < dimensions_; ++k) {
    x[k] = static_cast<double>(node % static_cast<std::size_t>(side_)) / (side_ - 1);
    node /= static_cast<std::size_t>(side_);
  }
  return x;
}

Eigen::VectorXd Posterior::mean() const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(dimensions_);
  for (std::size_t node = 0; node < size(); ++node) sum += density_[node] * point(node);
  return sum;
}

Eigen::VectorXd Posterior::most_likely() const {
  return point(
      static_cast<std::size_t>(std::max_element(density_.begin(), density_.end()) - density_.begin()));
}

std::vector<double> Posterior::marginal(int dimension) const {
  std::vector<double> marginal(static_cast<std::size_t>(side_), 0.0);
  for (std::size_t node = 0; node < size(); ++node) {
    std::size_t at = node;
    for (int k = 0; k < dimension; ++k) at /= static_cast<std::size_t>(side_);
    marginal[at % static_cast<std::size_t>(side_)] += density_[node];
  }
  return marginal;
}

bool Posterior::cut_off(int dimension) const {
  const std::vector<double> p = marginal(dimension);
  return std::max(p.front(), p.back()) > *std::max_element(p.begin(), p.end()) / 7;
}

std::array<double, 2> Posterior::interval(int dimension, double share) const {
  const std::vector<double> marginal = this->marginal(dimension);
  // Each node stands for a cell about it; the quantile is linear within a cell.
  const auto quantile = [&](double q) {
    double below = 0;
    for (std::size_t k = 0; k < marginal.size(); ++k) {
      if (below + marginal[k] >= q && marginal[k] > 0) {
        const double x = (static_cast<double>(k) - 0.5 + (q - below) / marginal[k]) / (side_ - 1);
        return std::clamp(x, 0.0, 1.0);
      }
      below += marginal[k];
    }
    return 1.0;
  };
  return {quantile(0.5 * (1 - share)), quantile(0.5 * (1 + share))};
}

double Posterior::excess_uncertainty() const {
  double worst = 0;
  for (std::size_t t = 0; t < targets_; ++t) {
    double ratio = 0;
    for (std::size_t node = 0; node < size(); ++node) {
      const double std = prediction(node, t).std;
      ratio += density_[node] * std * std / (uncertainty_[t] * uncertainty_[t]);
    }
    worst = std::max(worst, std::sqrt(1 + ratio) - 1);
  }
  return worst;
}

std::vector<Eigen::VectorXd> Posterior::next_points(int count) const {
  std::vector<double> gain(size(), 0.0);
  for (std::size_t node = 0; node < size(); ++node) {
    for (std::size_t t = 0; t < targets_; ++t) {
      const double std = prediction(node, t).std;
      gain[node] += std * std / (uncertainty_[t] * uncertainty_[t]);
    }
    gain[node] *= density_[node];
  }
  std::vector<Eigen::VectorXd> points;
  while (static_cast<int>(points.size()) < count) {
    const Eigen::VectorXd next =
        point(static_cast<std::size_t>(std::max_element(gain.begin(), gain.end()) - gain.begin()));
    // What is learnt there is known nearby, too.
    for (std::size_t node = 0; node < size(); ++node)
      gain[node] *= 1 - std::exp(-0.5 * (point(node) - next).squaredNorm() / (kReach * kReach));
    points.push_back(next);
  }
  return points;
}

double crossing(const std::vector<double>& x, const std::vector<double>& value, double level) {
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    const double a = value[k] - level, b = value[k + 1] - level;
    if (!std::isfinite(a) || !std::isfinite(b) || a * b > 0 || a == b) continue;
    return x[k] + a / (a - b) * (x[k + 1] - x[k]);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double ParameterMap::at(double px, double py) const {
  const auto cell = [](const std::vector<double>& axis, double v) {
    const auto above = std::upper_bound(axis.begin(), axis.end() - 1, v) - axis.begin();
    return static_cast<std::size_t>(std::max<std::ptrdiff_t>(above - 1, 0));
  };
  const std::size_t i = cell(x, px), j = cell(y, py);
  const double s = (px - x[i]) / (x[i + 1] - x[i]), t = (py - y[j]) / (y[j + 1] - y[j]);
  return (1 - t) * ((1 - s) * value[j][i] + s * value[j][i + 1]) +
         t * ((1 - s) * value[j + 1][i] + s * value[j + 1][i + 1]);
}

std::vector<std::array<double, 2>> level_pairs(const ParameterMap& map, double level) {
  std::vector<std::array<double, 2>> pairs;
  const auto along = [](const std::vector<double>& axis, int k) {
    return axis.front() + (axis.back() - axis.front()) * k / kLines;
  };
  for (const bool across : {false, true})
    for (int line = 0; line <= kLines; ++line) {
      const double fixed = along(across ? map.y : map.x, line);
      const auto value = [&](double moving) {
        return (across ? map.at(moving, fixed) : map.at(fixed, moving)) - level;
      };
      const std::vector<double>& axis = across ? map.x : map.y;
      for (int k = 0; k < kLines; ++k) {
        const double from = along(axis, k), to = along(axis, k + 1), a = value(from), b = value(to);
        if (!std::isfinite(a) || !std::isfinite(b) || a == b || a * b > 0) continue;
        const double moving = from + a / (a - b) * (to - from);
        pairs.push_back(across ? std::array{moving, fixed} : std::array{fixed, moving});
      }
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

double level_where_equal(const ParameterMap& map, double level) {
  const double from = std::max(map.x.front(), map.y.front()), to = std::min(map.x.back(), map.y.back());
  if (!(from < to)) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> at, value;
  for (int k = 0; k <= kLines; ++k) {
    at.push_back(from + (to - from) * k / kLines);
    value.push_back(map.at(at.back(), at.back()));
  }
  return crossing(at, value, level);
}

}  // namespace scree
