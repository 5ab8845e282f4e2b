// Calibrations of rock that is known: the printed angles of table B.2, linear between them, with the scatter
// of seeds, stand in for simulations.
#include "cli/ensemble/calibrate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "analysis/results/results.h"
#include "scree_version.h"

namespace scree {
namespace {

constexpr double kScatter = 1.3;      // degrees between seeds, thesis setups: angle_simulated_std_mean
constexpr double kUncertainty = 1.0;  // of a measured angle, degrees
const std::vector<double> kFriction{0.1, 0.2, 0.3, 0.4};

ParameterMap printed_angles() {
  const auto reference =
      read_reference(std::filesystem::path(SCREE_SOURCE_DIR) / "assets" / "reference" / "results.csv");
  ParameterMap map{kFriction, kFriction, {}};
  for (const double mu_r : kFriction) {
    map.value.emplace_back();
    for (const double mu : kFriction) {
      char name[40];
      std::snprintf(name, sizeof name, "lab_repose_%.1f_%.1f", mu, mu_r);
      const auto found = std::find_if(reference.begin(), reference.end(), [&](const ReferenceValue& v) {
        return v.case_name == name && v.quantity == "angle" && v.kind == "pfc3d";
      });
      if (found == reference.end()) throw std::runtime_error(name);
      map.value.back().push_back(found->value);
    }
  }
  return map;
}

/// A rock whose parameters are known, and what was measured of it.
class KnownRock {
 public:
  KnownRock(int parameters, unsigned number) : parameters_(parameters), random_(number) {
    std::uniform_real_distribution<double> anywhere(0.12, 0.38);
    for (int k = 0; k < parameters; ++k) truth.push_back(anywhere(random_));
    measured = angle(truth) + std::normal_distribution<double>(0, kUncertainty)(random_);
  }

  double angle(const std::vector<double>& at) const {
    static const ParameterMap map = printed_angles();
    return map.at(at.front(), at.back());  // one parameter: mu = mu_r
  }

  CalibrationSpec spec(CalibrationSpec::Method method) const {
    CalibrationSpec spec;
    spec.parameters.push_back({"material.mu", 0.1, 0.4});
    if (parameters_ == 2) spec.parameters.push_back({"material.mu_r", 0.1, 0.4});
    spec.seeds = {1, 2, 3};
    spec.targets.push_back({"angle_deg", measured, kUncertainty, "rock"});
    spec.method = method;
    spec.first_points = parameters_ == 2 ? 6 : 5;
    spec.most_simulations = 12;
    return spec;
  }

  CalibrationResult calibrate(const CalibrationSpec& spec) {
    return scree::calibrate(spec, [&](const std::vector<CalibrationRun>& runs) {
      std::vector<std::vector<double>> values;
      for (const CalibrationRun& run : runs) {
        std::vector<double> at;
        for (int k = 0; k < parameters_; ++k) at.push_back(parameter_value(spec, k, run.at[k]));
        values.push_back({angle(at) + std::normal_distribution<double>(0, kScatter)(random_)});
      }
      return values;
    });
  }

  std::vector<double> truth;
  double measured = 0;

