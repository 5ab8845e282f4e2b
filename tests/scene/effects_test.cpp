// Effects as scenarios use them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "scree_version.h"
#include "sim/effects/describe.h"
#include "sim/scene/run.h"
#include "tests/scene/scenario_fixture.h"

namespace scree {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const char* const kDump = "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.3}\nexperiment: {type: end_dump}\n";

TEST(EffectList, IsFitForUse) {
  std::set<std::string_view> names;
  for (const Effect& effect : all_effects()) {
    EXPECT_TRUE(names.insert(effect.name).second) << effect.name;
    for (const std::string_view text : {effect.title, effect.doc, effect.equation, effect.source})
      EXPECT_GT(text.size(), 10) << effect.name;
    ASSERT_FALSE(effect.parameters.empty());
    const EffectParameter& amplitude = effect.parameters.front();
    EXPECT_LE(amplitude.low, effect.absent) << effect.name;
    EXPECT_GE(amplitude.high, effect.absent) << effect.name;
    EXPECT_NE(amplitude.standard, effect.absent) << effect.name;
    for (const EffectParameter& p : effect.parameters) {
      EXPECT_LE(p.low, p.prior_low) << effect.name;
      EXPECT_GE(p.high, p.prior_high) << effect.name;
      EXPECT_LE(p.prior_low, p.standard) << effect.name;
      EXPECT_GE(p.prior_high, p.standard) << effect.name;
    }
  }
  EXPECT_EQ(find_effect("cohesion")->name, "cohesion");
  EXPECT_EQ(find_effect("magic"), nullptr);
}

TEST(Effects, ReferToOneSizeInRockOfAnyGrading) {
  ScenarioFolder folder;
  const std::string tail =
      "effects: {reference: {diameter_m: 0.03}, friction_by_size: {exponent: 0.5}, density_by_size: "
      "{exponent: 0.1}}\n";
  for (const std::string grading : {"CM0", "lab"}) {
    const auto given = folder.load(
        "grading: " + grading + "\nmaterial: {mu: 0.4, mu_r: 0.3}\nexperiment: {type: drop_test}\n" + tail);
    ASSERT_THAT(given.errors, IsEmpty()) << given.errors.front().text();
    const EffectiveModel model = effective_model(given.scenario);
    EXPECT_DOUBLE_EQ(model.changes.contact.reference_diameter, 0.03);
    EXPECT_DOUBLE_EQ(model.material.density_diameter, 0.03);
    EXPECT_THAT(given.scenario.resolved_yaml, HasSubstr("diameter_m: 0.03"));
  }
  const auto own = folder.load(std::string(kDump) + "effects: {friction_by_size: {exponent: 0.5}}\n");
  const EffectiveModel model = effective_model(own.scenario);
  EXPECT_DOUBLE_EQ(model.changes.contact.reference_diameter, model.grading.diameter(0.5));
  EXPECT_EQ(own.scenario.resolved_yaml.find("reference"), std::string::npos);
}

// An effect that is there changes something, and nothing at the amplitude that means absent.
TEST(EffectList, AbsentMeansAbsent) {
  const auto differs = [](const Modifications& m) {
    const Modifications none;
    return !m.contact.none() || m.flight_damping != none.flight_damping ||
           m.normal_damping_ratio != none.normal_damping_ratio || m.ground_mu != none.ground_mu ||
           m.ground_mu_r != none.ground_mu_r || m.tool_surface_energy != none.tool_surface_energy ||
           m.density_exponent != none.density_exponent || m.fines_share != none.fines_share ||
           m.release_speed != none.release_speed || m.vibration.on() || m.breakage.on() || m.clumps.on() ||
           !m.measurement.truthful();
  };
  for (const Effect& effect : all_effects()) {
    EffectUse use{&effect, {}};
    for (const EffectParameter& p : effect.parameters) use.values.push_back(p.standard);
    EXPECT_TRUE(differs(modifications(std::span(&use, 1), {}))) << effect.name;
    use.values.front() = effect.absent;
    EXPECT_FALSE(differs(modifications(std::span(&use, 1), {}))) << effect.name;
  }
}

TEST(EffectList, IsTheDocument) {
  std::ifstream file(std::filesystem::path(SCREE_SOURCE_DIR) / "docs/effects.md");
  const std::string there{std::istreambuf_iterator<char>(file), {}};
  EXPECT_TRUE(there == effects_document())
      << "docs/effects.md is not what the effects say; renew it: scree effects --document > docs/effects.md";
  for (const Effect& effect : all_effects())
    EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(SCREE_SOURCE_DIR) / "docs/pictures/effects" /
                                        (std::string(effect.name) + ".svg")))
        << effect.name << ": docs/pictures/effects/make.sh " << effect.name;
}

