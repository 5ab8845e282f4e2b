// Pictures as files, good and bad, through the program as a user calls it.
#include "analysis/image/picture_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "analysis/image/scale_target.h"
#include "sim/material/input_text.h"
#include "tests/cli/call.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class PictureFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("scree_picture_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  // One line that names the file, exit code 2, nothing written.
  void expect_refused(const fs::path& file, const std::string& words, const std::string& options = "") const {
    const fs::path out = folder_ / "out";
    const Called called =
        call("image " + file.string() + " --scale 1cm/px --out " + out.string() + " " + options);
    EXPECT_EQ(called.code, 2) << called.text;
    EXPECT_THAT(called.text, HasSubstr(words));
    EXPECT_EQ(std::count(called.text.begin(), called.text.end(), '\n'), 1) << called.text;
    EXPECT_FALSE(fs::exists(out));
  }
  fs::path folder_;
};

// The head of a PNG of any size; nothing of its pixels.
std::string png_head(unsigned width, unsigned height) {
  std::string bytes = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s;
  for (const unsigned value : {width, height})
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes + "\x08\x02\0\0\0"s + "0000" + "\0\0\0\0IEND\xae\x42\x60\x82"s;
}

cv::Mat3b grey_with_discs() {
  cv::Mat3b picture(300, 400, cv::Vec3b(60, 60, 60));
  for (int k = 0; k < 8; ++k)
    cv::circle(picture, {40 + 45 * k, 60 + 25 * k}, 14 + k, cv::Scalar(190, 190, 190), cv::FILLED);
  return picture;
}

TEST_F(PictureFile, WhatIsNoPictureIsRefused) {
  expect_refused(write("text.png", "x,y\n1,2\n"), "is no PNG or JPEG");
  expect_refused(write("empty.png", ""), "empty.png");
  expect_refused(folder_ / "nowhere.png", "nowhere.png");
  expect_refused(write("zero.png", png_head(0, 0)), "has 0 x 0 pixels");
  expect_refused(write("head.png", "\x89PNG\r\n\x1a\n\0\0"s), "cut off");
  // libpng may say more on a line of its own.
  const Called damaged = call("image " + write("pixels.png", png_head(20, 20)).string() + " --scale 1cm/px");
  EXPECT_EQ(damaged.code, 2);
  EXPECT_THAT(damaged.text, HasSubstr("pixels.png: is damaged"));
  expect_refused(write("jpeg.jpg", "\xff\xd8\xff\xe0\0\x10JFIF"s), "cut off");
}

TEST_F(PictureFile, HugePicturesAreRefusedBeforeTheyAreUnpacked) {
  expect_refused(write("huge.png", png_head(30000, 30000)), "at most 64 megapixels");
  expect_refused(write("wide.png", png_head(0x7fffffff, 0x7fffffff)), "at most 64 megapixels");
}

TEST_F(PictureFile, DarknessAndBareGroundAreRefused) {
  write_picture(folder_ / "black.png", cv::Mat3b(200, 200, cv::Vec3b(0, 0, 0)));
  expect_refused(folder_ / "black.png", "shows nothing");
  // A step of brightness from side to side: an outline, but one that the frame cuts.
  cv::Mat3b half(200, 200, cv::Vec3b(40, 40, 40));
  half(cv::Rect(0, 0, 200, 100)).setTo(cv::Scalar(200, 200, 200));
  write_picture(folder_ / "half.png", half);
  expect_refused(folder_ / "half.png", "no grain above the detection limit");
}

TEST_F(PictureFile, AMissingScaleSaysWhatToDo) {
  write_picture(folder_ / "discs.png", grey_with_discs());
  const Called called =
      call("image " + (folder_ / "discs.png").string() + " --out " + (folder_ / "out").string());
  EXPECT_EQ(called.code, 2);
  EXPECT_THAT(called.text, HasSubstr("no scale target is found"));
  EXPECT_THAT(called.text, HasSubstr("--scale 1.2cm/px"));
}

