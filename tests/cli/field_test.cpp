// scree field as a user meets it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "scree_version.h"
#include "tests/cli/call.h"

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

namespace {

class Field : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("scree_field_" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return (folder / name).string();
  }
  // Ten pictures of two sections, the lower one coarser, and its whole.
  std::string table() {
    std::string text = "image,section,d10_cm,d50_cm,d90_cm\n";
    for (int k = 0; k < 10; ++k) {
      const double size = 1 + 0.05 * (k * 7 % 10);
      const auto row = [&](const char* section, double scale) {
        text += std::to_string(k) + "," + section;
        for (const double d : {10.0, 30.0, 90.0}) text += ',' + std::to_string(d * size * scale);
        text += "\n";
      };
      row("whole", 1), row("S1", 0.6 + 0.01 * (k * 3 % 7)), row("S2", 1.2 + 0.01 * (k % 4));
    }
    return write("gradings.csv", text);
  }
  fs::path folder;
  const std::string source = SCREE_SOURCE_DIR;
};

// The report of every command goes through the same PageFigures and tell_report.
TEST_F(Field, PicturesThatGnuplotRefusesCostNoReport) {
  std::ofstream(folder / "gnuplot") << "#!/bin/sh\necho 'no range' >&2\nexit 1\n";
  fs::permissions(folder / "gnuplot", fs::perms::owner_all);
  const fs::path out = folder / "out";
  const Called run = called("PATH=" + folder.string() + ":$PATH " SCREE_BINARY " field " + table() +
                            " --out " + out.string());
  EXPECT_EQ(run.code, 1) << run.text;
  EXPECT_THAT(run.text,
              AllOf(HasSubstr("the report lacks a picture: gnuplot failed on"), HasSubstr("report: ")));
  EXPECT_THAT(slurp(out / "report.html"), HasSubstr("A picture is missing: gnuplot failed on"));
}

TEST_F(Field, ReportTablesAndDataset) {
  const std::string out = (folder / "out").string();
  const Called called =
      call("field " + table() + " --sieved " + source + "/assets/gradings/G0.csv --limit 20cm --scenario " +
           source + "/scenarios/quick_dump.yaml --observables chi,d50_m --out " + out);
  ASSERT_EQ(called.code, 0) << called.text;
  EXPECT_THAT(called.text, AllOf(HasSubstr("10 pictures in 2 sections"), HasSubstr("4 observables"),
                                 HasSubstr("report: ")));
  for (const char* file :
       {"report.html", "sections.csv", "pictures.csv", "envelopes.csv", "histograms.csv", "chi_fit.csv",
        "ksat.csv", "median_whole.csv", "corrected_whole.csv", "dataset/dataset.yaml",
        "dataset/covariance.csv", "pictures/envelopes.svg", "pictures/ksat.svg"})
    EXPECT_GT(fs::file_size(fs::path(out) / file), 50u) << file;
  std::ifstream in(fs::path(out) / "pictures/correction.svg");
  const std::string fines{std::istreambuf_iterator<char>(in), {}};
  EXPECT_THAT(fines, HasSubstr("stroke-dasharray")) << "its caption calls the line at the limit dotted";
  const Called checked = call("validate " + out + "/dataset/dataset.yaml");
  EXPECT_EQ(checked.code, 0) << checked.text;
  // The curve with fines is a grading that a scenario takes, and far too fine for a load.
  const Called scenario =
      call("validate " + source + "/scenarios/quick_dump.yaml --set grading=" + out + "/corrected_whole.csv");
  EXPECT_THAT(scenario.text, HasSubstr("million spheres (1 dumps of 60 t of corrected_whole)"));
  EXPECT_EQ(call("field " + table() + " --out " + out).code, 2);  // it is there already
  // A refused one leaves the good one alone.
  const Called refused = call("field " + table() + " --scenario " + source +
                              "/scenarios/quick_dump.yaml --observables bogus --force --out " + out);
  EXPECT_EQ(refused.code, 2) << refused.text;
  EXPECT_EQ(call("validate " + out + "/dataset/dataset.yaml").code, 0);
}

// Sections of the pictures are held against sections of a pile that is cut alike, whatever the scenario says.
TEST_F(Field, ADatasetComparesSectionsOfTheSameCut) {
  const auto dataset = [&](const std::string& name, const std::string& output) {
    const std::string scenario =
        write(name + ".yaml", "extends: " + source + "/scenarios/quick_dump.yaml\noutput: " + output + "\n");
    // A name behind --observables is not one of them.
    const Called called = call("field --scenario " + scenario + " --out " + (folder / name).string() +
                               " --observables chi,d50_m " + table());
    EXPECT_EQ(called.code, 0) << called.text;
    return slurp(folder / name / "dataset/dataset.yaml") + slurp(folder / name / "dataset/observables.csv");
  };
  EXPECT_THAT(dataset("own", "{sections: 2}"), AllOf(HasSubstr("chi_S2,"), Not(HasSubstr("set:"))));
  EXPECT_THAT(dataset("further", "{sections: 6, further_sections: [2]}"),
              AllOf(HasSubstr("chi_S2of2,"), HasSubstr("d50_m_S1of2,"), Not(HasSubstr("set:"))));
  EXPECT_THAT(dataset("other", "{sections: 6, further_sections: [3]}"),
              AllOf(HasSubstr("chi_S2,"), HasSubstr("output.sections: 2")));
}