 private:
  int parameters_;
  std::mt19937 random_;
};

TEST(Calibrate, IntervalsCoverTheTruthOfAHundredRocks) {
  constexpr unsigned rocks = 100;
  int covered = 0;
  for (unsigned number = 1; number <= rocks; ++number) {
    KnownRock rock(1, number);
    const CalibrationSpec spec = rock.spec(CalibrationSpec::Method::bayes);
    const CalibrationResult result = rock.calibrate(spec);
    EXPECT_LE(result.runs.size(), 12u);  // a quarter of 16 pairs with three seeds
    const auto [low, high] = answer_of(spec, result).interval[0];
    covered += rock.truth[0] >= low && rock.truth[0] <= high;
  }
  std::printf("one parameter: %d of %u truths in their 90 %% interval\n", covered, rocks);
  EXPECT_GE(covered, 80);
}

TEST(Calibrate, IntervalsOfTwoParametersCoverTheTruth) {
  constexpr unsigned rocks = 10;
  int covered = 0;
  for (unsigned number = 1; number <= rocks; ++number) {
    KnownRock rock(2, number);
    const CalibrationSpec spec = rock.spec(CalibrationSpec::Method::bayes);
    const CalibrationAnswer answer = answer_of(spec, rock.calibrate(spec));
    for (std::size_t k = 0; k < 2; ++k)
      covered += rock.truth[k] >= answer.interval[k][0] && rock.truth[k] <= answer.interval[k][1];
  }
  std::printf("two parameters: %d of %u truths in their 90 %% interval\n", covered, 2 * rocks);
  EXPECT_GE(covered, 16);
}

// The thesis's grid: 16 pairs with three seeds each, the contour of the angle, the pair with mu = mu_r.
TEST(Calibrate, AQuarterOfTheGridsSimulationsIsAsGood) {
  constexpr unsigned rocks = 20;
  double grid_error = 0, bayes_error = 0;
  for (unsigned number = 1; number <= rocks; ++number) {
    KnownRock rock(1, number);
    const CalibrationSpec few = rock.spec(CalibrationSpec::Method::bayes);
    bayes_error += std::pow(answer_of(few, rock.calibrate(few)).value[0] - rock.truth[0], 2);

    KnownRock again(2, number);
    again.truth = {rock.truth[0], rock.truth[0]};
    again.measured = rock.measured;
    const CalibrationSpec grid = again.spec(CalibrationSpec::Method::grid);
    const CalibrationResult result = again.calibrate(grid);
    EXPECT_EQ(result.runs.size(), 48u);
    const CalibrationAnswer answer = answer_of(grid, result);
    ASSERT_TRUE(answer.equal);
    grid_error += std::pow(*answer.equal - rock.truth[0], 2);
  }
  grid_error = std::sqrt(grid_error / rocks);
  bayes_error = std::sqrt(bayes_error / rocks);
  std::printf("root mean square error of friction: grid of 48 %.4f, bayes of 12 %.4f\n", grid_error,
              bayes_error);
  // The measurement's own uncertainty is 0.01 to 0.02 of friction; neither can be better.
  EXPECT_LT(bayes_error, 1.3 * grid_error);
}

// Two formulae without scatter stand in for two outputs; the truth of both is 0.6 and 0.2.
std::vector<double> two_outputs(double mu, double mu_r) {
  return {10 + 30 * mu + 40 * mu_r, 50 + 60 * mu - 80 * mu_r};
}

CalibrationSpec two_targets(CalibrationSpec::Method method) {
  CalibrationSpec spec;
  spec.parameters = {{"material.mu", 0.1, 0.9}, {"material.mu_r", 0.1, 0.9}};
  spec.seeds = {1};
  const std::vector<double> measured = two_outputs(0.6, 0.2);
  spec.targets = {{"angle_deg", measured[0], 1, "rock"}, {"chi_S6", measured[1], 1, "rock"}};
  spec.method = method;
  spec.grid_points = 5;
  spec.first_points = 8;
  spec.most_simulations = 16;
  return spec;
}

// What meets the first alone, the pair with mu = mu_r or the crossing on a grid, would miss the second.
TEST(Calibrate, TwoTargetsAreBothMet) {
  for (const auto method : {CalibrationSpec::Method::grid, CalibrationSpec::Method::bayes}) {
    const CalibrationSpec spec = two_targets(method);
    const auto result = calibrate(spec, [&](const std::vector<CalibrationRun>& runs) {
      std::vector<std::vector<double>> values;
      for (const CalibrationRun& run : runs)
        values.push_back(
            two_outputs(parameter_value(spec, 0, run.at[0]), parameter_value(spec, 1, run.at[1])));
      return values;
    });
    const CalibrationAnswer answer = answer_of(spec, result);
    EXPECT_FALSE(answer.equal);
    EXPECT_NEAR(answer.value[0], 0.6, 0.02);
    EXPECT_NEAR(answer.value[1], 0.2, 0.02);
    for (const double missed : answer.missed_by) EXPECT_LT(std::abs(missed), 1);
  }
}

TEST(Calibrate, TwoTargetsOfOneParameterOnAGridAreBothWeighed) {
  CalibrationSpec spec = two_targets(CalibrationSpec::Method::grid);
  spec.parameters.pop_back();
  spec.targets[0].uncertainty = 20;  // where it is met, 0.8, says little
  spec.targets[0].value = two_outputs(0.8, 0.2)[0];
  spec.targets[1].value = two_outputs(0.5, 0.2)[1];
  const auto result = calibrate(spec, [&](const std::vector<CalibrationRun>& runs) {
    std::vector<std::vector<double>> values;
    for (const CalibrationRun& run : runs)
      values.push_back(two_outputs(parameter_value(spec, 0, run.at[0]), 0.2));
    return values;
  });
  const CalibrationAnswer answer = answer_of(spec, result);
  EXPECT_FALSE(answer.interpolated);
  EXPECT_NEAR(answer.value[0], 0.5, 0.01);
  EXPECT_GT(answer.value[0], answer.interval[0][0]);
  EXPECT_LT(answer.value[0], answer.interval[0][1]);
}

}  // namespace
}  // namespace scree
