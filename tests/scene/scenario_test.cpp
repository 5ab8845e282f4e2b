// Scenario files: extends, overrides, the resolved file, the schema, the files of scenarios/.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scree_version.h"
#include "sim/scene/estimate.h"
#include "tests/scene/scenario_fixture.h"

namespace scree {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

const char* const kSmallest = "grading: CM0\nmaterial: {mu: 0.4, mu_r: 0.3}\nexperiment: {type: end_dump}\n";

std::vector<std::string> texts(const ScenarioResult& result) {
  std::vector<std::string> out;
  for (const auto& error : result.errors) out.push_back(error.text());
  return out;
}

TEST(Scenario, SmallestFileTakesTheDefaultsOfTheStructs) {
  const ScenarioFolder folder;
  const ScenarioResult result = folder.load(kSmallest);
  ASSERT_THAT(texts(result), IsEmpty());
  const Scenario& s = result.scenario;
  EXPECT_EQ(s.name, "case");
  EXPECT_EQ(s.material.mu_r, 0.3);
  EXPECT_EQ(s.material.density, Material{}.density);
  EXPECT_EQ(s.grading_file, folder.dir / "assets/gradings/CM0.csv");
  const auto& dump = std::get<EndDump>(s.experiment);
  EXPECT_EQ(dump.payload, EndDump{}.payload);
  EXPECT_EQ(dump.truck.bed_mesh, folder.dir / "assets/meshes/truck_bed.stl");
  EXPECT_FALSE(dump.truck.mu.has_value());
}

TEST(Scenario, AllErrorsOfAFileComeAtOnceInItsOrder) {
  const ScenarioFolder folder;
  EXPECT_THAT(
      folder.messages("engine: x\nmaterial: {mu: -1, mu_r: 0.4}\ngrading: 1\nexperiment: {type: y}\nz: 1\n"),
      ElementsAre(StartsWith("1:9: engine"), StartsWith("2:16: material.mu"), StartsWith("3:10: grading"),
                  StartsWith("4:20: experiment.type"), StartsWith("5:1: unknown key 'z'")));
}

TEST(Scenario, MeshAndGradingFaultsStandAtTheirKeys) {
  const ScenarioFolder folder;
  const std::string tool = "tools: [{name: a, mesh: meshes/broken.stl, keyframes: [{time_s: 0}]}]\n";
  EXPECT_THAT(folder.messages(kSmallest + tool), ElementsAre(StartsWith("4:25: tools[0].mesh: ")));
  EXPECT_THAT(folder.messages("grading: bad\nmaterial: {mu: 0, mu_r: 0}\nexperiment: {type: end_dump}\n"),
              ElementsAre(StartsWith("1:10: grading: ")));
}

TEST(Scenario, HolesInAMeshAreAWarning) {
  const ScenarioFolder folder;
  const auto result = folder.load(std::string(kSmallest) +
                                  "tools: [{name: a, mesh: meshes/open.stl, keyframes: [{time_s: 0}]}]\n");
  EXPECT_THAT(texts(result), IsEmpty());
  EXPECT_THAT(result.warnings, testing::Contains(testing::HasSubstr("case.yaml:4:25: tools[0].mesh: ")));
}

TEST(Scenario, FilesBesideTheScenarioAreFound) {
  const ScenarioFolder folder;
  folder.write("own.csv", "diameter_mm,passing_pct\n200,0\n400,100\n");
  const auto result =
      folder.load("grading: own.csv\nmaterial: {mu: 0, mu_r: 0}\nexperiment: {type: end_dump}\n");
  ASSERT_THAT(texts(result), IsEmpty());
  EXPECT_EQ(result.scenario.grading_file, folder.dir / "own.csv");
}

TEST(Extends, ChildOverridesAndMapsAreMerged) {
  const ScenarioFolder folder;
  folder.write("sub/parent.yaml",
               std::string(kSmallest) + "seeds: [1, 2]\nstop: {speed_m_per_s: 0.01, max_time_s: 9}\n");
  const auto result = folder.load("extends: sub/parent.yaml\nseeds: [7]\nstop: {max_time_s: 20}\n");
  ASSERT_THAT(texts(result), IsEmpty());
  EXPECT_THAT(result.scenario.seeds, ElementsAre(7));
  EXPECT_EQ(result.scenario.stop.speed, 0.01);
  EXPECT_EQ(result.scenario.stop.max_time, 20);
  EXPECT_EQ(result.scenario.material.mu, 0.4);
}

TEST(Extends, ErrorsStandInTheFileOfTheKey) {
  const ScenarioFolder folder;
  folder.write("parent.yaml", std::string(kSmallest) + "stop: {spede: 1}\n");
  EXPECT_THAT(folder.messages("extends: parent.yaml\nseeds: [-1]\n"),
              ElementsAre(StartsWith("2:9: seeds[0]: -1"),
                          StartsWith("DIR/parent.yaml:4:8: unknown key 'spede' in stop")));
}

TEST(Extends, CircleIsReportedWithItsFiles) {
  const ScenarioFolder folder;
  folder.write("a.yaml", "extends: b.yaml\n");
  folder.write("b.yaml", "title: b\nextends: case.yaml\n");
  EXPECT_THAT(
      folder.messages("extends: a.yaml\n"),
      ElementsAre("DIR/b.yaml:2:10: extends: goes in a circle: case.yaml -> a.yaml -> b.yaml -> case.yaml"));
}

TEST(Override, ReplacesAndIsReadAsYaml) {
  const ScenarioFolder folder;
  const auto result = folder.load(kSmallest, {"material.mu=0.5", "seeds=[1,2]", "experiment.dumps=2",
                                              "stop={max_time_s: 5}", "title='a = b'"});
  ASSERT_THAT(texts(result), IsEmpty());
  EXPECT_EQ(result.scenario.material.mu, 0.5);
  EXPECT_THAT(result.scenario.seeds, ElementsAre(1, 2));
  EXPECT_EQ(std::get<EndDump>(result.scenario.experiment).dumps, 2);
  EXPECT_EQ(result.scenario.stop.max_time, 5);
  EXPECT_EQ(result.scenario.title, "a = b");
}

TEST(Override, ErrorsNameIt) {
  const ScenarioFolder folder;
  EXPECT_THAT(folder.messages(kSmallest, {"material.mux=1"}),
              ElementsAre(StartsWith(
                  "--set material.mux=1: unknown key 'mux' in material (did you mean 'mu'?); allowed: ")));
  EXPECT_THAT(folder.messages(kSmallest, {"material.mu=9"}),
              ElementsAre("--set material.mu=9: material.mu: 9 is out of range; allowed 0 to 5"));
  EXPECT_THAT(folder.messages(kSmallest, {"material.mu=["}),
              ElementsAre(StartsWith("--set material.mu=[: not YAML: ")));
  EXPECT_THAT(folder.messages(kSmallest, {"dumps"}),
              ElementsAre("--set dumps: key=value is expected, for example material.mu=0.5"));
  EXPECT_THAT(folder.messages(kSmallest, {"stop..x=1"}),
              ElementsAre("--set stop..x=1: not a key; write it as in material.mu=0.5"));
  EXPECT_THAT(folder.messages(kSmallest, {"extends=a.yaml"}),
              ElementsAre("--set extends=a.yaml: extends can stand in a file only"));
}

TEST(Limits, FilesThatAreNoScenarioAreRefusedQuickly) {
  const ScenarioFolder folder;
  EXPECT_THAT(folder.messages(std::string("a: ").append(400000, '[')),
              ElementsAre(testing::HasSubstr("nested deeper than 32")));
  EXPECT_THAT(folder.messages(std::string(1000001, '#')),
              ElementsAre(testing::HasSubstr("larger than 1 MB; no file of scree is like that")));
  std::string bomb = "a: &a [1,1,1,1,1,1,1,1,1,1]\n";
  for (char c = 'b'; c < 'k'; ++c) {
    const char before = static_cast<char>(c - 1);
    bomb += fmt::format("{0}: &{0} [*{1}", c, before);
    for (int i = 0; i < 9; ++i) bomb += fmt::format(", *{}", before);
    bomb += "]\n";
  }
  EXPECT_THAT(folder.messages(bomb), ElementsAre(testing::HasSubstr("more than 50000 values")));
  std::string many;
  for (int i = 0; i < 1000; ++i) many += fmt::format("k{}: 1\n", i);
  EXPECT_THAT(folder.messages(many), testing::SizeIs(201));
}

TEST(Limits, MissingFileAndFolderAreNamed) {
  const ScenarioFolder folder;
  EXPECT_THAT(texts(load_scenario(folder.dir / "no.yaml", {}, folder.dir)),
              ElementsAre((folder.dir / "no.yaml").string() + ": no such file"));
  EXPECT_THAT(texts(load_scenario(folder.dir, {}, folder.dir)),
              ElementsAre(testing::HasSubstr(": not a file")));
}

TEST(Resolved, IsAScenarioThatResolvesToItself) {
  const ScenarioFolder folder;
  const std::string tool =
      "tools: [{name: 'x: \"y\"', mesh: meshes/truck_bed.stl, mu: 0.1, keyframes: [{time_s: 0, position_m: "
      "[0.1, 1e-7, "
      "-3]}, {time_s: 0.3}]}]\nseeds: [0, 9223372036854775807]\ntitle: \"yes\"\n";
  const std::string lift =
      "grading: lab\nmaterial: {mu: 0.2, mu_r: 0.2}\nexperiment: {type: repose_lift, floor: {mu: 1, "
      "base_layer: mixed}}\n";
  for (const std::string& yaml : {kSmallest + tool, lift}) {
    const auto first = folder.load(yaml);
    ASSERT_THAT(texts(first), IsEmpty());
    EXPECT_EQ(first.scenario.resolved_yaml.find(folder.dir.string()), std::string::npos)
        << "assets are named";
    const auto second = folder.load(first.scenario.resolved_yaml);
    ASSERT_THAT(texts(second), IsEmpty());
    EXPECT_EQ(second.scenario.resolved_yaml, first.scenario.resolved_yaml);
    EXPECT_EQ(second.scenario.title, first.scenario.title);
    EXPECT_EQ(second.scenario.seeds, first.scenario.seeds);
    EXPECT_EQ(second.scenario.grading_file, first.scenario.grading_file);
    ASSERT_EQ(second.scenario.tools.size(), first.scenario.tools.size());
    for (std::size_t i = 0; i < first.scenario.tools.size(); ++i) {
      EXPECT_EQ(second.scenario.tools[i].name, first.scenario.tools[i].name);
      EXPECT_EQ(second.scenario.tools[i].mesh, first.scenario.tools[i].mesh);
      EXPECT_EQ(second.scenario.tools[i].mu, first.scenario.tools[i].mu);
      EXPECT_EQ(second.scenario.tools[i].mu_r, first.scenario.tools[i].mu_r);
      EXPECT_EQ(second.scenario.tools[i].keyframes[0].position,
                first.scenario.tools[i].keyframes[0].position);
    }
  }
}

TEST(Resolved, PayloadKeepsEveryBitThroughTonnes) {
  const ScenarioFolder folder;
  for (const char* payload : {"0.07", "0.003", "1.1", "33.333333333333336", "299.99999999999994", "0.29"}) {
    const auto first = folder.load(kSmallest, {std::string("experiment.payload_t=") + payload});
    ASSERT_THAT(texts(first), IsEmpty());
    const auto second = folder.load(first.scenario.resolved_yaml);
    ASSERT_THAT(texts(second), IsEmpty());
    EXPECT_EQ(std::get<EndDump>(second.scenario.experiment).payload,
              std::get<EndDump>(first.scenario.experiment).payload)
        << payload;
  }
}

/// Whether every key of a resolved scenario (as a tree of names) has a property in the schema.
void collect(const nlohmann::json& schema, const std::string& prefix, std::vector<std::string>& paths) {
  if (!schema.contains("properties")) {
    if (schema.contains("items")) collect(schema["items"], prefix + "[]", paths);
    return;
  }
  EXPECT_EQ(schema["additionalProperties"], false) << prefix;
  for (const auto& [name, property] : schema["properties"].items()) {
    EXPECT_TRUE(property.contains("description")) << prefix << name;
    paths.push_back(prefix + "." + name);
    collect(property, prefix + "." + name, paths);
  }
}

TEST(Schema, IsJsonWithEveryKeyDescribed) {
  const auto schema = nlohmann::json::parse(scenario_schema());
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  std::vector<std::string> paths;
  collect(schema, "", paths);
  for (const char* key : {".extends",
                          ".title",
                          ".engine",
                          ".seeds",
                          ".grading",
                          ".compare",
                          ".material.density_kg_m3",
                          ".material.mu",
                          ".material.mu_r",
                          ".material.effective_modulus_pa",
                          ".material.stiffness_ratio",
                          ".material.local_damping",
                          ".material.damping_reach",
                          ".material.normal_damping_ratio",
                          ".material.shear_damping_ratio",
                          ".experiment.type",
                          ".experiment.bench.height_m",
                          ".experiment.bench.base_layer",
                          ".experiment.bench.base_ball_diameter_m",
                          ".experiment.bench.layer_on_top",
                          ".experiment.truck.bed_mesh",
                          ".experiment.truck.hoist_rate_deg_per_s",
                          ".experiment.dumps",
                          ".experiment.payload_t",
                          ".experiment.points_m",
                          ".experiment.container.mesh",
                          ".experiment.mass_kg",
                          ".experiment.lift_velocity_m_per_s",
                          ".experiment.floor.radius_m",
                          ".tools[].keyframes[].position_m",
                          ".stop.moving_mass_share",
                          ".numerics.impulse_iterations",
                          ".numerics.impulse_friction",
                          ".experiment.blade.velocity_m_per_s",
                          ".experiment.blade.heights_m",
                          ".experiment.blade.passes",
                          ".experiment.blade.left_share",
                          ".experiment.distance_m",
                          ".experiment.side_walls",
                          ".experiment.push_after",
                          ".experiment.rows_m",
                          ".output.further_sections"})
    EXPECT_THAT(paths, testing::Contains(key));
  const auto& mu = schema["properties"]["material"]["properties"]["mu"];
  EXPECT_EQ(mu["minimum"], 0);
  EXPECT_EQ(mu["maximum"], 5);
  const auto& payload = schema["properties"]["experiment"]["properties"]["payload_t"];
  EXPECT_EQ(payload["unit"], "t");
  EXPECT_EQ(payload["default"], 300);
  EXPECT_EQ(schema["properties"]["engine"]["enum"], nlohmann::json({"rrlinear", "impulse"}));
  EXPECT_EQ(schema["then"]["required"], nlohmann::json({"material", "grading", "experiment"}));
}

TEST(Impulse, TakesWhatIsEquivalentUnlessTold) {
  const ScenarioFolder folder;
  const std::string head =
      "grading: CM0\nengine: impulse\nmaterial: {mu: 0.3, mu_r: 0.4}\nexperiment: {type: end_dump}\n";
  const auto bullet = [&](const std::string& text) {
    return folder.load(head + text).scenario.bullet.value();
  };
  EXPECT_DOUBLE_EQ(bullet("").friction, 0.35);
  EXPECT_DOUBLE_EQ(bullet("").rolling, 0.5);
  EXPECT_DOUBLE_EQ(bullet("").error_deg.value(), 1);
  EXPECT_DOUBLE_EQ(bullet("numerics: {impulse_friction: 0.9}\n").friction, 0.9);
  EXPECT_FALSE(bullet("numerics: {impulse_friction: 0.9}\n").error_deg);
  EXPECT_DOUBLE_EQ(bullet("numerics: {impulse_friction: 0.9, impulse_rolling: 0.8}\n").rolling, 0.8);
  EXPECT_DOUBLE_EQ(bullet("numerics: {impulse_friction: equivalent}\n").friction, 0.35);
  EXPECT_FALSE(folder.load(head + "numerics: {impulse_iterations: 50}\n").errors.empty());
  EXPECT_FALSE(
      folder
          .load("grading: CM0\nengine: impulse\nmaterial: {mu: 0.3, mu_r: 0.4, effective_modulus_pa: 1e7}\n"
                "experiment: {type: end_dump}\n")
          .errors.empty());
  EXPECT_TRUE(
      folder.load(head + "numerics: {impulse_iterations: 50, impulse_friction: 0.9, impulse_rolling: 0.8}\n")
          .errors.empty());
  EXPECT_FALSE(folder.load("grading: CM0\nmaterial: {mu: 0.9, mu_r: 0.9}\nexperiment: {type: end_dump}\n")
                   .scenario.bullet);
}

TEST(Estimate, OneSizeIsMassOverTheMassOfASphere) {
  // Nearly one size: N = M / (rho pi/6 d^3) with d = 0.1 m.
  const Grading grading("one", {{0.1, 0}, {0.1000001, 1}});
  const double one = 2760 * 3.14159265358979 / 6 * 1e-3;
  EXPECT_NEAR(expected_spheres(grading, 1000, {2760}), 1000 / one, 1e-5 * 1000 / one);
}

// N = integral of dP M / m(d), with m(d) = rho (d / d0)^e pi/6 d^3; V = integral of dP M / (rho (d / d0)^e).
TEST(Estimate, RockWhoseDensityFollowsItsSize) {
  const Grading grading("two sizes", {{0.1, 0}, {0.1000001, 0.4}, {0.4, 0.4}, {0.4000001, 1}});
  const RockDensity density{2760, 0.5, 0.2};
  double spheres = 0, volume = 0;
  for (const auto& [d, mass] : {std::pair{0.1, 400.0}, std::pair{0.4, 600.0}}) {
    const double here = 2760 * std::sqrt(d / 0.2);
    volume += mass / here;
    spheres += mass / (here * std::numbers::pi / 6 * d * d * d);
  }
  EXPECT_NEAR(expected_spheres(grading, 1000, density), spheres, 1e-5 * spheres);
  EXPECT_NEAR(solid_volume(grading, 1000, density), volume, 1e-5 * volume);
  const Grading wide("wide", {{0.06, 0}, {3, 1}});
  for (const double power : {0.0, 1e-17, 1e-12}) EXPECT_NEAR(mean_inverse_power(wide, power), 1, 1e-11);
  for (const double exponent : {-0.5, 0.0, 0.5}) {
    const RockDensity each{2760, exponent, 0.4};
    const auto made = static_cast<double>(generate_diameters(wide, 60000, each, 1, 1).size());
    EXPECT_NEAR(made, expected_spheres(wide, 60000, each), 0.02 * made) << exponent;
  }
}

TEST(Scenarios, EveryFileOfTheProjectLoads) {
  const std::filesystem::path source = SCREE_SOURCE_DIR;
  int files = 0;
  for (const auto& item : std::filesystem::recursive_directory_iterator(source / "scenarios")) {
    const std::string folder = item.path().parent_path().filename();
    if (item.path().extension() != ".yaml" || folder == "sweeps" || folder == "calibrations" ||
        folder == "studies" || folder == "models")
      continue;
    ++files;
    const auto result = load_scenario(item.path(), {}, source / "assets");
    EXPECT_THAT(texts(result), IsEmpty()) << item.path();
    if (item.path().filename() == "small_dump.yaml")  // as its comment says
      EXPECT_THAT(result.warnings, ElementsAre(testing::HasSubstr("balls of 1 m on a bench 4 m high")));
    else
      EXPECT_THAT(result.warnings, IsEmpty()) << item.path();
  }
  EXPECT_GE(files, 33);
}

}  // namespace
}  // namespace scree