// What no picture tells is left out.
TEST_F(Field, SectionsWithGapsHaveAReport) {
  const std::string head = "image,section,d10_m,d50_m,d90_m\n";
  for (const auto& [name, rows] : std::vector<std::pair<std::string, std::string>>{
           // No picture has both sections; none has a whole slope and a section.
           {"apart", "1,whole,1,2,3\n1,S1,1,1.5,2\n2,whole,1,2,4\n2,S2,1,3,5\n"},
           {"without", "1,whole,1,2,3\n2,S1,1,1.5,2\n2,S3,1,3,5\n"}}) {
    const fs::path out = folder / name;
    const Called called = call("field " + write(name + ".csv", head + rows) + " --out " + out.string());
    EXPECT_EQ(called.code, 0) << name << called.text;
    EXPECT_THAT(called.text + slurp(out / "report.html"), Not(HasSubstr("nan")));
  }
  EXPECT_THAT(slurp(folder / "without/report.html"), HasSubstr("chi from – (S1) to – (S3)"));
  EXPECT_TRUE(fs::exists(folder / "apart/pictures/ksat.svg"));
  EXPECT_FALSE(fs::exists(folder / "without/pictures/ksat.svg"));
}

TEST_F(Field, NamesAndUnitsStandAsTheyAre) {
  const std::string rows =
      write("names.csv",
            "image;section;d10_m;d50_m;d90_m;chi\na,b;whole;1;2;3;\na,b;S1;1;1.5;2;-0.2\n"
            "a,b;S2;1;3;5;0.3\n");
  const std::string printed = write("printed.csv",
                                    "name;what;value;unit;relation;rounding;source\n"
                                    "d50_mean_S1;mean, of <b>S1</b>;1.5;<i>m</i>;eq;0.05;page 3, line 1\n");
  const fs::path out = folder / "out";
  const Called called = call("field " + rows + " --printed " + printed + " --out " + out.string());
  ASSERT_EQ(called.code, 0) << called.text;
  EXPECT_THAT(slurp(out / "pictures.csv"), HasSubstr("\n\"a,b\",S1,"));
  EXPECT_THAT(slurp(out / "chi_given.csv"), HasSubstr("\n\"a,b\",S2,0.3,"));
  EXPECT_THAT(slurp(out / "printed.csv"),
              AllOf(HasSubstr("\"mean, of <b>S1</b>\",1.5,"), HasSubstr("\"page 3, line 1\"")));
  EXPECT_THAT(slurp(out / "report.html"),
              AllOf(Not(HasSubstr("<i>m</i>")), HasSubstr("&lt;i&gt;m&lt;/i&gt;")));
}

TEST_F(Field, RefusesWithOneLine) {
  const std::string good = table(), out = " --out " + (folder / "none").string();
  const std::string g0 = source + "/assets/gradings/G0.csv";
  for (const auto& [arguments, words] : std::vector<std::pair<std::string, std::string>>{
           {"field", "--thesis"},
           {"field nowhere.csv" + out, "there is no such file"},
           {"field " + good + " --sieved " + g0 + out, "belong together"},
           {"field " + good + " --sieved " + g0 + " --limit 3kg" + out, "a length above 0"},
           {"field " + good + " --sieved " + g0 + " --limit 0.01mm" + out, "nothing below"},
           {"field " + good + " --void-ratio 0" + out, "--void-ratio"},
           {"field " + good + " --observables chi" + out, "--scenario"},
           {"field " + good + " --scenario " + source + "/scenarios/repose_lab.yaml" + out, "repose_lift"},
           {"field " + good + " --scenario " + write("broken.yaml", "grading: 3\n") + out, "broken.yaml"},
           {"field " +
                write("same.csv",
                      "image,section,d10_m,d50_m,d90_m\n"
                      "1,whole,1,2,3\n1,S1,1,2,3\n2,whole,1,2,3\n2,S1,1,2,3\n") +
                " --scenario " + source + "/scenarios/quick_dump.yaml" + out,
            "scatter"},
           {"field " + write("whole.csv", "image,section,d10_m,d50_m,d90_m\n1,1,1,2,3\n") + out,
            "--original"}}) {
    const Called called = call(arguments);
    EXPECT_EQ(called.code, 2) << arguments << "\n" << called.text;
    EXPECT_THAT(called.text, HasSubstr(words)) << arguments;
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    EXPECT_TRUE(entry.path().extension() == ".csv" || entry.path().extension() == ".yaml") << entry.path();
}

}  // namespace
