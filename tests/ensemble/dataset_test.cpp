// Datasets, good and bad.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "cli/ensemble/dataset_file.h"
#include "cli/ensemble/dataset_write.h"
#include "cli/ensemble/file_kind.h"
#include "cli/ensemble/output_scope.h"
#include "cli/ensemble/scenario_patch.h"
#include "scree_version.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class DatasetFile : public testing::Test {
 protected:
  DatasetFile() { fs::create_directories(folder); }
  ~DatasetFile() override { fs::remove_all(folder); }
  void put(const std::string& name, const std::string& text) {
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  // A dataset of a repose test and of a dump with six sections, three beside, and the pile after load 3.
  DatasetResult load(const std::string& table, const std::string& more = "") {
    put("observables.csv", table);
    put("dataset.yaml", "title: A test\nsource: nowhere\nexperiments:\n  heap: {scenario: " +
                            (source / "scenarios/repose_lab.yaml").string() + "}\n  dump:\n    scenario: " +
                            (source / "scenarios/canadian_malartic_10m.yaml").string() +
                            "\n    set: {material.mu: 0.5}\nobservables: observables.csv\n" + more);
    return load_dataset(folder / "dataset.yaml", source / "assets");
  }
  // The only error, as a user reads it; "" without any.
  std::string error(const std::string& table, const std::string& more = "") {
    const DatasetResult r = load(table, more);
    EXPECT_LE(r.errors.size(), 1u) << r.errors.back().text();
    EXPECT_EQ(r.errors.empty(), !r.dataset.observables.empty()) << "nothing partial";
    return r.errors.empty() ? "" : r.errors.front().text();
  }
  const fs::path source = SCREE_SOURCE_DIR;
  const fs::path folder = fs::temp_directory_path() / ("scree_dataset_" + std::to_string(getpid()));
  const std::string head = "experiment,observable,value,unit,std,repeats,uncertainty\n";
  const std::string good = head + "heap,angle_deg,25.4,deg,1.5,9,\n";
};

TEST_F(DatasetFile, SaysWhatWasMeasuredAndHowWell) {
  const DatasetResult r = load(head +
                               "heap,angle_deg,25.4,deg,1.5,9,\n"
                               "dump,chi_S6,0.4,-,0.14,49,0.05\n"
                               "dump,d50_m_S1,24,cm,9,,\n"
                               "dump,chi_S1_dump3,-0.6,,,,0.1\n"
                               "dump,chi_S3of3,27,%,1,4,\n");
  ASSERT_THAT(r.errors, IsEmpty()) << r.errors.front().text();
  const Dataset& d = r.dataset;
  EXPECT_EQ(d.title, "A test");
  EXPECT_EQ(d.name, folder.filename().string());
  ASSERT_EQ(d.experiments.size(), 2u);
  EXPECT_EQ(d.experiments[1].scenario.material.mu, 0.5);
  EXPECT_THAT(d.experiments[1].overrides, ElementsAre("material.mu=0.5"));
  ASSERT_EQ(d.observables.size(), 5u);
  EXPECT_DOUBLE_EQ(d.observables[0].uncertainty, 0.5) << "1.5 / sqrt(9)";
  EXPECT_EQ(d.observables[0].repeats, 9);
  EXPECT_DOUBLE_EQ(d.observables[1].uncertainty, 0.05) << "what is given comes first";
  EXPECT_EQ(d.observables[1].std, 0.14);
  EXPECT_DOUBLE_EQ(d.observables[2].value, 0.24);
  EXPECT_DOUBLE_EQ(d.observables[2].uncertainty, 0.09) << "std alone stands for it";
  EXPECT_THAT(d.notes, ElementsAre(HasSubstr("dump/d50_m_S1")));
  EXPECT_DOUBLE_EQ(d.observables[4].value, 0.27);
  EXPECT_DOUBLE_EQ(d.observables[4].uncertainty, 0.005);
  EXPECT_EQ(d.label(d.observables[3]), "dump/chi_S1_dump3");
  for (Eigen::Index i = 0; i < 5; ++i)
    for (Eigen::Index j = 0; j < 5; ++j)
      EXPECT_DOUBLE_EQ(d.covariance(i, j),
                       i == j ? std::pow(d.observables[static_cast<std::size_t>(i)].uncertainty, 2) : 0);
}

