#include "cli/ensemble/diagnosis_session.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <map>
#include <numbers>
#include <set>

#include "cli/ensemble/scenario_patch.h"
#include "cli/ensemble/twin.h"
#include "scree_version.h"
#include "sim/io/text_file.h"
#include "sim/material/random.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using Kind = DiagnosisVerdict::Kind;

const fs::path kAssets = fs::path(SCREE_SOURCE_DIR) / "assets";

constexpr double kRatios = 100;  // ratios of diameters and the like are above 0

// The program without its simulator: a run's numbers are formulas of its scenario, plus noise of its seed.
class FormulaSimulator {
 public:
  std::vector<std::optional<StoredResult>> operator()(const std::vector<RunRequest>& requests,
                                                      const std::string& what) {
    stages.push_back(what);
    std::vector<std::optional<StoredResult>> results;
    for (const RunRequest& request : requests) {
      ++asked;
      const YAML::Node scenario = YAML::Load(request.scenario);
      if (scenario["effects"]) ++with_effects;
      StoredResult result;
      result.state = RunState::done;
      result.wall_seconds = 1;
      Random random(request.seed, static_cast<std::uint64_t>(scenario["grading"].Scalar().size()),
                    RandomPurpose::measurement);
      const double mu = scenario["material"]["mu"].as<double>();
      const auto effect = [&](const char* name, const char* key) {
        return scenario["effects"] && scenario["effects"][name] ? scenario["effects"][name][key].as<double>()
                                                                : 0.0;
      };
      const double cohesion = effect("cohesion", "bond_number"), twisting = effect("twisting", "mu_t"),
                   rolling = effect("rolling_by_size", "exponent"),
                   hidden = effect("restitution", "damping_ratio");
      const double means[] = {100 * mu + 4 * cohesion + 3 * twisting + 8 * rolling,
                              60 * mu - 5 * cohesion + 9 * twisting * twisting + 3 * hidden,
                              20 * mu + 2 * cohesion - 7 * twisting + 2 * rolling - 6 * hidden,
                              -30 * mu + 6 * cohesion + twisting - 6 * rolling - 9 * hidden,
                              5 * mu + 3 * twisting + 5 * rolling + 9 * hidden,
                              3 * cohesion * cohesion - 2 * twisting - 4 * rolling + 5 * hidden};
      const char* names[] = {"half_coverage_deg", "d50_rel_ring1", "d50_rel_ring2",
                             "d50_rel_ring3",     "profile_25",    "spread_95"};
      if (scenario["effects"] && scenario["effects"].size() == 2)
        (cohesion > 0 && twisting > 0 ? with_both : with_two_others).insert(request.scenario);
      if (request.seed > 700'000 && scenario["effects"] && !scenario["effects"][fits_fail_with])
        fits_of_others.insert(request.scenario);
      for (int k = 0; k < 6; ++k) {
        const double normal = std::sqrt(-2 * std::log(1 - random.uniform())) *
                              std::cos(2 * std::numbers::pi * random.uniform());
        result.outputs[names[k]] = (k == 0 ? 0 : kRatios) + means[k] +
                                   (k % 3 - 1) * together * cohesion * twisting * (1 - cohesion / 4) +
                                   0.3 * normal;
        if (request.seed >
            700'000)  // those of the design are below, those of twins have a simulator of their own
          result.outputs[names[k]] += (k % 2 == 0 ? 1 : -1) * fits_are_off_by;
      }
      result.outputs["at_rest"] = 1;
      if (request.seed > 700'000 && scenario["effects"] && scenario["effects"][fits_fail_with])
        result.state = RunState::failed;
      results.emplace_back(std::move(result));
    }
    return results;
  }
  std::vector<std::string> stages;  ///< what a user who waits is told
  int asked = 0, with_effects = 0;
  std::set<std::string> with_both,
      with_two_others;                   ///< scenarios with cohesion and twisting, with other pairs
  std::set<std::string> fits_of_others;  ///< scenarios with effects whose fits do not fail
  double together = 0;                   ///< what cohesion and twisting do beyond what each does alone
  std::string fits_fail_with = "none";   ///< an effect with which simulations of fitted models fail
  double fits_are_off_by = 0;            ///< what simulations of fitted models differ by from the formulas
};

class Session : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("scree_session_" + std::to_string(getpid()));
    fs::create_directories(folder);
    const std::string scenarios = (fs::path(SCREE_SOURCE_DIR) / "scenarios").string();
    write_text_file(folder / "model.yaml",
                    "parameters:\n  material.mu: {nominal: 0.25, from: 0.15, to: 0.35}\n"
                    "ties: {material.mu_r: material.mu}\n"
                    "effects: [cohesion, twisting, rolling_by_size, restitution]\n"
                    "experiments:\n  heap:\n    scenario: " +
                        scenarios +
                        "/repose_lab_coarse.yaml\n    set: {experiment.mass_kg: 40}\n"
                        "    observables: [half_coverage_deg, d50_rel_ring1, d50_rel_ring2, d50_rel_ring3, "
                        "profile_25, spread_95]\n");
    auto loaded = load_model(folder / "model.yaml", kAssets);
    ASSERT_TRUE(loaded.errors.empty()) << loaded.errors.front().text();
    model = loaded.model;
  }
  void TearDown() override { fs::remove_all(folder); }

  // The model with other effects in its list.
  DiagnosisModel model_with(const std::string& effects, const std::string& instead_of) const {
    std::ifstream in(folder / "model.yaml");
    std::string text{std::istreambuf_iterator<char>(in), {}};
    text.replace(text.find(instead_of), instead_of.size(), effects);
    write_text_file(folder / "measuring.yaml", text);
    const auto loaded = load_model(folder / "measuring.yaml", kAssets);
    EXPECT_TRUE(loaded.errors.empty()) << loaded.errors.front().text();
    return loaded.model;
  }
  ModelSpace model_space() const {
    std::vector<Dataset::Experiment> experiments;
    for (const ModelExperiment& each : model.experiments) experiments.push_back(each.experiment);
    return space_of(model, experiments, {}, kAssets);
  }
  // A twin's data as diagnose reads them from its files.
  JoinedData data_of(const TwinSpec& spec, TwinTruth* truth = nullptr) {
    FormulaSimulator formula;
    formula.together = simulator.together;
    const Twin twin = make_twin(model, spec, kAssets, std::ref(formula), std::ref(formula));
    if (truth != nullptr) *truth = twin.truth;
    write_dataset(twin.data, folder);
    const DatasetResult read = load_dataset(folder / "dataset.yaml", kAssets);
    EXPECT_TRUE(read.errors.empty());
    return join_datasets({read.dataset});
  }
  DiagnosisOutcome diagnosed(const TwinSpec& spec, const std::vector<std::string>& without = {}) {
    DiagnosisSession session(model, data_of(spec), without, kAssets);
    return session.run(std::ref(simulator));
  }
  static std::string named(const DiagnosisOutcome& o) {
    std::string text;
    const auto& named = o.diagnosis.verdict.named;
    if (named.empty()) return text;
    for (const std::size_t e : o.diagnosis.judgements[named.front()].hypothesis.effects)
      text += o.space.effects[e].name + " ";
    return text;
  }

  fs::path folder;
  DiagnosisModel model;
  FormulaSimulator simulator;
};

TEST(JoinedDatasets, EveryExperimentHasANameOfItsOwn) {
  const DatasetResult read = load_dataset(fs::path(kAssets) / "datasets/laboratory/dataset.yaml", kAssets);
  ASSERT_TRUE(read.errors.empty());
  const JoinedData joined = join_datasets({read.dataset, read.dataset, read.dataset});
  const auto& names = joined.measured.experiments;
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), 3 * read.dataset.experiments.size());
}