TEST_F(PictureFile, WrongOptionsAreNamed) {
  write_picture(folder_ / "discs.png", grey_with_discs());
  expect_refused(folder_ / "discs.png", "--region 5", "--region 5");
  expect_refused(folder_ / "discs.png", "the region has", "--region \"900,900 950,990\"");
  expect_refused(folder_ / "discs.png", "--truth: 2 files for 1", "--truth a.csv b.csv");
  const Called scale = call("image " + (folder_ / "discs.png").string() + " --scale 1.2cm");
  EXPECT_EQ(scale.code, 2);
  EXPECT_THAT(scale.text, HasSubstr("--scale 1.2cm: a length a pixel"));
}

TEST_F(PictureFile, DiscsOfKnownSizeComeOutAsTheyAre) {
  write_picture(folder_ / "discs.png", grey_with_discs());
  const fs::path out = folder_ / "out";
  const Called called = call("image " + (folder_ / "discs.png").string() +
                             " --scale 1cm/px --sections 2 --out " + out.string());
  ASSERT_EQ(called.code, 0) << called.text;
  EXPECT_THAT(called.text, HasSubstr("8 grains"));
  for (const char* name :
       {"report.html", "overlay_discs.jpg", "grains.csv", "gradings.csv", "models.csv", "passing.csv"})
    EXPECT_TRUE(fs::file_size(out / name) > 100) << name;
  DelimitedTable grains(out / "grains.csv");
  const auto a = grains.column("a_m"), x = grains.column("x_px");
  int n = 0;
  for (; grains.next(); ++n) {
    const double k = std::round((*grains.number(*x) - 40) / 45);
    // Borders are seen some two thirds of a pixel too far inside, at either end.
    EXPECT_NEAR(*grains.number(*a), 0.01 * (2 * (14 + k) + 1), 0.015);
  }
  EXPECT_EQ(n, 8);
  EXPECT_THAT(slurp(out / "gradings.csv"), HasSubstr("image,section,d100_cm,d95_cm"));
}

// White letters in a dark box, whatever the picture shows there.
TEST_F(PictureFile, NamesOfSectionsCanBeRead) {
  cv::Mat3b picture = grey_with_discs();
  picture.setTo(cv::Vec3b(150, 150, 150), picture == cv::Vec3b(60, 60, 60));
  write_picture(folder_ / "discs.png", picture);
  const Called called = call("image " + (folder_ / "discs.png").string() +
                             " --scale 1cm/px --sections 2 --out " + (folder_ / "out").string());
  ASSERT_EQ(called.code, 0) << called.text;
  const cv::Mat overlay = read_photograph(folder_ / "out/overlay_discs.jpg");
  for (const int y : {0, overlay.rows / 2}) {
    const cv::Mat corner = overlay(cv::Rect(0, y, 24, 16)).clone().reshape(1);
    double darkest = 0, brightest = 0;
    cv::minMaxLoc(corner, &darkest, &brightest);
    EXPECT_LT(darkest, 60);
    EXPECT_GT(brightest, 200);
  }
}

// Sixteen equal small discs above, and one of nine times their diameter among as many below: of spheres
// 729 / (729 + 16) of the mass.
TEST_F(PictureFile, ASectionThatIsOneGrainIsNoted) {
  cv::Mat3b picture(600, 800, cv::Vec3b(60, 60, 60));
  for (int k = 0; k < 16; ++k)
    for (const int y : {100, 570})
      cv::circle(picture, {30 + 48 * k, y}, 10, cv::Scalar(190, 190, 190), cv::FILLED);
  cv::circle(picture, {400, 430}, 94, cv::Scalar(190, 190, 190), cv::FILLED);  // 189 px to 21
  write_picture(folder_ / "block.png", picture);
  const fs::path out = folder_ / "out";
  const Called called = call("image " + (folder_ / "block.png").string() +
                             " --scale 1cm/px --model sphere --sections 2 --out " + out.string());
  ASSERT_EQ(called.code, 0) << called.text;
  EXPECT_THAT(called.text, testing::ContainsRegex("note: one grain is 9[89] % of the mass of S2:"));
  EXPECT_THAT(called.text, Not(HasSubstr("of the mass of S1")));
  EXPECT_THAT(slurp(out / "report.html"), HasSubstr("of the mass of S2"));
}