TEST_F(DatasetFile, TablesComeInManyForms) {
  const auto value = [&](const std::string& table) {
    const DatasetResult r = load(table);
    EXPECT_THAT(r.errors, IsEmpty()) << r.errors.front().text();
    return r.errors.empty() ? r.dataset.observables.front().value : NAN;
  };
  EXPECT_EQ(value("VALUE, Observable ,Experiment,Uncertainty\n25.4,angle_deg,heap,1\n"), 25.4);
  EXPECT_EQ(value("experiment;observable;value;uncertainty\r\nheap;angle_deg;25,4;0,5\r\n"), 25.4);
  EXPECT_EQ(value("experiment;observable;value;uncertainty\nheap;angle_deg;25.4;0.5"), 25.4);
  EXPECT_EQ(value("experiment\tobservable\tvalue\tuncertainty\nheap\tangle_deg\t25,4\t0,5\n"), 25.4);
  EXPECT_EQ(value("\xEF\xBB\xBF# says who\n\nexperiment,observable,value,uncertainty\n# and when\n"
                  "\"heap\",\"angle_deg\",\"25.4\",1\n"),
            25.4);
  EXPECT_NEAR(value("experiment,observable,value,unit,uncertainty\nheap,angle_deg,0.5,rad,0.1\n"),
              90 / std::numbers::pi, 1e-12);
  const DatasetResult r = load(
      "experiment,observable,value,uncertainty,who,\"when, and where\"\nheap,angle_deg,1,1,me,\"a, "
      "\"\"b\"\"\"\n");
  EXPECT_THAT(r.dataset.notes, ElementsAre(HasSubstr("not read: who, when, and where")));
}

TEST_F(DatasetFile, WrongRowsAreNamedByLine) {
  const auto row = [&](const std::string& text) { return error(head + "# a comment\n" + text + "\n"); };
  EXPECT_THAT(row("heap,angle_deg,25,deg,,,"),
              HasSubstr("observables.csv:3: heap/angle_deg: no uncertainty. Give"));
  EXPECT_THAT(row("hea,angle_deg,25,deg,,,1"),
              HasSubstr("observables.csv:3: no experiment 'hea' (did you mean 'heap'?)"));
  EXPECT_THAT(row("dump,Chi_s1,-0.6,,,,0.1"), HasSubstr("did you mean 'chi_S1'?"));
  EXPECT_THAT(row("heap,chi_S1,25,,,,1"), HasSubstr("type repose_lift does not give it"));
  EXPECT_THAT(row("dump,chi_S7,1,,,,1"), HasSubstr("cuts the slope into 6 sections"));
  EXPECT_THAT(row("dump,chi_S4of3,1,,,,1"), HasSubstr("and 3 (output.further_sections)"));
  EXPECT_THAT(row("dump,chi_S4of5,1,,,,1"), HasSubstr("output.further_sections"));
  EXPECT_THAT(row("dump,chi_S4of6,1,,,,1"), HasSubstr("6 sections, without 'of'"));
  EXPECT_THAT(row("dump,chi_S4_dump2,1,,,,1"), HasSubstr("output.after_dumps"));
  EXPECT_THAT(row("dump,chi_S4_dump4,1,,,,1"), HasSubstr("the finished one, without '_dump'"));
  EXPECT_THAT(row("heap,angle_deg,steep,,,,1"), HasSubstr(":3: value: 'steep' is no number"));
  EXPECT_THAT(row("heap,angle_deg,nan,,,,1"), HasSubstr("value: nan is not finite"));
  EXPECT_THAT(row("heap,angle_deg,inf,,,,1"), HasSubstr("not finite"));
  EXPECT_THAT(row("heap,angle_deg,,,,,1"), HasSubstr("value is empty"));
  EXPECT_THAT(row("heap,angle_deg,25,,,,0"), HasSubstr("uncertainty must be above 0, found 0"));
  EXPECT_THAT(row("heap,angle_deg,25,,,,-1"), HasSubstr("uncertainty must be above 0"));
  EXPECT_THAT(row("heap,angle_deg,25,,-1,3,"), HasSubstr("std must not be below 0"));
  EXPECT_THAT(row("heap,angle_deg,25,,0,3,"), HasSubstr("std is 0, which makes the value exact"));
  EXPECT_THAT(row("heap,angle_deg,25,,1,2.5,"), HasSubstr("repeats must be an integer from 1 on"));
  EXPECT_THAT(row("heap,angle_deg,25,mm,,,1"), HasSubstr("unit 'mm' does not fit; allowed: deg, rad"));
  EXPECT_THAT(row("dump,mass_t_S1,25,stone,,,1"), HasSubstr("unit 'stone' does not fit; allowed: t, kg"));
  EXPECT_THAT(row("heap,angle_deg,25,4,,,,1"), HasSubstr("decimal, separate fields by semicolons"));
  EXPECT_THAT(row("heap,angle_deg,25"), HasSubstr("3 fields, but the header has 7"));
  EXPECT_THAT(row("heap,\"angle_deg,25,,,,1"), HasSubstr("a field in quotes does not end"));
  EXPECT_THAT(row("heap,angle_deg,25,,,,1\nheap,angle_deg,26,,,,1"),
              HasSubstr(":4: heap/angle_deg stands already in line 3"));
}