TEST(ScenarioEffects, AreReadWithTheirDefaults) {
  const ScenarioFolder folder;
  const auto result =
      folder.load(std::string(kDump) + "effects:\n  weakening: {speed_m_per_s: 0.5}\n  cohesion: {}\n");
  ASSERT_THAT(result.errors, IsEmpty());
  const Scenario& s = result.scenario;
  ASSERT_EQ(s.effects.size(), 2);
  EXPECT_EQ(s.effects[0].effect->name, "cohesion");  // in the order of the list, not of the file
  EXPECT_THAT(s.effects[0].values, ElementsAre(find_effect("cohesion")->parameters[0].standard));
  EXPECT_THAT(s.effects[1].values, ElementsAre(find_effect("weakening")->parameters[0].standard, 0.5));
}

TEST(ScenarioEffects, AreSetFromTheCommandLine) {
  const ScenarioFolder folder;
  const auto result = folder.load(kDump, {"effects.cohesion.bond_number=0.25"});
  ASSERT_THAT(result.errors, IsEmpty());
  ASSERT_EQ(result.scenario.effects.size(), 1);
  EXPECT_EQ(result.scenario.effects[0].values[0], 0.25);
}

TEST(ScenarioEffects, ResolvedFileHoldsThemAndOnlyThem) {
  const ScenarioFolder folder;
  EXPECT_THAT(folder.load(kDump).scenario.resolved_yaml, testing::Not(HasSubstr("effects")));
  const auto once = folder.load(kDump, {"effects.weakening.share=0.25"});
  EXPECT_THAT(once.scenario.resolved_yaml,
              HasSubstr("effects:\n  weakening:\n    share: 0.25\n    speed_m_per_s: 0.3\nstop:"));
  const auto again = folder.load(once.scenario.resolved_yaml);
  ASSERT_THAT(again.errors, IsEmpty());
  EXPECT_EQ(again.scenario.resolved_yaml, once.scenario.resolved_yaml);
}

TEST(ScenarioEffects, FaultsAreSaidAtTheirPlace) {
  const ScenarioFolder folder;
  EXPECT_THAT(folder.messages(std::string(kDump) + "effects: {cohesoin: {bond_number: 1}}\n"),
              ElementsAre(testing::AllOf(HasSubstr("4:11: unknown key 'cohesoin' in effects"),
                                         HasSubstr("did you mean 'cohesion'"))));
  EXPECT_THAT(folder.messages(std::string(kDump) + "effects: {cohesion: {bond_number: -1}}\n"),
              ElementsAre(HasSubstr("effects.cohesion.bond_number: -1 is out of range; allowed 0 to 100")));
  EXPECT_THAT(folder.messages(std::string(kDump) + "effects: {cohesion: 1}\n"),
              ElementsAre(HasSubstr("effects.cohesion: a map of keys is expected, found '1'")));
  EXPECT_THAT(folder.messages(std::string(kDump) + "effects: [cohesion]\n"),
              ElementsAre(HasSubstr("effects: a map of keys is expected, found a list")));
  EXPECT_THAT(
      folder.messages(std::string(kDump) + "effects: {section_borders: {shift: 1}}\n"),
      ElementsAre(HasSubstr("effects.section_borders.shift: 1 is out of range; allowed -0.9 to 0.9")));
  EXPECT_THAT(folder.messages(std::string(kDump) +
                              "output: {trajectory: false}\neffects: {breakage: {}, clumps: {}}\n"),
              ElementsAre(HasSubstr("effects: clumps and breakage do not go together; take one of them")));
  EXPECT_THAT(folder.messages(std::string(kDump) +
                              "output: {trajectory: false}\neffects: {breakage: {fragility: 1}}\n"),
              ElementsAre(HasSubstr("unknown key 'fragility' in effects.breakage")));
  EXPECT_THAT(
      folder.messages(std::string(kDump) + "effects: {vibration: {frequency_hz: 0}}\n"),
      ElementsAre(HasSubstr("effects.vibration.frequency_hz: 0 is out of range; allowed 0.1 to 200 Hz")));
  EXPECT_THAT(
      folder.messages(
          std::string(kDump) +
          "engine: impulse\nnumerics: {impulse_friction: 1, impulse_rolling: 1}\neffects: {cohesion: {}}\n"),
      ElementsAre(HasSubstr("effects: engine impulse has none")));
}