// A picture and its copy have no scatter between repeats: nothing is left for a dataset, and nothing is
// written.
TEST_F(PictureFile, ARefusedDatasetLeavesNothing) {
  write_picture(folder_ / "discs.png", grey_with_discs());
  fs::copy_file(folder_ / "discs.png", folder_ / "copy.png");
  const std::string photo = (folder_ / "discs.png").string(), copy = (folder_ / "copy.png").string();
  const fs::path out = folder_ / "out";
  const Called called = call("image " + photo + " " + copy + " --scale 1cm/px --sections 2 --scenario " +
                             SCREE_TEST_ASSETS "/../scenarios/small_dump.yaml --out " + out.string());
  EXPECT_EQ(called.code, 2);
  EXPECT_THAT(called.text, testing::HasSubstr("nothing to write a dataset of"));
  EXPECT_FALSE(fs::exists(out)) << called.text;
}

// Thirds of a slope are held against thirds of the pile, not against the upper half of its six sections.
TEST_F(PictureFile, ADatasetComparesSectionsOfTheSameCut) {
  write_picture(folder_ / "a.png", grey_with_discs());
  cv::Mat3b other = grey_with_discs();
  cv::circle(other, {300, 60}, 25, cv::Scalar(190, 190, 190), cv::FILLED);
  cv::circle(other, {60, 260}, 30, cv::Scalar(190, 190, 190), cv::FILLED);
  write_picture(folder_ / "b.png", other);
  const auto dataset = [&](const std::string& scenario, const std::string& sections) {
    const fs::path out = folder_ / scenario;
    const Called called =
        call("image " + (folder_ / "a.png").string() + " " + (folder_ / "b.png").string() +
             " --scale 1cm/px --sections " + sections + " --scenario " SCREE_TEST_ASSETS "/../scenarios/" +
             scenario + " --out " + out.string());
    EXPECT_EQ(called.code, 0) << called.text;
    EXPECT_THAT(called.text, HasSubstr("note: the whole picture is taken for the slope"));
    return slurp(out / "dataset.yaml") + slurp(out / "observables.csv");
  };
  // Three sections and no others; six, and three beside them.
  EXPECT_THAT(dataset("small_dump.yaml", "2"), AllOf(HasSubstr("output.sections: 2"), HasSubstr("chi_S2,")));
  EXPECT_THAT(dataset("canadian_malartic_10m.yaml", "3"),
              AllOf(Not(HasSubstr("output.sections")), HasSubstr("chi_S3of3,"), HasSubstr("d50_m_S1of3,")));
}

// A dump of scree: its file says which bench it is of, and the region is printed and kept in the truth.
TEST_F(PictureFile, APileIsShownWithTheRegionOfItsSlope) {
  const fs::path run = folder_ / "run";
  const Called ran =
      call("run " SCREE_TEST_ASSETS "/../scenarios/small_dump.yaml --seeds 1 --out " + run.string());
  ASSERT_EQ(ran.code, 0) << ran.text;
  fs::path file;
  for (const auto& entry : fs::recursive_directory_iterator(run))
    if (entry.path().filename() == "particles.h5") file = entry.path();
  ASSERT_FALSE(file.empty());
  const std::string photo = (folder_ / "pile.png").string();
  const Called made = call("render " + photo + " --scale 2cm/px --snapshot " + file.string());
  ASSERT_EQ(made.code, 0) << made.text;
  const std::string said = "slope, crest to toe of the run's bench: --region \"";
  const auto at = made.text.find(said);
  ASSERT_NE(at, std::string::npos) << made.text;
  const auto from = at + said.size();
  const std::string region = made.text.substr(from, made.text.find('"', from) - from);
  EXPECT_THAT(made.text.substr(from), HasSubstr("--sections 3"));
  EXPECT_THAT(slurp(folder_ / "pile.truth.csv"), HasSubstr("# region = " + region + "\n"));
  const std::string image = "image " + photo + " --sections 3 --force --out " + (folder_ / "out").string() +
                            " --truth " + (folder_ / "pile.truth.csv").string();
  const std::string note = "note: the whole picture is taken for the slope";
  EXPECT_THAT(call(image).text, AllOf(HasSubstr(note), HasSubstr(region)));
  EXPECT_THAT(call(image + " --region \"" + region + "\"").text, Not(HasSubstr(note)));
}