TEST_F(Session, ThreadsChangeNothing) {
  const JoinedData data = data_of({{"cohesion"}, 6, 5, 0.5, 3, ""});
  DiagnosisSession alone(model, data, {}, kAssets), shared(model, data, {}, kAssets, 4);
  const DiagnosisOutcome a = alone.run(std::ref(simulator)), b = shared.run(std::ref(simulator));
  EXPECT_EQ(a.simulations, b.simulations);
  ASSERT_EQ(a.diagnosis.judgements.size(), b.diagnosis.judgements.size());
  for (std::size_t k = 0; k < a.diagnosis.judgements.size(); ++k)
    EXPECT_EQ(a.diagnosis.judgements[k].probability, b.diagnosis.judgements[k].probability);
}

TEST_F(Session, NamesTheEffectThatATwinHides) {
  double with = 0, without = 0;  // chi-square of four simulations each, which scatters: of all three together
  for (const std::string effect : {"cohesion", "twisting", "rolling_by_size"}) {
    TwinSpec spec{{effect}, 6, 5, 0.5, 3, ""};
    const DiagnosisOutcome o = diagnosed(spec);
    EXPECT_EQ(named(o), effect + " ");
    ASSERT_TRUE(o.calibrated && o.augmented && o.held_out_augmented);
    EXPECT_LT(o.held_out_augmented->gap(), 0.25 * o.held_out_calibrated->gap());
    with += o.augmented->gap.chi2;
    without += o.calibrated->gap.chi2;
    EXPECT_GT(o.augmented->gap.p, 1e-3);
    EXPECT_THAT(diagnosis_in_words(o).front(), HasSubstr(effect));
  }
  EXPECT_LT(with, 0.4 * without);
}