TEST_F(DatasetFile, EveryWrongRowIsNamed) {
  const DatasetResult r =
      load(head + "heap,angle_deg,x,,,,1\nheap,spread_95,y,,,,1\nheap,profile_25,1,,,,1\n");
  ASSERT_EQ(r.errors.size(), 2u);
  EXPECT_EQ(r.errors[1].line, 3);
  EXPECT_TRUE(r.dataset.experiments.empty());
}

TEST_F(DatasetFile, WrongFilesAreNamed) {
  EXPECT_THAT(error(""), HasSubstr("observables.csv: the file is empty"));
  EXPECT_THAT(error("# only words\n"), HasSubstr("no header"));
  EXPECT_THAT(error(head), HasSubstr("nothing measured below it"));
  EXPECT_THAT(error("experiment,value\nheap,1\n"), HasSubstr(":1: the header has no observable"));
  EXPECT_THAT(error("experiment,value,Value\nheap,1,2\n"), HasSubstr("'Value' stands twice in the header"));
  EXPECT_THAT(error(std::string("\x89PNG\r\n\x1A\n\0\0\0\rIHDR", 16)), HasSubstr("is a picture, no text"));
  EXPECT_THAT(error(std::string("\xFF\xFE"
                                "e\0x\0",
                                6)),
              HasSubstr("UTF-16; save it as UTF-8"));
  EXPECT_THAT(error(good, "observable: x\n"),
              HasSubstr("unknown key 'observable' (did you mean 'observables'?)"));
  EXPECT_THAT(error(good, "default_relative_uncertainty: 0\n"), HasSubstr("must be above 0"));
  EXPECT_THAT(error(good, "covariance: none.csv\n"), HasSubstr("covariance: no file"));
  put("a.yaml", "title: x\n");
  EXPECT_EQ(load_dataset(folder / "a.yaml", source / "assets").errors.size(), 2u)
      << "experiments, observables";
  EXPECT_FALSE(load_dataset(folder / "b.yaml", source / "assets").errors.empty());
  EXPECT_EQ(kind_of(folder / "dataset.yaml"), FileKind::dataset);
  EXPECT_NE(kind_of(folder / "a.yaml"), FileKind::dataset);
  EXPECT_NE(kind_of(folder / "b.yaml"), FileKind::dataset);
}

TEST_F(DatasetFile, DefaultUncertaintyIsStated) {
  const DatasetResult r =
      load(head + "heap,angle_deg,25,,,,1\nheap,spread_95,1.5,,,,\n", "default_relative_uncertainty: 0.1\n");
  ASSERT_THAT(r.errors, IsEmpty());
  EXPECT_DOUBLE_EQ(r.dataset.observables[1].uncertainty, 0.15);
  EXPECT_THAT(r.dataset.notes, ElementsAre(HasSubstr("1 of 2 uncertainties are assumed: 10 %")));
  EXPECT_THAT(error(head + "heap,chi_ring1,0,,,,\n", "default_relative_uncertainty: 0.1\n"),
              HasSubstr("relative uncertainty says nothing"));
  EXPECT_THAT(error(head + "heap,angle_deg,25,,,,\nheap,spread_95,1.5,,,,\n"), HasSubstr("and 1 other rows"));
}

TEST_F(DatasetFile, CovarianceIsInTheUnitsOfTheTable) {
  const std::string table = head +
                            "heap,angle_deg,25,deg,,,1\n"
                            "dump,d50_m_S1,24,cm,,,2\n"
                            "dump,chi_S6,0.4,,,,\n";
  put("c.csv", "name,dump/d50_m_S1,dump/chi_S6\ndump/chi_S6,0.1,0.04\ndump/d50_m_S1,4,0.1\n");
  const DatasetResult r = load(table, "covariance: c.csv\n");
  ASSERT_THAT(r.errors, IsEmpty()) << r.errors.front().text();
  const auto& c = r.dataset.covariance;
  EXPECT_DOUBLE_EQ(c(0, 0), 1);
  EXPECT_DOUBLE_EQ(c(0, 1), 0);
  EXPECT_DOUBLE_EQ(c(1, 1), 0.0004) << "4 cm2";
  EXPECT_DOUBLE_EQ(c(1, 2), 0.001) << "0.1 cm";
  EXPECT_DOUBLE_EQ(c(2, 1), 0.001);
  EXPECT_DOUBLE_EQ(r.dataset.observables[2].uncertainty, 0.2) << "its row has none";
}