TEST_F(PictureFile, ARegionBeyondThePictureIsTold) {
  write_picture(folder_ / "discs.png", grey_with_discs());
  const std::string command =
      "image " + (folder_ / "discs.png").string() + " --scale 1cm/px --sections 2 --out ";
  const std::string told = "the region reaches beyond the picture";
  const Called beyond = call(command + (folder_ / "a").string() + " --region '0,0 99999,99999'"),
               within = call(command + (folder_ / "b").string() + " --region '0,0 60,60'");
  EXPECT_THAT(beyond.text, testing::HasSubstr(told));
  EXPECT_THAT(within.text, Not(HasSubstr(told)));
}

TEST_F(PictureFile, ExifTurnsAPhotographUpright) {
  // 60 wide and 40 high with a bright left half; orientation 6: to be turned by 90 degrees clockwise.
  cv::Mat3b picture(40, 60, cv::Vec3b(10, 10, 10));
  picture(cv::Rect(0, 0, 30, 40)).setTo(cv::Scalar(240, 240, 240));
  write_picture(folder_ / "plain.jpg", picture);
  std::string bytes = slurp(folder_ / "plain.jpg");
  const std::string tiff = "MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0"s;
  const std::string app1 = "\xff\xe1\0"s + static_cast<char>(tiff.size() + 8) + "Exif\0\0"s + tiff;
  bytes.insert(2, app1);
  const cv::Mat3b turned = read_photograph(write("turned.jpg", bytes));
  ASSERT_EQ(turned.cols, 40);
  ASSERT_EQ(turned.rows, 60);
  EXPECT_GT(turned(5, 20)[0], 200);  // the left side is at the top now
  EXPECT_LT(turned(55, 20)[0], 60);
}

TEST_F(PictureFile, CutOffPhotographsAreRefused) {
  write_picture(folder_ / "discs.jpg", grey_with_discs());
  const std::string bytes = slurp(folder_ / "discs.jpg");
  expect_refused(write("half.jpg", bytes.substr(0, bytes.size() / 2)), "cut off");
  write_picture(folder_ / "discs.png", grey_with_discs());
  const std::string png = slurp(folder_ / "discs.png");
  expect_refused(write("half.png", png.substr(0, png.size() / 2)), "cut off");
}

TEST_F(PictureFile, RenderAndImageWorkTogether) {
  const std::string photo = (folder_ / "a.png").string();
  const Called made = call("render " + photo +
                           " --pixels 700x500 --grading " SCREE_TEST_ASSETS
                           "/gradings/Lab0.csv --scale 1mm/px "
                           "--target-diameter 40mm --coverage 0.2");
  ASSERT_EQ(made.code, 0) << made.text;
  EXPECT_EQ(call("render " + photo).code, 2);  // is there already
  const Called seen =
      call("image " + photo +
           " --target-diameter 40mm --detection-limit 0.3 --model sphere --sections 2 --truth " +
           (folder_ / "a.truth.csv").string() + " --out " + (folder_ / "out").string());
  ASSERT_EQ(seen.code, 0) << seen.text;
  // D10, D50, D80 and mass, each measured, known, and its error.
  const auto row = [&](const std::string& name) {
    std::array<double, 4> values{};
    std::istringstream words(seen.text.substr(seen.text.find("\n  " + name) + 3 + name.size()));
    for (double& value : values) words >> value;
    return values;
  };
  const auto measured = row("measured"), known = row("known"), error = row("error, %");
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_GT(known[k], 0) << seen.text;
    EXPECT_NEAR(error[k], 100 * (measured[k] / known[k] - 1), 0.3) << seen.text;
  }
  EXPECT_LT(known[0], known[1]);
  EXPECT_LT(known[1], known[2]);
  EXPECT_THAT(seen.text,
              HasSubstr(fmt::format("{:.0f} % of the known mass is seen", 100 * measured[3] / known[3])));
  EXPECT_THAT(slurp(folder_ / "out/report.html"),
              AllOf(HasSubstr("D10 of visible rock"), HasSubstr("of the known mass is seen")));
  EXPECT_THAT(slurp(folder_ / "out" / "effects.yaml"), HasSubstr("image_blur:"));
  EXPECT_THAT(slurp(folder_ / "out" / "bias.csv"), HasSubstr("detected_share"));
}