TEST_F(Session, TakesNoMoreRoundsThanTheModelAllows) {
  const TwinSpec spec{{"cohesion"}, 6, 5, 0.5, 3, ""};
  simulator.fits_are_off_by = 4;  // so that fits move
  EXPECT_GT(diagnosed(spec).rounds, 1);
  ASSERT_GT(simulator.stages.size(), 1u);
  EXPECT_EQ(simulator.stages.front(), "before the data are looked at: the base model and every effect");
  EXPECT_EQ(simulator.stages[1],
            fmt::format("round 1 of at most {}: no effect (re-calibration alone), at its fit",
                        3 * model.simulations.rounds));
  const int all = simulator.asked;
  model.simulations.rounds = 1;
  simulator.asked = 0;
  EXPECT_EQ(diagnosed(spec).rounds, 1);
  EXPECT_LT(simulator.asked, all);
}

// Nothing in the design says what two effects do together: that is learnt from simulations of both.
TEST_F(Session, NamesTwoEffectsThatActOnEachOther) {
  simulator.together = 6;
  const TwinSpec spec{{"cohesion", "twisting"}, 6, 10, 0.5, 11, ""};
  TwinTruth truth;
  DiagnosisSession session(model, data_of(spec, &truth), {}, kAssets);
  const DiagnosisOutcome o = session.run(std::ref(simulator));
  EXPECT_EQ(named(o), "cohesion twisting ");
  EXPECT_GT(simulator.with_both.size(), 10u) << "explored, and not only where it fits best";
  EXPECT_GT(simulator.with_two_others.size(), 0u);
  ASSERT_TRUE(o.augmented.has_value());
  EXPECT_GT(o.augmented->gap.p, 0.01);
  const Judgement& found = o.diagnosis.judgements[o.diagnosis.verdict.named.front()];
  for (std::size_t e = 0; e < 2; ++e) {
    const double hidden = truth.at.effects[e].amplitude();
    EXPECT_NEAR(o.space.effects[e].coordinate(found.effects[e][0].middle), hidden, 0.3 * hidden);
  }
}

TEST_F(Session, SaysUnknownWithoutTheEffectInItsLibrary) {
  const DiagnosisOutcome o = diagnosed({{"restitution"}, 8, 5, 0.5, 4, ""}, {"restitution"});
  EXPECT_EQ(o.diagnosis.verdict.kind, Kind::unknown);
  EXPECT_FALSE(o.augmented);
  EXPECT_THAT(diagnosis_in_words(o).front(), HasSubstr("not among the 3 effects"));
}

