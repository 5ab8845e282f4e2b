// One engine calibrated by another, both of them formulae.
#include "cli/ensemble/equivalence_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <map>
#include <random>

#include "scree_version.h"
#include "sim/material/equivalence.h"

namespace fs = std::filesystem;
using testing::HasSubstr;

namespace scree {
namespace {

double angle(double mu, double mu_r) {
  return 8 + 60 * (1 - std::exp(-1.5 * mu)) + 20 * mu * mu_r;
}

// Bullet here is `weakness` times too slippery; without noise but that of `scatter`.
EquivalenceSimulator engines(double weakness, double scatter, int& simulations) {
  auto random = std::make_shared<std::mt19937>(3);
  return [weakness, scatter, random, &simulations](const std::vector<EquivalenceRun>& runs) {
    std::vector<double> values;
    for (const EquivalenceRun& run : runs) {
      std::map<std::string, std::string> given;
      for (const std::string& text : run.overrides)
        given[text.substr(0, text.find('='))] = text.substr(text.find('=') + 1);
      EXPECT_EQ(given.at("material.local_damping"), "0.4");
      const auto number = [&](const char* key) { return std::stod(given.at(key)); };
      const double noise = std::normal_distribution<double>(0, 1)(*random) * scatter;
      values.push_back(noise + (given.at("engine") == "impulse"
                                    ? angle(number("numerics.impulse_friction") / weakness,
                                            number("numerics.impulse_rolling") / weakness)
                                    : angle(number("material.mu"), number("material.mu_r"))));
      ++simulations;
    }
    return values;
  };
}

EquivalenceSpec spec() {
  EquivalenceSpec s;
  s.seeds = {1, 2};
  s.output = "angle_deg";
  s.mu = s.mu_r = {0.1, 0.2, 0.3, 0.4};
  s.local_damping = {0.4};
  s.friction = {"numerics.impulse_friction", 0.05, 0.7};
  s.rolling = {"numerics.impulse_rolling", 0.05, 0.7};
  return s;
}

TEST(EquivalenceFit, FindsTheSlipperinessOfTheOtherEngine) {
  int simulations = 0;
  for (const EquivalenceNode& node : fit_equivalence(spec(), engines(1.25, 0, simulations))) {
    EXPECT_TRUE(node.found);
    EXPECT_NEAR(node.friction / node.mu, 1.25, 0.05);
    EXPECT_NEAR(node.rolling / node.mu_r, 1.25, 0.05);
    EXPECT_NEAR(node.angle_impulse, node.angle_rrlinear, 2);
  }
  EXPECT_EQ(simulations, 2 * 16 + 24 + 2 * 16);  // one round of checks was enough
}

TEST(EquivalenceFit, ScatterOfSeedsIsWithinTheBound) {
  int simulations = 0, found = 0;
  for (const EquivalenceNode& node : fit_equivalence(spec(), engines(0.8, 1.0, simulations))) {
    found += node.found;
    if (!node.found) continue;
    EXPECT_NEAR(angle(node.friction / 0.8, node.rolling / 0.8), angle(node.mu, node.mu_r), 4);
  }
  EXPECT_GE(found, 15);
}

TEST(EquivalenceFit, WhatCannotBeFollowedIsLeftOut) {
  EquivalenceSpec s = spec();
  s.friction.to = s.rolling.to = 0.35;
  int simulations = 0;
  const auto nodes = fit_equivalence(s, engines(1.25, 0, simulations));
  EXPECT_FALSE(nodes.back().found);  // would need 0.5
  EXPECT_TRUE(nodes.front().found);

  const fs::path file = fs::temp_directory_path() / ("scree_fit_" + std::to_string(getpid()) + ".csv");
  std::ofstream(file) << equivalence_csv(nodes, {"a comment"});
  const Equivalence table = Equivalence::read(file);
  fs::remove(file);
  EXPECT_NEAR(table.at(0.1, 0.1, 0.4)->friction, nodes.front().friction, 1e-4);
  EXPECT_FALSE(table.at(0.4, 0.4, 0.4));
}

TEST(EquivalenceFit, WhatComesNearestIsTakenWithinTheBound) {
  EquivalenceSpec s = spec();
  s.friction.to = s.rolling.to = 0.47;  // mu = mu_r = 0.4 would need 0.5
  int simulations = 0;
  const EquivalenceNode last = fit_equivalence(s, engines(1.25, 0, simulations)).back();
  ASSERT_TRUE(last.found);
  EXPECT_NEAR(last.friction, 0.47, 0.01);
  EXPECT_LT(last.angle_impulse, last.angle_rrlinear);
  EXPECT_NEAR(last.angle_impulse, last.angle_rrlinear, s.within);
}

TEST(EquivalenceFit, WrongFilesAreToldWithTheirPlace) {
  const fs::path file = fs::temp_directory_path() / ("scree_fit_" + std::to_string(getpid()) + ".yaml");
  const auto first_error = [&](const std::string& equivalent) {
    std::ofstream(file) << "scenario: " << SCREE_SOURCE_DIR
                        << "/scenarios/repose_lab.yaml\nseeds: [1]\nequivalent:\n"
                        << equivalent;
    const auto errors = load_equivalence(file).errors;
    return errors.empty() ? std::string() : errors.front().text();
  };
  const std::string damping = ", material.local_damping: [0.4]}\n";
  const std::string nodes = "  nodes: {material.mu: [0.1, 0.2], material.mu_r: [0.1, 0.2]" + damping;
  const std::string search =
      "  search: {numerics.impulse_friction: {from: 0.1, to: 1}, numerics.impulse_rolling: {from: 0.1, to: "
      "1}}\n";
  EXPECT_EQ(first_error(nodes + search), "");
  EXPECT_TRUE(is_equivalence(file));
  EXPECT_THAT(first_error(nodes), HasSubstr("'search' is missing"));
  EXPECT_THAT(first_error(nodes + "  search: {numerics.impulse_friction: {from: 0.1, to: 1}}\n"),
              HasSubstr("numerics.impulse_friction and numerics.impulse_rolling are needed"));
  EXPECT_THAT(first_error("  nodes: {material.mu: [0.2, 0.1], material.mu_r: [0.1]" + damping + search),
              HasSubstr("material.mu: the numbers must rise"));
  EXPECT_THAT(first_error("  nodes: {material.mu: [0.2]" + damping + search),
              HasSubstr("material.mu_r is missing"));
  EXPECT_THAT(first_error("  nodes: {material.mu: [0.2], material.mu_r: [0.1]}\n" + search),
              HasSubstr("material.local_damping is missing"));
  EXPECT_THAT(first_error(nodes + search + "  within: 0\n"), HasSubstr("within: degrees, more than 0"));
  EXPECT_THAT(first_error(nodes + search + "  points: 200\n  rounds: 20\n  seeds: 3\n"),
              HasSubstr("unknown key 'seeds'"));
  EXPECT_THAT(first_error(nodes + search + "  point: 3\n"), HasSubstr("unknown key 'point'"));
  fs::remove(file);
}

}  // namespace
}  // namespace scree