TEST_F(DatasetFile, WrongCovariancesAreRefused) {
  const std::string table = head + "heap,angle_deg,25,deg,,,1\nheap,spread_95,1.5,,,,1\n";
  const auto covariance = [&](const std::string& text) {
    put("c.csv", text);
    return error(table, "covariance: c.csv\n");
  };
  const std::string names = "x,heap/angle_deg,heap/spread_95\n";
  EXPECT_EQ(covariance(names + "heap/angle_deg,1,0.5\nheap/spread_95,0.5,1\n"), "");
  EXPECT_THAT(covariance(names + "heap/angle_deg,1,0.5\nheap/spread_95,0.4,1\n"),
              HasSubstr("is not symmetric"));
  EXPECT_THAT(covariance(names + "heap/angle_deg,1,1.1\nheap/spread_95,1.1,1\n"),
              HasSubstr("not positive definite"));
  EXPECT_THAT(covariance(names + "heap/angle_deg,1,1\nheap/spread_95,1,1\n"),
              HasSubstr("not positive definite"));
  EXPECT_THAT(covariance(names + "heap/angle_deg,0,0\nheap/spread_95,0,1\n"), HasSubstr("must be above 0"));
  EXPECT_THAT(covariance(names + "heap/angle_deg,4,0\nheap/spread_95,0,1\n"), HasSubstr("its row says 1"));
  EXPECT_THAT(covariance(names + "heap/angle_deg,1,0\n"),
              HasSubstr("is not square: row 'heap/spread_95' is missing"));
  EXPECT_THAT(covariance(names + "heap/angle_deg,1,\nheap/spread_95,0,1\n"), HasSubstr("is empty"));
  EXPECT_THAT(covariance("x,heap/angle_deg,heap/height_m\n"),
              HasSubstr("no observable 'heap/height_m' is measured"));
}

TEST_F(DatasetFile, WrongExperimentsAreNamed) {
  put("observables.csv", good);
  const auto experiments = [&](const std::string& text) {
    put("dataset.yaml", "experiments: " + text + "\nobservables: observables.csv\n");
    const DatasetResult r = load_dataset(folder / "dataset.yaml", source / "assets");
    return r.errors.empty() ? "" : r.errors.front().text();
  };
  const std::string scenario = (source / "scenarios/repose_lab.yaml").string();
  EXPECT_EQ(experiments("{heap: {scenario: " + scenario + "}}"), "");
  EXPECT_THAT(experiments("{heap: {scenario: nowhere.yaml}}"), HasSubstr("no file"));
  EXPECT_THAT(experiments("{heap: {scenario: " + scenario + ", set: {material.nu: 1}}}"),
              HasSubstr("experiments.heap is no scenario"));
  EXPECT_THAT(experiments("{a/b: {scenario: " + scenario + "}}"), HasSubstr("must be a word"));
  EXPECT_THAT(experiments("[heap]"), HasSubstr("experiments: a map"));
}