TEST_F(Session, NamesNothingWhereNothingIsHidden) {
  for (const std::uint64_t seed : {5, 6, 7}) {
    const DiagnosisOutcome o = diagnosed({{}, 0, 5, 0.5, seed, ""});
    EXPECT_TRUE(o.diagnosis.verdict.kind == Kind::nothing || o.diagnosis.verdict.kind == Kind::calibration);
  }
}

// Surfaces that foretell what the simulator does not do where they are trusted.
TEST_F(Session, ACalibrationThatItsOwnSimulationsContradictIsNotSaid) {
  const TwinSpec spec{{}, 0, 5, 0.5, 5, ""};
  const DiagnosisOutcome sound = diagnosed(spec);
  ASSERT_EQ(sound.diagnosis.verdict.kind, Kind::calibration);
  EXPECT_GT(sound.calibrated->gap.p, 0.01);
  simulator.fits_are_off_by = 4;
  const DiagnosisOutcome o = diagnosed(spec);
  EXPECT_EQ(o.diagnosis.verdict.kind, Kind::unknown);
  EXPECT_TRUE(o.diagnosis.verdict.named.empty());
  ASSERT_TRUE(o.calibrated.has_value());
  EXPECT_LE(o.calibrated->gap.p, 0.01);
}

TEST_F(Session, WhatCannotBeSimulatedAtItsFitIsNotNamed) {
  simulator.fits_fail_with = "cohesion";
  const DiagnosisOutcome o = diagnosed({{"cohesion"}, 6, 5, 0.5, 3, ""});
  EXPECT_GT(simulator.fits_of_others.size(), 10u) << "it does not keep others from being explored";
  EXPECT_THAT(o.notes, testing::Contains(
                           HasSubstr("cohesion could not be tried by full simulations at its last fit")));
  for (const std::size_t k : o.diagnosis.verdict.named)
    EXPECT_THAT(o.diagnosis.judgements[k].hypothesis.effects, testing::Not(testing::Contains(0u)));
}

TEST_F(Session, TheDesignIsTheSameForAllDataAndWhenAnEffectIsLeftOut) {
  const JoinedData data = data_of({{"cohesion"}, 4, 5, 0.5, 8, ""});
  const DiagnosisSession all(model, data, {}, kAssets), fewer(model, data, {"cohesion"}, kAssets);
  std::set<std::string> keys;
  for (const RunRequest& request : all.design()[0].requests) keys.insert(request.key);
  EXPECT_EQ(keys.size(), all.design()[0].requests.size());
  EXPECT_EQ(keys.size(), 6u + 24 + 4 * 10);
  for (const RunRequest& request : fewer.design()[0].requests) EXPECT_TRUE(keys.contains(request.key));
  EXPECT_EQ(fewer.design()[0].requests.size(), keys.size() - 10);
}

TEST_F(Session, EffectsOnMeasurementReadThePilesOfTheBaseModel) {
  const DiagnosisModel measuring = model_with("image_blur]", "restitution]");
  const DiagnosisSession session(measuring, data_of({{"cohesion"}, 4, 5, 0.5, 8, ""}), {}, kAssets);
  const ExperimentRuns& heap = session.design()[0];
  std::set<std::string> piles, keys;
  std::vector<double> widths;
  for (std::size_t k = 0; k < heap.runs.size(); ++k) {
    piles.insert(heap.requests[k].pile);
    keys.insert(heap.requests[k].key);
    for (const EffectAt& effect : heap.runs[k].at.effects)
      if (session.space().effects[effect.effect].measures) widths.push_back(effect.amplitude());
  }
  EXPECT_EQ(keys.size(), 6u + 24 + 4 * 10);
  EXPECT_EQ(piles.size(), 6u + 24 + 3 * 10) << "the readings need no simulation of their own";
  ASSERT_EQ(widths.size(), 10u);
  EXPECT_FALSE(std::is_sorted(widths.begin(), widths.end())) << "not tied to the base parameters";
  std::sort(widths.begin(), widths.end());
  for (std::size_t k = 0; k < widths.size(); ++k)
    EXPECT_NEAR(std::sqrt(widths[k]), static_cast<double>(k + 1) / 10, 1e-12);
}