TEST(ScenarioEffects, ThatChangeNothingAreAWarning) {
  const ScenarioFolder folder;
  const auto result =
      folder.load("grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.3}\nexperiment: {type: drop_test}\n",
                  {"effects.release_speed.speed_m_per_s=1"});
  EXPECT_THAT(result.errors, IsEmpty());
  EXPECT_THAT(result.warnings,
              ElementsAre("effects.release_speed: changes nothing in an experiment of type drop_test"));
}

TEST(ScenarioEffects, ThatChangeNothingInThisScenarioAreAWarning) {
  const ScenarioFolder folder;
  const auto warnings = [&](const std::string& effect, const std::string& key) {
    const auto result = folder.load(kDump, {effect, key});
    EXPECT_THAT(result.errors, IsEmpty());
    return result.warnings;
  };
  // A load gets its speed when the gate of a tilted bed opens; a level one slides only when it is hoisted.
  const std::string speed = "effects.release_speed.speed_m_per_s=1";
  EXPECT_THAT(warnings(speed, "experiment.truck.release=open_gate"), IsEmpty());
  EXPECT_THAT(
      warnings(speed, "experiment.truck.release=hoist"),
      ElementsAre("effects.release_speed: changes nothing without experiment.truck.release open_gate"));
  // Damping of contacts alone does not act in flight.
  const std::string undamped = "effects.undamped_flight.share=1";
  EXPECT_THAT(warnings(undamped, "material.damping_reach=always"), IsEmpty());
  EXPECT_THAT(warnings(undamped, "material.damping_reach=contacts"),
              ElementsAre("effects.undamped_flight: changes nothing without material.damping_reach always"));
}

TEST(ScenarioEffects, FragmentsHaveNoRowsInATrajectory) {
  const ScenarioFolder folder;
  const std::string breaks = std::string(kDump) + "effects: {breakage: {}}\n";
  EXPECT_THAT(folder.messages(breaks),
              ElementsAre(HasSubstr("effects.breakage: a trajectory has a row for each grain put in")));
  EXPECT_THAT(folder.messages(breaks, {"output.trajectory=false"}), IsEmpty());
  EXPECT_THAT(folder.messages(breaks, {"effects.breakage.fragility_kg_per_j=0"}), IsEmpty());
  // Ensembles write no trajectory, whatever the file says.
  EXPECT_THAT(
      load_scenario(folder.write("numbers.yaml", breaks), {}, folder.dir / "assets", ReadFor::numbers).errors,
      IsEmpty());
}

// Two grains of 0.3 m of density 2700 weigh 374.46 N each; gamma = weight / (2 pi 0.3 m / 4), and the section
// is pi/4 (0.3 m)^2 = 0.070686 m2. A plane has twice the effective radius of a pair.
TEST(ScenarioEffects, CohesionIsToldInUnits) {
  const ScenarioFolder folder;
  const auto words = [&](const std::string& effect) {
    return effects_in_words(
        folder
            .load(kDump, {"material.density_kg_m3=2700", "effects.reference.diameter_m=0.3",
                          "effects." + effect + ".bond_number=0.5"})
            .scenario);
  };
  EXPECT_THAT(words("cohesion"),
              ElementsAre("cohesion: bond_number 0.5; gamma 397.3 J/m2, two grains of 0.3 m pull each other "
                          "with 187.2 N, or 2.65 kPa over their section"));
  EXPECT_THAT(words("sticky_tools"),
              ElementsAre("sticky_tools: bond_number 0.5; gamma 198.7 J/m2, a tool pulls a grain of 0.3 m "
                          "with 187.2 N, or 2.65 kPa over its section"));
  EXPECT_THAT(effects_in_words(folder.load(kDump, {"effects.weakening.share=0.25"}).scenario),
              ElementsAre("weakening: share 0.25, speed_m_per_s 0.3"));
  EXPECT_THAT(effects_in_words(folder.load(kDump, {"effects.cohesion.bond_number=0"}).scenario),
              ElementsAre("cohesion: bond_number 0"));
}

