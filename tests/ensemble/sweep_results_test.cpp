// Tables of a sweep's runs: written, read again, held against printed values.
#include "cli/ensemble/sweep_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

namespace scree {
namespace {

class SweepTable : public testing::Test {
 protected:
  void SetUp() override {
    file = fs::temp_directory_path() / ("scree_table_" + std::to_string(getpid()) + ".csv");
    sweep.parameters = {"material.mu", "material.mu_r"};
    sweep.points.resize(2);
    for (SweepPoint& point : sweep.points) point.scenario.seeds = {7, 8};
    sweep.points[0].values = {"0.2", "0.1"};
    sweep.points[1].values = {"0.20", "0.4"};
    sweep.points[0].compare = "first";
    sweep.points[1].compare = "second";
  }
  void TearDown() override { fs::remove(file); }

  StoredResult run(double angle) {
    StoredResult result;
    result.state = RunState::done;
    result.version = "1.2 (abc)";
    result.wall_seconds = 12.3;
    result.outputs = {{"angle_deg", angle}, {"height_over_radius_deg", angle + 1}};
    return result;
  }
  std::vector<PointResults> points() {
    StoredResult failed;
    failed.state = RunState::failed;
    failed.message = "a \"strange\" thing, indeed";
    return {{&sweep.points[0], {7, 8}, {run(20), run(22)}},
            {&sweep.points[1], {7, 8}, {failed, std::nullopt}}};
  }
  ReferenceValue printed(const char* name, const char* kind, double value) {
    ReferenceValue v;
    v.case_name = name;
    v.quantity = "angle";
    v.section = "whole";
    v.kind = kind;
    v.value = value;
    v.relation = "eq";
    return v;
  }

  fs::path file;
  Sweep sweep;
};

TEST_F(SweepTable, ReadsWhatItHasWritten) {
  const std::vector<PointResults> before = points();
  write_sweep_csv(sweep, before, file);
  const std::vector<PointResults> after = read_sweep_csv(sweep, file);
  ASSERT_EQ(after.size(), 2u);
  for (std::size_t p = 0; p < 2; ++p)
    for (std::size_t k = 0; k < 2; ++k) {
      const auto &a = before[p].runs[k], &b = after[p].runs[k];
      ASSERT_EQ(a.has_value(), b.has_value());
      if (!a) continue;
      EXPECT_EQ(a->state, b->state);
      EXPECT_EQ(a->version, b->version);
      EXPECT_EQ(a->message, b->message);
      EXPECT_EQ(a->wall_seconds, b->wall_seconds);
      EXPECT_EQ(a->outputs, b->outputs);
    }
}

TEST_F(SweepTable, RowsOfOtherPointsAndSeedsArePassedOver) {
  std::ofstream(file)
      << "# made by hand\nmaterial.mu,material.mu_r,seed,state,version,wall_seconds,angle_deg,message\n"
         "0.2,0.4,8,done,1,5,30.5,\n0.2,0.4,9,done,1,5,31,\n0.3,0.4,8,done,1,5,32,\n";
  EXPECT_THAT([this] { read_sweep_csv(sweep, file); },
              ThrowsMessage<std::runtime_error>(HasSubstr(":5: 0.3, 0.4 is no point of sweep")));
  const std::vector<PointResults> read = read_sweep_csv(sweep, file, false);
  EXPECT_EQ(read[0].of("angle_deg").n, 0);
  EXPECT_EQ(read[1].of("angle_deg").n, 1);
  EXPECT_EQ(read[1].of("angle_deg").mean, 30.5);
  EXPECT_EQ(read[1].count(RunState::done), 1);
}

TEST_F(SweepTable, OfAnotherSweepIsRefused) {
  sweep.name = "coarse";
  write_sweep_csv(sweep, points(), file);
  sweep.name = "fine";
  EXPECT_THAT(
      [this] { read_sweep_csv(sweep, file); },
      ThrowsMessage<std::runtime_error>(HasSubstr(":1: these are runs of sweep coarse, not of fine")));
  // As a spreadsheet leaves it: with a byte order mark, an empty row, and separators behind the comment.
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  std::string table = text.str();
  table.insert(table.find('\n'), ",,,,");
  std::ofstream(file) << "\xEF\xBB\xBF\n" << table;
  EXPECT_THAT(
      [this] { read_sweep_csv(sweep, file); },
      ThrowsMessage<std::runtime_error>(HasSubstr(":2: these are runs of sweep coarse, not of fine")));
  sweep.name = "coarse";
  EXPECT_EQ(read_sweep_csv(sweep, file).size(), points().size());
}

TEST_F(SweepTable, MeansAreOfPilesAtRest) {
  std::vector<PointResults> all = points();
  all[1].runs[0] = run(20);
  all[1].runs[1] = run(30);
  all[1].runs[1]->outputs["at_rest"] = 0;
  EXPECT_EQ(all[1].of("angle_deg").n, 1);
  EXPECT_EQ(all[1].of("angle_deg").mean, 20);
}

TEST_F(SweepTable, SaysWhatIsWrong) {
  const auto reading = [&](const std::string& text) {
    std::ofstream(file) << text;
    return [this] { read_sweep_csv(sweep, file); };
  };
  const std::string header = "material.mu,material.mu_r,seed,state,version,wall_seconds,angle_deg,message\n";
  EXPECT_THAT(reading("mu,mu_r,angle\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr(":1: not a table of this sweep")));
  EXPECT_THAT(reading(header + "0.2,0.1,7,done,1,5,20\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr(":2: 7 fields, but the header has 8")));
  EXPECT_THAT(reading(header + "0.2,0.1,7,done,1,5,steep,\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr("angle_deg: 'steep' is no number")));
  EXPECT_THAT(reading(header + "0.2,0.1,7,lost,1,5,20,\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr("state 'lost'")));
  EXPECT_THAT(reading(""), ThrowsMessage<std::runtime_error>(HasSubstr("the file is empty")));
  fs::remove(file);
  EXPECT_THAT([this] { read_sweep_csv(sweep, file); },
              ThrowsMessage<std::runtime_error>(HasSubstr("there is no such file")));
}

TEST_F(SweepTable, DifferencesFromPrintedValues) {
  std::vector<PointResults> all = points();
  all[1].runs[1] = run(30);
  const std::vector<ReferenceValue> reference{printed("first", "measured", 99), printed("first", "pfc3d", 20),
                                              printed("second", "pfc3d", 33)};
  const SweepComparison c = compare_sweep(all, "angle_deg", reference);
  EXPECT_EQ(c.compared, 2);
  EXPECT_DOUBLE_EQ(c.difference[0], 1);
  EXPECT_DOUBLE_EQ(c.difference[1], -3);
  EXPECT_DOUBLE_EQ(c.mean, -1);
  EXPECT_DOUBLE_EQ(c.rms, std::sqrt(5.0));
  EXPECT_EQ(c.worst, 1);
  EXPECT_DOUBLE_EQ(compare_sweep(all, "height_over_radius_deg", reference).difference[0], 2);
  EXPECT_EQ(compare_sweep(all, "chi_S6", reference).compared, 0);
}

}  // namespace
}  // namespace scree