// How two effects on measurement act together is known before anything is named.
TEST_F(Session, PairsOfEffectsOnMeasurementAreReadToo) {
  const DiagnosisModel measuring =
      model_with("image_blur, section_borders]", "rolling_by_size, restitution]");
  const DiagnosisSession session(measuring, data_of({{"cohesion"}, 4, 5, 0.5, 8, ""}), {}, kAssets);
  const ExperimentRuns& heap = session.design()[0];
  std::set<std::string> piles;
  int pairs = 0;
  for (std::size_t k = 0; k < heap.runs.size(); ++k) {
    piles.insert(heap.requests[k].pile);
    if (heap.runs[k].at.effects.size() < 2) continue;
    ++pairs;
    EXPECT_THAT(heap.requests[k].scenario,
                testing::AllOf(HasSubstr("image_blur"), HasSubstr("section_borders")));
  }
  EXPECT_EQ(pairs, 5);
  EXPECT_EQ(heap.runs.size(), 6u + 24 + 4 * 10 + 5);
  EXPECT_EQ(piles.size(), 6u + 24 + 2 * 10);
}

TEST_F(Session, TwinsHaveTheStrengthAskedForAndUseNoSeedOfTheDesign) {
  TwinTruth truth;
  data_of({{"twisting"}, 4, 5, 0.5, 9, ""}, &truth);
  ASSERT_EQ(truth.detectability.size(), 1u);
  EXPECT_NEAR(truth.detectability[0], 4, 0.5);
  // By the formulas: each number scatters by 0.3, an error of half of that is added, five repeats, and what
  // goes along with friction does not count. The twin knows the scatter of 30 simulations.
  const double t = YAML::Load(twin_answer(model, {{"twisting"}, 4, 5, 0.5, 9, ""}, truth,
                                          kAssets))["effects"][0]["values"]["effects.twisting.mu_t"]
                       .as<double>();
  Eigen::VectorXd change(6), friction(6);
  change << 3 * t, 9 * t * t, -7 * t, t, 3 * t, -2 * t;
  friction << 100, 60, 20, -30, 5, 0;
  change -= friction * friction.dot(change) / friction.squaredNorm();
  EXPECT_NEAR(change.norm() / std::sqrt(6) / (0.3 * std::sqrt(1.25 / 5)), 4, 0.8);
  EXPECT_LE(truth.at.base.cwiseAbs().maxCoeff(), 0.6);
  EXPECT_THROW(data_of({{"twisting"}, 4000, 5, 0.5, 9, ""}), TooWeak);
  const std::string answer = twin_answer(model, {{"twisting"}, 4, 5, 0.5, 9, ""}, truth, kAssets);
  EXPECT_THAT(answer, HasSubstr("effects.twisting.mu_t"));
  std::ifstream yaml(folder / "dataset.yaml"), table(folder / "observables.csv");
  const std::string public_text{std::istreambuf_iterator<char>(yaml), {}},
      values{std::istreambuf_iterator<char>(table), {}};
  EXPECT_EQ(public_text.find("twisting"), std::string::npos);
  EXPECT_EQ(values.find("twisting"), std::string::npos);
}

// What gives no measurement is repeated with another seed; where half of them do, there is no twin.
TEST_F(Session, TwinsRepeatWhatGivesNoMeasurement) {
  FormulaSimulator formula;
  const auto with_failures = [&](std::uint64_t every) {
    int asked = 0;
    const auto hidden = [&](const std::vector<RunRequest>& requests, const std::string& what) {
      auto results = formula(requests, what);
      for (std::size_t k = 0; k < requests.size(); ++k) {
        if (requests[k].seed % every == 0) results[k]->outputs.erase("d50_rel_ring2");
        asked += requests[k].seed < 1'500'000'000 ? 1 : 0;  // others tell how strong the effect is
      }
      return results;
    };
    const Twin twin = make_twin(model, {{"cohesion"}, 4, 10, 0.5, 3, ""}, kAssets, std::ref(formula), hidden);
    EXPECT_EQ(twin.data.experiments.front().observables.at("d50_rel_ring2").n, 10);
    return asked;
  };
  EXPECT_GT(with_failures(4), 10);
  EXPECT_LT(with_failures(4), 16);
  EXPECT_EQ(with_failures(1000003), 10);
  EXPECT_THROW(with_failures(1), std::runtime_error);
}