// With fines the grading begins at its smallest diameter over the ratio, and their share passes it.
TEST(MissingFines, GradingGoesOnBelow) {
  const ScenarioFolder folder;
  const auto result = folder.load(kDump, {"effects.missing_fines.share=0.2"});
  const Grading with = effective_model(result.scenario).grading;
  EXPECT_DOUBLE_EQ(with.min_diameter(), 0.05);
  EXPECT_DOUBLE_EQ(with.passing(0.1), 0.2);
  EXPECT_DOUBLE_EQ(with.passing(0.05 * std::sqrt(2)), 0.1);  // evenly in log d
  const Grading without = read_grading(result.scenario.grading_file);
  for (const double d : {0.2, 0.5, 0.9}) EXPECT_NEAR(with.passing(d), 0.2 + 0.8 * without.passing(d), 1e-12);
}

// Small heaps of lab rock: a second of computing each.
Scenario heap(const std::vector<std::string>& overrides) {
  const std::filesystem::path source = SCREE_SOURCE_DIR;
  std::vector<std::string> all{"experiment.mass_kg=8", "stop.max_time_s=2", "output.trajectory=false"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  auto result = load_scenario(source / "scenarios/repose_lab_coarse.yaml", all, source / "assets");
  for (const auto& error : result.errors) ADD_FAILURE() << error.text();
  return result.scenario;
}

std::vector<Grain> run(const std::vector<std::string>& overrides, int threads = 1) {
  return run_scenario(heap(overrides), 10001, threads, {}).final_state.grains;
}

bool same(const std::vector<Grain>& a, const std::vector<Grain>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Grain& p, const Grain& q) {
    return p.position == q.position && p.velocity == q.velocity;
  });
}

// Fragments take numbers that no later load gets, and no grain is lost or made.
TEST(Breakage, LoadsThatComeLaterKeepTheirNumbers) {
  const std::filesystem::path source = SCREE_SOURCE_DIR;
  auto loaded =
      load_scenario(source / "scenarios/thesis/lab_segregation.yaml",
                    {"grading=Lab0_16mm", "experiment.buckets=2", "experiment.mass_kg=4", "stop.max_time_s=1",
                     "compare=[]", "effects.breakage.fragility_kg_per_j=1", "output.trajectory=false"},
                    source / "assets");
  for (const auto& error : loaded.errors) ADD_FAILURE() << error.text();
  const RunOutcome outcome = run_scenario(loaded.scenario, 10001, 1, {});
  EXPECT_GT(outcome.statistics.broken_spheres, 0);
  double put_in = 0, there = outcome.statistics.lost_mass;
  std::set<std::int64_t> ids;
  for (const Grain& g : outcome.original) put_in += g.mass;
  for (const Grain& g : outcome.final_state.grains) {
    there += g.mass;
    EXPECT_TRUE(ids.insert(g.id).second) << g.id;
    const auto id = static_cast<std::size_t>(g.id);
    EXPECT_TRUE(id >= outcome.original.size() || g.dump == outcome.original[id].dump) << g.id;
  }
  EXPECT_NEAR(there, put_in, 1e-9 * put_in);
}

// At the amplitude that means absent the numbers are those of the base model. The vector kernel for effects
// computes the same as the plain one when its factors are 1: an exponent of 1e-300 switches it on.
TEST(ScenarioEffects, BaseModelIsUntouched) {
  const auto base = run({});
  EXPECT_TRUE(same(base, run({"effects.cohesion.bond_number=0"})));
  EXPECT_TRUE(same(base, run({"effects.vibration.acceleration_g=0", "effects.breakage.fragility_kg_per_j=0",
                              "effects.image_blur.width=0"})));
  EXPECT_TRUE(same(base, run({"effects.image_blur.width=0.5", "effects.detection_limit.ratio=0.5",
                              "effects.section_borders.shift=0.3"})));  // act on what is analysed
  EXPECT_TRUE(same(base, run({"effects.friction_by_size.exponent=1e-300"})));
  EXPECT_FALSE(same(base, run({"effects.friction_by_size.exponent=0.3"})));
}

TEST(ScenarioEffects, NumbersDoNotDependOnThreads) {
  const std::vector<std::string> effects{
      "effects.cohesion.bond_number=0.5",     "effects.twisting.mu_t=0.2",
      "effects.weakening.share=0.3",          "effects.rolling_by_size.exponent=0.4",
      "effects.sticky_tools.bond_number=0.5", "effects.breakage.fragility_kg_per_j=1",
      "effects.vibration.acceleration_g=0.3"};
  const auto one = run(effects, 1);
  EXPECT_TRUE(same(one, run(effects, 2)));
  EXPECT_TRUE(same(one, run(effects, 4)));
}

}  // namespace
}  // namespace scree
