#pragma once
// A world whose truth is a formula: what simulations of it would give, and measurements of it.
#include <array>
#include <cmath>
#include <numbers>

#include "analysis/diagnose/diagnosis.h"
#include "sim/material/random.h"

namespace scree {

/// Two experiments, two base parameters, four effects; each output is a smooth function of them plus noise
/// that is correlated within an experiment.
class SyntheticWorld {
 public:
  static constexpr int kEffects = 4;

  SyntheticWorld() {
    space.base = {{"a", 0.2, 0.1, 0.3}, {"b", 0.5, 0.2, 0.8}};
    for (int e = 0; e < kEffects; ++e) {
      const std::string name = "effect" + std::to_string(e);
      space.effects.push_back(
          {name, name, 0, {{"effects." + name + ".size", "", e == 3 ? -1.0 : 0.0, 1}}, {"one", "two"}});
    }
    space.effects[2].acts = {"two"};
  }

  ModelSpace space;
  std::vector<std::string> experiments{"one", "two"};
  static int numbers(int experiment) { return experiment == 0 ? 6 : 5; }

  /// Mean of an output: base parameters move all of them, an effect with a pattern of its own, not linearly.
  double mean(int experiment, int output, const ModelPoint& at) const {
    const double k = output + 10 * experiment;
    double y = 3 * std::sin(k) * at.base[0] + 2.5 * std::cos(1.7 * k) * at.base[1] +
               0.6 * std::sin(3 * k) * at.base[0] * at.base[1];
    for (const EffectAt& effect : at.effects) {
      const int e = std::stoi(space.effects[effect.effect].name.substr(6));
      if (!space.effects[effect.effect].acts_in(experiments[static_cast<std::size_t>(experiment)])) continue;
      const double x = effect.amplitude();
      Random pattern(static_cast<std::uint64_t>(100 * e + 10 * experiment + output), 7,
                     RandomPurpose::design);
      y += 9 * pattern.uniform(-1, 1) * (x + 0.4 * x * x) * (1 + 0.2 * at.base[1]);
    }
    return y;
  }

  Eigen::VectorXd run(int experiment, const ModelPoint& at, Random& random) const {
    Eigen::VectorXd y(numbers(experiment));
    const double common = normal(random);
    for (int c = 0; c < y.size(); ++c) y[c] = mean(experiment, c, at) + 0.6 * common + 0.8 * normal(random);
    return y;
  }

  DesignRuns design(std::uint64_t seed) const {
    Random random(seed, 0, RandomPurpose::design);
    DesignRuns runs(2);
    const auto add = [&](const ModelPoint& at) {
      for (int x = 0; x < 2; ++x) runs[static_cast<std::size_t>(x)].push_back({at, run(x, at, random)});
    };
    for (int k = 0; k < 6; ++k) add({space.nominal(), {}});
    const auto base = [&] {
      return Eigen::VectorXd(Eigen::Vector2d(random.uniform(-1, 1), random.uniform(-1, 1)));
    };
    for (int k = 0; k < 24; ++k) add({base(), {}});
    for (std::size_t e = 0; e < space.effects.size(); ++e)
      for (int k = 0; k < 10; ++k) {
        const double low = space.effects[e].lowest();
        const double x = low + (1 - low) * (k + 1) / 10.0;
        if (x != 0) add({base(), {{e, Eigen::VectorXd::Constant(1, x)}}});
      }
    return runs;
  }

  /// Means of `repeats` with their deviations.
  Measurements measure(const ModelPoint& truth, int repeats, std::uint64_t seed) const {
    return measure(truth, {repeats, repeats}, seed, false);
  }
  /// The same with so many repeats of each experiment; `correlated`: with the covariance of their means.
  Measurements measure(const ModelPoint& truth, const std::array<int, 2>& repeats_of, std::uint64_t seed,
                       bool correlated) const {
    Random random(seed, 1, RandomPurpose::measurement);
    Measurements measured;
    measured.experiments = experiments;
    measured.covariance = Eigen::MatrixXd::Zero(numbers(0) + numbers(1), numbers(0) + numbers(1));
    for (int x = 0; x < 2; ++x) {
      const int repeats = repeats_of[static_cast<std::size_t>(x)];
      Eigen::MatrixXd y(repeats, numbers(x));
      for (int r = 0; r < repeats; ++r) y.row(r) = run(x, truth, random).transpose();
      const Eigen::RowVectorXd mean = y.colwise().mean();
      const Eigen::MatrixXd off = y.rowwise() - mean;
      const Eigen::MatrixXd of_means = off.transpose() * off / (repeats - 1) / repeats;
      const Eigen::RowVectorXd std = (repeats * of_means.diagonal()).cwiseSqrt();
      auto block = measured.covariance.block(x * numbers(0), x * numbers(0), numbers(x), numbers(x));
      block = of_means;
      if (!correlated) block = Eigen::MatrixXd(of_means.diagonal().asDiagonal());
      for (int c = 0; c < numbers(x); ++c) {
        const std::string name = "chi_S" + std::to_string(c + 1);
        measured.values.push_back({static_cast<std::size_t>(x), name,
                                   experiments[static_cast<std::size_t>(x)] + "/" + name, mean[c],
                                   std[c] / std::sqrt(repeats), std[c], repeats});
      }
    }
    return measured;
  }

  static ModelPoint point(double a, double b, std::vector<std::pair<std::size_t, double>> effects = {}) {
    ModelPoint at{Eigen::Vector2d(a, b), {}};
    for (const auto& [e, x] : effects) at.effects.push_back({e, Eigen::VectorXd::Constant(1, x)});
    return at;
  }

 private:
  static double normal(Random& random) {
    return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * std::numbers::pi * random.uniform());
  }
};

}  // namespace scree