// Where an effect is too strong to be simulated, weaker ones are tried; where nothing is simulated, that is
// said.
TEST_F(Session, TwinsKeepToAmplitudesThatCanBeSimulated) {
  FormulaSimulator formula;
  double most = 1e9;  // bond number from which on simulations fail
  const auto hidden = [&](const std::vector<RunRequest>& requests, const std::string& what) {
    auto results = formula(requests, what);
    for (std::size_t k = 0; k < requests.size(); ++k)
      if (const YAML::Node effects = YAML::Load(requests[k].scenario)["effects"];
          effects && effects["cohesion"] && effects["cohesion"]["bond_number"].as<double>() > most)
        results[k]->state = RunState::failed;
    return results;
  };
  const auto bond_number = [&] {
    const TwinSpec spec{{"cohesion"}, 4, 5, 0.5, 3, ""};
    const Twin twin = make_twin(model, spec, kAssets, std::ref(formula), hidden);
    EXPECT_NEAR(twin.truth.detectability.at(0), 4, 1);
    return model_space().effects[0].amplitude(twin.truth.at.effects.at(0).amplitude());
  };
  const double free = bond_number();
  most = 1.2 * free;
  EXPECT_NEAR(bond_number(), free, 0.2 * free);
  most = 0.5 * free;
  EXPECT_THROW(bond_number(), TooWeak);
  most = 0;
  EXPECT_THROW(bond_number(), std::runtime_error);
}

// An effect costs no simulations of an experiment in which it changes nothing, be it by the scenario or by
// what the model sets.
TEST_F(Session, EffectsThatChangeNothingAreNotSearched) {
  const std::string scenarios = (fs::path(SCREE_SOURCE_DIR) / "scenarios").string();
  const std::string head =
      "parameters: {material.mu: {nominal: 0.3, from: 0.2, to: 0.4}}\n"
      "effects: [release_speed, undamped_flight, cohesion]\n";
  const auto acts = [&](const std::string& text, const std::string& effect) {
    write_text_file(folder / "inert.yaml", head + text);
    const auto loaded = load_model(folder / "inert.yaml", kAssets);
    EXPECT_TRUE(loaded.errors.empty()) << loaded.errors.front().text();
    std::vector<Dataset::Experiment> experiments;
    for (const ModelExperiment& each : loaded.model.experiments) experiments.push_back(each.experiment);
    for (const CandidateEffect& candidate : space_of(loaded.model, experiments, {}, kAssets).effects)
      if (candidate.name == effect) return candidate.acts;
    return std::vector<std::string>{};
  };
  const std::string hoist = "  hoist: {scenario: " + scenarios + "/hoist_dump.yaml, observables: [chi_S1]}\n",
                    gate = "  gate: {scenario: " + scenarios + "/quick_dump.yaml, observables: [chi_S1]}\n";
  EXPECT_THAT(acts("experiments:\n" + hoist, "release_speed"), testing::IsEmpty());
  EXPECT_THAT(acts("experiments:\n" + hoist, "cohesion"), testing::ElementsAre("hoist"));
  EXPECT_THAT(acts("experiments:\n" + hoist + gate, "release_speed"), testing::ElementsAre("gate"));
  EXPECT_THAT(acts("set: {experiment.truck.release: hoist}\nexperiments:\n" + gate, "release_speed"),
              testing::IsEmpty());
  EXPECT_THAT(acts("set: {material.damping_reach: contacts}\nexperiments:\n" + gate, "undamped_flight"),
              testing::IsEmpty());
  EXPECT_THAT(acts("experiments:\n" + gate, "undamped_flight"), testing::ElementsAre("gate"));
}

