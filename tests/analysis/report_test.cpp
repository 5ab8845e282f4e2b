#include "analysis/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "analysis/report/lateral_table.h"
#include "analysis/report/report_page.h"
#include "analysis/report/report_text.h"
#include "analysis/results/summary.h"
#include "tests/analysis/fake_run.h"

namespace scree {
namespace {

using testing::HasSubstr;
using testing::Not;

std::filesystem::path fresh_folder(const std::string& name) {
  const auto folder = std::filesystem::path(testing::TempDir()) / ("scree_report_" + name);
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// PATH with one folder only, until the end of the test.
class OnlyPath {
 public:
  explicit OnlyPath(const std::filesystem::path& folder) : before_(std::getenv("PATH")) {
    setenv("PATH", folder.c_str(), 1);
  }
  ~OnlyPath() { setenv("PATH", before_.c_str(), 1); }
  OnlyPath(const OnlyPath&) = delete;
  OnlyPath& operator=(const OnlyPath&) = delete;

 private:
  std::string before_;
};

TEST(Report, StripsAcrossTheSlopeHaveATable) {
  EXPECT_EQ(lateral_table(fake_run()), "") << "no strips";
  RunResult run = fake_run();
  for (SeedResult& seed : run.seeds) {
    seed.lateral = Lateral{4, {}, 19};
    LateralSection crest{"S1", {-4, 0}, {-0.5, -0.25}, {0.75, 0.875}, {1000, 2000}, 0.2, 0.25, 0.125};
    LateralSection toe{"S2", {0}, {0.5}, {1.5}, {3000}, std::nan(""), std::nan(""), std::nan("")};
    seed.lateral->sections = {crest, toe};
  }
  run.seeds[1].lateral->point1_toe_width = 21;
  run.seeds[1].lateral->sections[0].chi[0] = -0.7;
  const std::string table = lateral_table(run);
  EXPECT_THAT(table, HasSubstr("strips 4.00 m wide"));
  EXPECT_THAT(table, HasSubstr("width of 20.0 m ± 1.4 m"));  // of 19 and 21
  EXPECT_THAT(table,
              HasSubstr("<td class=\"word\">y −6.00 to −2.00 m</td><td>−0.60<small>D50 0.75</small></td>"
                        "<td>–</td>"));
  EXPECT_THAT(table,
              HasSubstr("deviation of χ over strips</b></td><td>0.20<small>± 0.00</small></td><td>–</td>"));
  const auto folder = fresh_folder("strips");
  write_report(run, folder, {45.0});
  EXPECT_THAT(text_of(folder / "report.html"), HasSubstr("<h2>Across the slope</h2>"));
}

TEST(Report, ShowsTheWholeRunOnOnePage) {
  const auto folder = fresh_folder("whole");
  write_report(fake_run(), folder, {45.0});
  const std::string page = text_of(folder / "report.html");

  EXPECT_THAT(page, HasSubstr("Rock at the toe is coarser than at the crest"));
  EXPECT_THAT(page, HasSubstr("Of 6 printed values, 5 agree"));
  for (const char* value : {"−1.04", "0.26", "−0.77", "−0.29", "0.56", "0.380", "1.90"})
    EXPECT_THAT(page, HasSubstr(value));
  EXPECT_THAT(page, HasSubstr("does not agree"));
  EXPECT_THAT(page, HasSubstr("not judged"));
  EXPECT_THAT(page, HasSubstr("(0.3 % &amp; 3 grains)"));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(&#39;x&#39;)"));
  EXPECT_THAT(page, Not(HasSubstr("src=\"http"))) << "nothing comes from the network";

  for (const char* name :
       {"pile_cut.png", "pile_front.png", "chi.svg", "diameters.svg", "passing.svg", "profile.svg"})
    EXPECT_GT(std::filesystem::file_size(folder / "pictures" / name), 4000U) << name;
  EXPECT_EQ(text_of(folder / "pictures" / "pile_cut.png").substr(1, 3), "PNG");
}

TEST(Report, ShowsAReposeTest) {
  const auto folder = fresh_folder("repose");
  RunResult run;
  run.title = "Repose angle of the laboratory rock";
  run.seeds = {fake_seed(10001)};
  SeedResult& seed = run.seeds[0];
  seed.sections.clear();
  seed.profile.clear();
  seed.slope_angle.reset();
  std::vector<Grain> heap;
  for (Grain& grain : seed.final_state.grains) {  // a cone of 37 degrees, 1.5 m wide
    grain.diameter *= 0.08;
    const double up = grain.position.z() / 10, around = grain.position.y() * 20;
    const double out = 0.72 * (1 - up) * std::sqrt(std::fmod(grain.position.x() * 7.3, 1.0));
    grain.position = Vec3(out * std::cos(around), out * std::sin(around), 0.54 * up);
    if (grain.position.z() > grain.diameter / 2) heap.push_back(grain);
  }
  seed.final_state.grains = heap;
  seed.repose = ReposeAngle{};
  seed.repose->angle = 36.9;
  seed.repose->height_over_radius = 35.1;
  seed.repose->half_coverage = 38.2;
  seed.repose->flank_height = 0.54;
  seed.repose->height = 0.54;
  seed.repose->radius = 0.72;
  seed.heap = measure_heap_shape(heap, heap, measure_repose(heap));
  Comparison row = fake_comparison("angle", "whole", "pfc3d", 34.9, 3.1, 36.9, 0.65);
  row.reference.unit = "deg";
  row.reference.case_name = "lab_repose";
  run.comparison = {row};
  write_report(run, folder);
  const std::string page = text_of(folder / "report.html");
  EXPECT_THAT(page, HasSubstr("The heap stands at a repose angle of 36.9°"));
  EXPECT_THAT(page, HasSubstr("34.9°"));
  EXPECT_THAT(page, HasSubstr("ring 3"));
  EXPECT_GT(std::filesystem::file_size(folder / "pictures" / "heap_cut.png"), 4000U);
  EXPECT_GT(std::filesystem::file_size(folder / "pictures" / "repose.svg"), 4000U);
}

TEST(Report, ADropTestHasNoPile) {
  const auto folder = fresh_folder("drop");
  RunResult run;
  run.seeds.resize(1);
  Grain rock;
  rock.diameter = 0.1, rock.mass = 1.4, rock.position = Vec3(0, 0, 0.23);
  run.seeds[0].final_state.grains = {rock};
  run.seeds[0].rebound_height = 0.18;
  run.seeds[0].particles = 1;
  run.seeds[0].mass = 1.4;
  EXPECT_TRUE(write_report(run, folder).empty());
  const std::string page = text_of(folder / "report.html");
  EXPECT_THAT(page, HasSubstr("The rock rebounds to 0.180 m"));
  EXPECT_THAT(page, Not(HasSubstr("The pile")));
  EXPECT_THAT(page, HasSubstr("1 sphere, 0.00140 t"));
  EXPECT_THAT(page, Not(HasSubstr("came to rest"))) << "it ends at the top of the rebound";
  EXPECT_FALSE(std::filesystem::exists(folder / "pictures" / "heap_cut.png"));
}

TEST(Report, TheCutShowsFixedBallsOfTheGround) {
  const auto folder = fresh_folder("ground");
  RunResult run = fake_run();
  for (SeedResult& seed : run.seeds) seed.fixed.clear();
  const auto bare = draw_pile(run, {45.0}, folder);
  EXPECT_THAT(bare[0].caption, Not(HasSubstr("fixed")));
  const std::string without = text_of(bare[0].file);
  Grain ball;
  ball.diameter = 1, ball.position = Vec3(2, -100, 3);  // inside the bench, where no rock hides it
  run.seeds[0].fixed = {ball};
  EXPECT_THAT(draw_pile(run, {45.0}, folder)[0].caption, Not(HasSubstr("fixed"))) << "far from the cut";
  for (double y = -5; y < 5; y += 0.25) {
    ball.position.y() = y;
    run.seeds[0].fixed.push_back(ball);
  }
  const auto drawn = draw_pile(run, {45.0}, folder);
  EXPECT_THAT(drawn[0].caption, HasSubstr("Grey balls are the fixed ones of the ground."));
  EXPECT_NE(text_of(drawn[0].file), without);
}

TEST(Report, ASingleDumpHasNoLayersToTellApart) {
  const auto folder = fresh_folder("single_dump");
  VerticalSection section;
  section.bench = BenchOutline{10, 45};
  RunResult run = fake_run();
  run.seeds.resize(1);
  SeedResult& seed = run.seeds[0];
  const auto page = [&] {
    seed.inside = analyse_inside(seed.final_state.grains, {}, seed.original, section);
    seed.layers = analyse_layers(seed.final_state.grains, seed.original, section, 0.4);
    std::filesystem::remove_all(folder);
    write_report(run, folder, {45.0});
    return text_of(folder / "report.html");
  };
  EXPECT_THAT(page(), HasSubstr("scatter of grain size that lies between layers"));
  EXPECT_TRUE(std::filesystem::exists(folder / "pictures" / "layers.png"));
  for (Grain& grain : seed.final_state.grains) grain.dump = 1;
  EXPECT_THAT(page(), Not(HasSubstr("scatter of grain size that lies between layers")));
  EXPECT_FALSE(std::filesystem::exists(folder / "pictures" / "layers.png"));
}

TEST(Report, AProfileOfOnePlaceHasNoChart) {
  const auto folder = fresh_folder("one_place");
  RunResult run = fake_run();
  for (SeedResult& seed : run.seeds) {
    seed.profile = {{1.5, 2}};
    seed.slope_angle.reset();
  }
  EXPECT_TRUE(write_report(run, folder, {45.0}).empty());
  EXPECT_FALSE(std::filesystem::exists(folder / "pictures" / "profile.svg"));
  run.seeds[1].profile.push_back({2.5, 1});
  EXPECT_TRUE(write_report(run, folder, {45.0}).empty());
  EXPECT_TRUE(std::filesystem::exists(folder / "pictures" / "profile.svg"));
}

TEST(Report, AReposeTestWithoutAReadingHasAPage) {
  const auto folder = fresh_folder("no_reading");
  Grain grain;
  grain.diameter = 0.1, grain.mass = 1.4;
  RunResult run;
  run.seeds.resize(1);
  SeedResult& seed = run.seeds[0];
  for (const auto& [x, y] : {std::pair{0, 1}, {1, 3}, {2, 0}}) {  // the medians meet in a gap
    grain.position = Vec3(x, y, 0.05);
    seed.final_state.grains.push_back(grain);
  }
  seed.at_rest = true;
  seed.repose = measure_repose(seed.final_state.grains);
  seed.heap = measure_heap_shape(seed.final_state.grains, seed.final_state.grains, *seed.repose);
  EXPECT_TRUE(write_report(run, folder).empty());
  EXPECT_THAT(text_of(folder / "report.html"),
              HasSubstr("No repose angle: no radius: the middle of the heap"));
  EXPECT_FALSE(std::filesystem::exists(folder / "pictures" / "repose.svg"));
  EXPECT_TRUE(std::filesystem::exists(folder / "pictures" / "heap_cut.png"));
}

TEST(Report, TheCutShowsRockWhereStraysLieFarToBothSides) {
  const auto folder = fresh_folder("strays");
  RunResult run = fake_run();
  run.seeds.resize(1);
  std::vector<Grain>& grains = run.seeds[0].final_state.grains;
  grains.resize(3);
  for (Grain& grain : grains) grain.diameter = 0.5, grain.position = Vec3(2, -0.3, 0.25);
  grains[0].position.y() = -100;
  grains[2].position.y() = 100;
  const auto drawn = draw_pile(run, {45.0}, folder);
  ASSERT_EQ(drawn.size(), 2u);
  for (const Picture& picture : drawn) EXPECT_EQ(picture.why_missing, "");
}

TEST(Report, OneRefusedPictureDoesNotCostThePage) {
  const auto folder = fresh_folder("refused");
  std::ofstream(folder / "gnuplot") << "#!/bin/sh\necho 'no <range>' >&2\nexit 1\n";
  std::filesystem::permissions(folder / "gnuplot", std::filesystem::perms::owner_all);
  const OnlyPath fake(folder);
  const std::vector<std::string> missing = write_report(fake_run(), folder, {45.0});
  EXPECT_EQ(missing.size(), 6u) << "two views and four charts";
  EXPECT_THAT(missing[0], HasSubstr("pile_cut.png (exit status 1): no <range>"));
  const std::string page = text_of(folder / "report.html");
  EXPECT_THAT(page, HasSubstr("A picture is missing: gnuplot failed on"));
  EXPECT_THAT(page, HasSubstr("profile.svg (exit status 1): no &lt;range&gt;"));
  EXPECT_THAT(page, HasSubstr("<h2>The run</h2>"));
}

TEST(Report, APictureThatCannotBeReadIsRefused) {
  const auto folder = fresh_folder("unreadable");
  EXPECT_THROW(PageFigures().figure(Picture{"None", folder / "none.svg", "It is not there."}),
               std::runtime_error);
  std::ofstream(folder / "empty.svg").flush();
  EXPECT_THROW(PageFigures().figure(Picture{"Empty", folder / "empty.svg", "It holds nothing."}),
               std::runtime_error);
}

TEST(ReportText, LeadSaysWhyThereIsNoReposeAngle) {
  RunResult run;
  run.seeds.resize(2);
  for (SeedResult& seed : run.seeds) {
    seed.repose = ReposeAngle{};
    seed.repose->angle = std::nan("");
    seed.at_rest = true;
  }
  EXPECT_THAT(lead_paragraphs(run), HasSubstr("No repose angle: no flank: the mean surface"));
  for (SeedResult& seed : run.seeds) seed.at_rest = false;
  EXPECT_THAT(lead_paragraphs(run), HasSubstr("No repose angle: not at rest."));
  run.seeds[1].repose->angle = 31.25;
  EXPECT_THAT(lead_paragraphs(run), HasSubstr("The heap is not at rest yet; its flank stands at 31.2°"));
  EXPECT_EQ(why_no_repose_angle(run.seeds[1]), "");
}

TEST(ReportText, LeadTakesNoFaceForASlopeOfTheRock) {
  RunResult run;
  run.seeds.resize(2);
  for (SeedResult& seed : run.seeds) seed.slope_angle = 42.4, seed.at_rest = true, seed.slope_cover = 12;
  EXPECT_THAT(lead_paragraphs(run), HasSubstr("The slope came to rest at 42.4"));
  for (SeedResult& seed : run.seeds) seed.slope_cover = 0.1;
  EXPECT_THAT(lead_paragraphs(run), HasSubstr("No slope of the rock's own: it lies thin on the bench face"));
}

TEST(ReportText, LeadSaysWhenSectionsDoNotStandForThePile) {
  RunResult run = fake_run();
  double mass = 0;
  for (const Section& section : run.seeds[0].sections[0].sections) mass += section.mass;
  for (SeedResult& seed : run.seeds) seed.sections[0].mass_outside = 0.05 * mass;
  EXPECT_THAT(lead_paragraphs(run), Not(HasSubstr("belongs to no section")));
  for (SeedResult& seed : run.seeds) seed.sections[0].mass_outside = 3 * mass;
  EXPECT_NEAR(share_in_no_section(run), 0.75, 0.01);
  EXPECT_THAT(lead_paragraphs(run),
              HasSubstr("75 % of the rock lies above the crest's height and belongs to no section."));
  run.bench_height = 0;
  EXPECT_EQ(share_in_no_section(run), 0);
}

TEST(ReportText, EnergyIsClosedOrOpen) {
  EXPECT_EQ(energy_in_words(-0.0012, true), "closed to 0.12 %");
  EXPECT_EQ(energy_in_words(-393.0035, false), "open by 39300.35 %");
  EXPECT_EQ(energy_in_words(std::nan(""), false), "not a number");
}

TEST(Report, ListsEffectsAndSaysOfAnOpenBalanceThatItIs) {
  RunResult run = fake_run();
  run.effects = {"cohesion: bond_number 1; gamma 1766 J/m2"};
  for (SeedResult& seed : run.seeds) seed.energy = EnergyTerms{{}, 100, 5, 0.05, false};
  const auto folder = fresh_folder("effects");
  write_report(run, folder, {45.0});
  const std::string page = text_of(folder / "report.html");
  EXPECT_THAT(page, HasSubstr("<dt>effect</dt><dd>cohesion: bond_number 1; gamma 1766 J/m2</dd>"));
  EXPECT_THAT(page, HasSubstr("<dt>energy balance</dt><dd>open by 5.00 % of what was put in"));
}

TEST(Report, NamesThePackageWhenGnuplotIsMissing) {
  const auto folder = fresh_folder("missing");
  const OnlyPath empty(folder);
  try {
    write_report(fake_run(), folder);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("apt install gnuplot-nox"));
  }
}

TEST(Report, GivesGnuplotsOwnWordsWhenItFails) {
  const auto folder = fresh_folder("fails");
  std::ofstream(folder / "gnuplot") << "#!/bin/sh\necho 'no such terminal' >&2\nexit 3\n";
  std::filesystem::permissions(folder / "gnuplot", std::filesystem::perms::owner_all);
  const OnlyPath fake(folder);
  try {
    run_gnuplot("plot 1", folder / "x.svg");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("x.svg (exit status 3): no such terminal"));
  }
}

TEST(Report, NothingInALabelIsExpanded) {
  EXPECT_EQ(gnuplot_quoted("it's `rm` $x\n"), "'it''s `rm` $x '");
  const auto folder = fresh_folder("label");
  run_gnuplot("set terminal svg noenhanced\nset title " +
                  gnuplot_quoted("`touch " + (folder / "made").string() + "`") + "\nplot x",
              folder / "x.svg");
  EXPECT_FALSE(std::filesystem::exists(folder / "made"));
}

TEST(ReportText, WritesNumbersForReaders) {
  EXPECT_EQ(number_text(0.12345), "0.123");
  EXPECT_EQ(number_text(-1.04), "−1.04");
  EXPECT_EQ(number_text(1234.5), "1234");  // digits before the point are never dropped
  EXPECT_EQ(number_text(0), "0.00");
  EXPECT_EQ(decimals_text(-0.001, 2), "0.00");
  EXPECT_EQ(number_text(std::nan("")), "–");
  EXPECT_EQ(count_text(12345678), "12\u202f345\u202f678");
  EXPECT_EQ(count_text(123), "123");
  EXPECT_EQ(duration_text(845), "14.1 min");
  EXPECT_EQ(base64("Man"), "TWFu");  // RFC 4648
  EXPECT_EQ(base64("Ma"), "TWE=");
  EXPECT_EQ(quantity_in_words("d50_rel"), "D50 / D50 as dumped");
  EXPECT_EQ(quantity_in_words("d95"), "D95");
}

TEST(ReportText, JudgesByTheDeviation) {
  const auto of = [](std::optional<double> z) {
    return verdict(fake_comparison("chi", "S1", "measured", 0, 1, 0, z));
  };
  EXPECT_EQ(of(-0.9), Verdict::close);
  EXPECT_EQ(of(-1.9), Verdict::agrees);
  EXPECT_EQ(of(2.0), Verdict::differs);
  EXPECT_EQ(of(std::nullopt), Verdict::unknown);
}

}  // namespace
}  // namespace scree