TEST_F(DatasetFile, FilesThatItSetsLieBesideIt) {
  put("observables.csv", good);
  fs::copy_file(source / "assets/gradings/Lab0.csv", folder / "my sieve: 1.csv");
  const auto grading = [&](const fs::path& dataset) {
    const DatasetResult r = load_dataset(dataset, source / "assets");
    return r.errors.empty() ? r.dataset.experiments.front()
                            : Dataset::Experiment{r.errors.front().text(), {}, {}, {}};
  };
  put("dataset.yaml", "experiments: {heap: {scenario: " + (source / "scenarios/repose_lab.yaml").string() +
                          ", set: {grading: 'my sieve: 1.csv'}}}\nobservables: observables.csv\n");
  const Dataset::Experiment read = grading(folder / "dataset.yaml");
  EXPECT_EQ(read.name, "heap");
  EXPECT_EQ(read.scenario.grading_file, folder / "my sieve: 1.csv");
  // Handed over to a scenario or a dataset in another folder, it is the same file.
  fs::create_directories(folder / "other");
  put("other/patch.yaml", scenario_patch(read.file, folder / "other", read.overrides, {}));
  const ScenarioResult patched = load_scenario(folder / "other/patch.yaml", {}, source / "assets");
  ASSERT_THAT(patched.errors, IsEmpty()) << patched.errors.front().text();
  EXPECT_EQ(patched.scenario.grading_file, read.scenario.grading_file);
  DatasetDraft draft;
  draft.experiments.push_back({"heap", read.file, read.overrides, {{"angle_deg", {25, 2, 4}}}});
  write_dataset(draft, folder / "other");
  EXPECT_EQ(grading(folder / "other/dataset.yaml").scenario.grading_file, read.scenario.grading_file);
  // Of one made on the command line files are found from where the command is called.
  const fs::path before = fs::current_path();
  fs::current_path(folder);
  draft.experiments.front().overrides = {"grading=my sieve: 1.csv"};
  write_dataset(draft, folder / "other");
  fs::current_path(before);
  EXPECT_EQ(grading(folder / "other/dataset.yaml").scenario.grading_file, read.scenario.grading_file);
}

TEST_F(DatasetFile, ThatIsWrittenCanBeRead) {
  DatasetDraft draft;
  draft.title = "with \"quotes\" and \\";
  draft.experiments.push_back(
      {"heap",
       source / "scenarios/repose_lab.yaml",
       {"material.mu=0.3"},
       {{"angle_deg", {25, 2, 4}}, {"runaways", {3, 0, 4}}, {"spread_95", {1.5, NAN, 1}}}});
  EXPECT_THAT(write_dataset(draft, folder), ElementsAre("heap/runaways", "heap/spread_95"));
  DatasetResult r = load_dataset(folder / "dataset.yaml", source / "assets");
  ASSERT_THAT(r.errors, IsEmpty()) << r.errors.front().text();
  EXPECT_EQ(r.dataset.title, draft.title);
  EXPECT_EQ(r.dataset.experiments[0].scenario.material.mu, 0.3);
  ASSERT_EQ(r.dataset.observables.size(), 1u);
  EXPECT_DOUBLE_EQ(r.dataset.observables[0].uncertainty, 1);
  draft.relative_uncertainty = 0.2;
  EXPECT_THAT(write_dataset(draft, folder), ElementsAre("heap/runaways"));
  r = load_dataset(folder / "dataset.yaml", source / "assets");
  ASSERT_EQ(r.dataset.observables.size(), 2u);
  EXPECT_DOUBLE_EQ(r.dataset.observables[1].uncertainty, 0.3);
}

TEST_F(DatasetFile, ThoseOfTheProjectLoad) {
  int files = 0;
  for (const auto& item : fs::directory_iterator(source / "assets/datasets")) {
    if (!item.is_directory()) continue;
    ++files;
    const DatasetResult r = load_dataset(item.path() / "dataset.yaml", source / "assets");
    ASSERT_THAT(r.errors, IsEmpty()) << r.errors.front().text();
    EXPECT_FALSE(r.dataset.source.empty()) << item.path();
    EXPECT_THAT(r.dataset.notes, IsEmpty()) << item.path();
  }
  EXPECT_EQ(files, 6);
}

// Line 1549 of the source: chi at top, middle, bottom; tables B.1, C.15.
TEST_F(DatasetFile, LaboratoryIsAsPrinted) {
  const DatasetResult r = load_dataset(source / "assets/datasets/laboratory/dataset.yaml", source / "assets");
  const auto row = [&](const std::string& name) {
    for (const auto& each : r.dataset.observables)
      if (r.dataset.label(each) == name) return each;
    ADD_FAILURE() << name;
    return Dataset::Observable{};
  };
  EXPECT_NEAR(row("segregation/chi_top").value, -0.02, 0.005);
  EXPECT_NEAR(*row("segregation/chi_top").std, 0.14, 0.01);
  EXPECT_NEAR(row("segregation/chi_middle").value, 0.18, 0.005);
  EXPECT_NEAR(row("segregation/chi_bottom").value, 0.35, 0.005);
  EXPECT_NEAR(row("repose/angle_deg").value, 25.4, 0.05);
  EXPECT_NEAR(row("repose/angle_deg").uncertainty, 1.5 / std::sqrt(10), 0.01);
  EXPECT_NEAR(row("segregation/d50_m_bottom").value, 0.059, 0.0001);
}

}  // namespace
}  // namespace scree