// Of an effect that a scenario has already, and of one that does not go with it, the amplitudes of the design
// would be wrong; both are said, and so is what changes nothing.
TEST_F(Session, EffectsThatCannotBeLookedForAreSaid) {
  const std::string quick = (fs::path(SCREE_SOURCE_DIR) / "scenarios/quick_dump.yaml").string();
  const std::string parameters = "parameters: {material.mu: {nominal: 0.3, from: 0.2, to: 0.4}}\n";
  const auto space = [&](const std::string& text) {
    write_text_file(folder / "given.yaml", parameters + text);
    const auto loaded = load_model(folder / "given.yaml", kAssets);
    EXPECT_TRUE(loaded.errors.empty()) << loaded.errors.front().text();
    std::vector<Dataset::Experiment> experiments;
    for (const ModelExperiment& each : loaded.model.experiments) experiments.push_back(each.experiment);
    return space_of(loaded.model, experiments, {}, kAssets);
  };
  const auto experiment = [&](const std::string& set) {
    return "experiments: {dump: {scenario: " + quick + ", set: {" + set + "}, observables: [chi_S1]}}\n";
  };
  const ModelSpace given = space("effects: [cohesion, clumps, breakage, release_speed, twisting]\n" +
                                 experiment("effects.breakage.fragility_kg_per_j: 0.01, "
                                            "experiment.truck.release: hoist, effects.twisting.mu_t: 0"));
  const auto said = [](const ModelSpace& of) {
    std::vector<std::string> all;
    for (const LeftOut& each : of.left_out) all.push_back(each.effect + ": " + each.why);
    return all;
  };
  EXPECT_THAT(said(given),
              ElementsAre("clumps: experiment dump has breakage, with which it does not go",
                          "breakage: experiment dump has it",
                          "release_speed: changes nothing without experiment.truck.release open_gate"));
  ASSERT_EQ(given.effects.size(), 2u) << "twisting is set to where it does nothing";
  // Without a list all are looked for that the model does not give itself.
  const ModelSpace all = space("set: {effects.cohesion.bond_number: 0.5}\n" + experiment(""));
  EXPECT_EQ(all.find("cohesion"), all.effects.size());
  EXPECT_LT(all.find("twisting"), all.effects.size());
  EXPECT_THAT(said(all), testing::Contains("cohesion: the model gives it"));
}

// Rival effects are simulated with random numbers of their own, which do not depend on what else is looked
// for.
TEST_F(Session, EffectsHaveSeedsOfTheirOwn) {
  write_text_file(
      folder / "all.yaml",
      "parameters: {material.mu: {nominal: 0.3, from: 0.2, to: 0.4}}\nexperiments: {dump: {scenario: " +
          (fs::path(SCREE_SOURCE_DIR) / "scenarios/quick_dump.yaml").string() +
          ", observables: [chi_S1]}}\n");
  const auto loaded = load_model(folder / "all.yaml", kAssets);
  ASSERT_TRUE(loaded.errors.empty()) << loaded.errors.front().text();
  const std::vector<Dataset::Experiment> experiments{loaded.model.experiments.front().experiment};
  const auto seeds_of = [&](const std::vector<std::string>& without) {
    const ModelSpace space = space_of(loaded.model, experiments, without, kAssets);
    std::map<std::string, std::set<std::uint64_t>> seeds;
    for (const PlannedRun& run : design_of(space, loaded.model.simulations))
      if (run.at.effects.size() == 1 && !space.effects[run.at.effects.front().effect].measures)
        seeds[space.effects[run.at.effects.front().effect].name].insert(run.seed);
    return seeds;
  };
  const auto all = seeds_of({});
  ASSERT_GT(all.size(), 8u);
  std::size_t count = 0;
  std::set<std::uint64_t> together;
  for (const auto& [effect, seeds] : all) count += seeds.size(), together.insert(seeds.begin(), seeds.end());
  EXPECT_EQ(together.size(), count) << "no two effects share one";
  auto others = all;
  others.erase("cohesion");
  EXPECT_EQ(seeds_of({"cohesion"}), others);
}