// Rock that does not cover 0.35 of a picture with gaps between grains of half its smallest diameter.
TEST_F(PictureFile, ACoverageThatIsNotGivenIsLoweredUntilTheRockFits) {
  const std::string command =
      "render --pixels 640x480 --scale 3cm/px --force --grading " +
      write("rock.csv", "diameter_mm,passing_pct\n200,0\n300,31.5\n500,64\n1000,100\n").string() + " ";
  const std::string a = (folder_ / "a.png").string(), b = (folder_ / "b.png").string();
  const Called lowered = call(command + a), again = call(command + b);
  ASSERT_EQ(lowered.code, 0) << lowered.text;
  EXPECT_THAT(lowered.text,
              testing::ContainsRegex("coverage: 0\\.[23][0-9]; at 0\\.35 this rock finds no room"));
  EXPECT_EQ(again.code, 0);
  EXPECT_EQ(slurp(a), slurp(b));
  const Called given = call(command + a + " --coverage 0.35");
  EXPECT_EQ(given.code, 2);
  EXPECT_THAT(given.text, HasSubstr("take a coverage below 0.35"));
}

TEST_F(PictureFile, OfNoKnownGrainNoEffectsAreMade) {
  write_picture(folder_ / "discs.png", grey_with_discs());
  const fs::path truth = write("truth.csv",
                               "# m_per_px = 0.01\n# scene_d50_m = 0.3\nid,x_px,y_px,diameter_m,mass_kg,"
                               "visible_cm2,visible_share,visible_a_m,visible_b_m\n"
                               "1,390,10,0.3,40,700,1,0.3,0.3\n");
  const std::string command = "image " + (folder_ / "discs.png").string() + " --scale 1cm/px --truth " +
                              truth.string() + " --sections 1 --force --out " + (folder_ / "out").string();
  fs::create_directories(folder_ / "out");
  for (const char* older : {"grains.csv", "effects.yaml", "overlay_other.jpg", "passing-2.svg"})
    write(std::string("out/") + older, "of an older analysis\n");
  // In the picture and not found; outside the region.
  for (const char* region : {"", " --region '20,20 380,290'"}) {
    const Called called = call(command + region);
    EXPECT_EQ(called.code, 0) << called.text;
    EXPECT_THAT(called.text, HasSubstr("note: no effects.yaml: 0 known grains are detected"));
    for (const char* older : {"effects.yaml", "overlay_other.jpg", "passing-2.svg"})
      EXPECT_FALSE(fs::exists(folder_ / "out" / older)) << older;
    EXPECT_THAT(slurp(folder_ / "out/report.html"),
                AllOf(HasSubstr("too few to say anything of size"), Not(HasSubstr("effects.yaml"))));
  }
}

TEST(ScaleTarget, IsFoundInSunAndShadowAndNowhereElse) {
  cv::Mat3b picture(400, 300, cv::Vec3b(90, 95, 100));
  cv::circle(picture, {60, 40}, 20, cv::Scalar(200, 40, 210), cv::FILLED, cv::LINE_AA);
  cv::circle(picture, {200, 350}, 25, cv::Scalar(80, 14, 84), cv::FILLED, cv::LINE_AA);
  cv::circle(picture, {150, 200}, 25, cv::Scalar(40, 40, 210), cv::FILLED);              // red
  cv::rectangle(picture, {230, 100}, {240, 180}, cv::Scalar(200, 40, 210), cv::FILLED);  // no disc
  cv::Mat1b mask;
  const std::vector<ScaleTarget> targets = find_targets(picture, mask);
  ASSERT_EQ(targets.size(), 2u);
  EXPECT_NEAR(targets[0].x, 60, 0.5);
  EXPECT_NEAR(targets[0].diameter_px, 41, 0.8);
  EXPECT_NEAR(targets[1].diameter_px, 51, 0.8);
  // Discs of the same size that look larger at the foot: the foot is nearer, a pixel is less there.
  const ImageScale scale = scale_of(targets, 0.5, 400);
  EXPECT_NEAR(scale.at(40), 0.5 / targets[0].diameter_px, 1e-9);
  EXPECT_NEAR(scale.at(350), 0.5 / targets[1].diameter_px, 1e-9);
}

}  // namespace
}  // namespace scree
