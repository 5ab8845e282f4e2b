// Study files, good and bad.
#include "cli/ensemble/study_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "scree_version.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class StudyFile : public testing::Test {
 protected:
  ~StudyFile() override { fs::remove(file); }
  StudyResult load(const std::string& options, const std::string& head = "") {
    std::ofstream(file) << head << "options:\n" << options;
    return load_study(file, source / "assets");
  }
  std::string first_error(const std::string& options, const std::string& head = "") {
    const StudyResult r = load(options, head);
    return r.errors.empty() ? "" : r.errors.front().message;
  }
  const fs::path source = SCREE_SOURCE_DIR;
  const fs::path file = fs::temp_directory_path() / ("scree_study_" + std::to_string(getpid()) + ".yaml");
  const std::string a1 = "  - {name: a, scenario: " + (source / "scenarios/thesis/a1.yaml").string();
  const std::string d2 = "  - {name: b, scenario: " + (source / "scenarios/thesis/d2.yaml").string();
};

TEST_F(StudyFile, OptionsHaveTheirCosts) {
  const StudyResult r =
      load(a1 + ", cost_per_load: 40}\n" + d2 + ", cost_per_load: 40, blade_per_hour: 300}\n",
           "seeds: [1, 2]\nrank_by: d50_ratio\n");
  ASSERT_TRUE(r.errors.empty()) << r.errors.front().text();
  ASSERT_EQ(r.study.options.size(), 2u);
  EXPECT_EQ(r.study.rank_by, "d50_ratio");
  EXPECT_EQ(r.study.sweep.points[1].scenario.seeds.size(), 2u);
  EXPECT_DOUBLE_EQ(r.study.options[0].tonnes_per_load, 300);
  EXPECT_DOUBLE_EQ(r.study.options[0].cost_per_t.value(), 40.0 / 300);
  // A load 8 m long at 0.2 m/s: 40 s of the blade.
  EXPECT_NEAR(r.study.options[1].cost_per_t.value(), (40 + 300 * 40.0 / 3600) / 300, 1e-12);
}

TEST_F(StudyFile, WhatCannotBeComparedIsWarnedOf) {
  const auto warnings = [&](const std::string& set, const std::string& head) {
    const StudyResult r = load(a1 + "}\n" + d2 + set + "}\n", head);
    EXPECT_TRUE(r.errors.empty()) << r.errors.front().text();
    return r.warnings;
  };
  EXPECT_THAT(warnings("", "seeds: [1, 2]\n"), testing::IsEmpty());
  EXPECT_THAT(warnings("", "seeds: [1]\n"),
              testing::ElementsAre(HasSubstr("option 'a': not ranked: of one seed"), HasSubstr("option 'b'")));
  EXPECT_THAT(warnings(", set: {output.sections: 5}", "seeds: [1, 2]\n"),
              testing::ElementsAre(HasSubstr("output.sections, and their numbers are not alike: a 6, b 5")));
  EXPECT_THAT(warnings(", set: {experiment.bench.height_m: 12}", "seeds: [1, 2]\n"),
              testing::ElementsAre(HasSubstr("height of the bench (m)")));
}

TEST_F(StudyFile, WrongOnesAreNamed) {
  EXPECT_THAT(first_error(a1 + "}\n"), HasSubstr("options: at least two are needed"));
  EXPECT_THAT(first_error(a1 + "}\n" + a1 + "}\n"), HasSubstr("name: 'a' is there twice"));
  EXPECT_THAT(first_error(a1 + ", blade_per_hour: 3}\n" + d2 + "}\n"), HasSubstr("pushes nothing"));
  EXPECT_THAT(first_error(a1 + ", cost_per_load: -3}\n" + d2 + "}\n"), HasSubstr("must not be below 0"));
  EXPECT_THAT(first_error(a1 + ", colour: red}\n" + d2 + "}\n"), HasSubstr("colour"));
  EXPECT_THAT(first_error(a1 + "}\n" + d2 + "}\n", "rank_by: beauty\n"),
              HasSubstr("rank_by: 'beauty' is none of chi_range"));
  const std::string heap =
      "  - {name: c, scenario: " + (source / "scenarios/repose_lab.yaml").string() + "}\n";
  EXPECT_THAT(first_error(a1 + "}\n" + heap), HasSubstr("this scenario has none"));
}

TEST_F(StudyFile, ThoseOfTheProjectLoad) {
  int files = 0;
  for (const auto& item : fs::directory_iterator(source / "scenarios/studies")) {
    ++files;
    const StudyResult r = load_study(item.path(), source / "assets");
    EXPECT_TRUE(r.errors.empty()) << item.path() << ": " << r.errors.front().text();
  }
  EXPECT_GE(files, 1);
}

}  // namespace
}  // namespace scree