TEST_F(Session, WhatTheModelSaysInsteadOfAnExperimentIsSaid) {
  JoinedData data = data_of({{"cohesion"}, 6, 5, 0.5, 3, ""});
  data.experiments.front().overrides.push_back("material.mu_r=0.1");
  const std::size_t before =
      DiagnosisSession(model, data_of({{"cohesion"}, 6, 5, 0.5, 3, ""}), {}, kAssets).data().notes.size();
  const DiagnosisSession session(model, data, {}, kAssets);
  EXPECT_EQ(session.data().notes.size(), before + 1) << "its mass is its own";
  EXPECT_EQ(session.data().notes.front(),
            "experiment heap sets material.mu_r=0.1; what the model says of material.mu_r is taken");
}

TEST_F(Session, ModelFilesAreChecked) {
  const auto error = [&](const std::string& text) {
    write_text_file(folder / "bad.yaml", text);
    const auto loaded = load_model(folder / "bad.yaml", kAssets);
    return loaded.errors.empty() ? std::string() : loaded.errors.front().text();
  };
  EXPECT_THAT(error("title: x\n"), HasSubstr("parameters"));
  const std::string head = "parameters: {material.mu: {nominal: 0.2, from: 0.1, to: 0.3}}\n";
  EXPECT_EQ(error(head), "");
  EXPECT_THAT(error("parameters: {material.mu: {nominal: 0.4, from: 0.1, to: 0.3}}\n"),
              HasSubstr("must lie between"));
  EXPECT_THAT(error("parameters: {material.mu: {from: 0.1, to: 0.3}}\n"), HasSubstr("nominal"));
  const std::string dump = (fs::path(SCREE_SOURCE_DIR) / "scenarios/quick_dump.yaml").string();
  EXPECT_THAT(error("parameters: {experiment.dumps: {nominal: 1, from: 1, to: 3}}\n"
                    "experiments: {dump: {scenario: " +
                    dump + ", observables: [chi_S1]}}\n"),
              AllOf(HasSubstr("bad.yaml:1:14"), HasSubstr("a whole number is expected")));
  EXPECT_THAT(
      error(head + "experiments: {dump: {scenario: " + dump + ", observables: [simulated_seconds]}}\n"),
      HasSubstr("says something of a run"));
  EXPECT_THAT(error(head + "effects: []\n"), HasSubstr("found an empty list"));
  EXPECT_THAT(error(head + "effects: [cohesoin]\n"), HasSubstr("did you mean 'cohesion'"));
  EXPECT_THAT(error(head + "effects: [cohesion, cohesion]\n"), HasSubstr("stands twice"));
  EXPECT_THAT(error(head + "simulations: {effect: 2}\n"), HasSubstr("from 4 to 1000"));
  EXPECT_THAT(error(head + "simulations: {rounds: 0}\n"), HasSubstr("from 1 to 20"));
  EXPECT_THAT(error(head + "experiments: {a: {scenario: none.yaml, observables: [angle_deg]}}\n"),
              HasSubstr("no file"));
}

TEST(Models, ThoseOfTheProjectLoad) {
  int files = 0;
  for (const auto& item : fs::directory_iterator(fs::path(SCREE_SOURCE_DIR) / "scenarios" / "models")) {
    const DiagnosisModelResult loaded = load_model(item.path(), kAssets);
    EXPECT_TRUE(loaded.errors.empty()) << loaded.errors.front().text();
    ++files;
  }
  EXPECT_GE(files, 2);
}

TEST(ScenarioPatch, NestsKeysAndNamesTheFileFromWhereItLies) {
  EXPECT_EQ(
      scenario_patch("/data/scenarios/a.yaml", "/data/runs/x",
                     {"material.mu=0.3", "effects.cohesion.bond_number=1", "material.mu_r=0.2"},
                     {"What it is."}),
      "# What it is.\nextends: \"../../scenarios/a.yaml\"\nmaterial:\n  mu: 0.3\n  mu_r: 0.2\neffects:\n  "
      "cohesion:\n    bond_number: 1\n");
}

}  // namespace
}  // namespace scree
