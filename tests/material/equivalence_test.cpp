// The table of Bullet's settings: linear in between, none outside, and what is said about bad tables.
#include "sim/material/equivalence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace scree {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::string kHeader = "mu,mu_r,local_damping,friction,rolling,angle_rrlinear_deg,angle_impulse_deg\n";

class EquivalenceTable : public testing::Test {
 protected:
  void SetUp() override {
    file = std::filesystem::temp_directory_path() / ("scree_equivalent_" + std::to_string(getpid()) + ".csv");
  }
  void TearDown() override { std::filesystem::remove(file); }
  Equivalence read(const std::string& text) {
    std::ofstream(file) << text;
    return Equivalence::read(file);
  }
  std::filesystem::path file;
};

TEST_F(EquivalenceTable, LinearBetweenNodesAndNoneOutside) {
  const Equivalence table = read("# how it was made\n" + kHeader +
                                 "0.1,0.2,0.4,0.15,0.2,20,21\n0.1,0.4,0.4,0.15,0.6,24,24\n"
                                 "0.3,0.2,0.4,0.35,0.2,30,28.5\n0.3,0.4,0.4,0.35,0.6,34,34\n");
  const auto middle = table.at(0.2, 0.3, 0.4);
  ASSERT_TRUE(middle);
  EXPECT_DOUBLE_EQ(middle->friction, 0.25);
  EXPECT_DOUBLE_EQ(middle->rolling, 0.4);
  EXPECT_DOUBLE_EQ(middle->error_deg.value(), 1.5);
  const auto corner = table.at(0.3, 0.4, 0.4);
  ASSERT_TRUE(corner);
  EXPECT_DOUBLE_EQ(corner->friction, 0.35);
  EXPECT_DOUBLE_EQ(corner->error_deg.value(), 0);  // the node's own
  EXPECT_FALSE(table.at(0.31, 0.3, 0.4));
  EXPECT_FALSE(table.at(0.2, 0.1, 0.4));
  EXPECT_FALSE(table.at(0.2, 0.3, 0.5));
  EXPECT_EQ(table.range(), "mu 0.1 to 0.3, mu_r 0.2 to 0.4, local_damping 0.4");
}

TEST_F(EquivalenceTable, ThirdAxisAndNodesThatBulletCannotFollow) {
  const Equivalence table = read(kHeader +
                                 "0.1,0.1,0.2,0.1,0.1,20,20\n0.1,0.1,0.6,0.2,0.1,20,20\n"
                                 "0.2,0.1,0.2,0.3,0.1,20,20\n0.2,0.1,0.6,,,20,\n");
  EXPECT_DOUBLE_EQ(table.at(0.1, 0.1, 0.3)->friction, 0.125);
  EXPECT_DOUBLE_EQ(table.at(0.15, 0.1, 0.2)->friction, 0.2);
  EXPECT_FALSE(table.at(0.15, 0.1, 0.4));
  EXPECT_THAT(table.range(), HasSubstr("without 1 of 4 pairs"));
}

TEST_F(EquivalenceTable, BadTablesAreRefused) {
  const auto reading = [&](const std::string& text) { return [this, text] { read(text); }; };
  EXPECT_THAT(reading("mu,mu_r\n"), ThrowsMessage<std::runtime_error>(HasSubstr(":1: the header must be")));
  EXPECT_THAT(reading(kHeader), ThrowsMessage<std::runtime_error>(HasSubstr("no rows")));
  EXPECT_THAT(reading(kHeader + "0.1,0.1,0.4,0.1\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr(":2: 4 fields, but the header has 7")));
  EXPECT_THAT(reading(kHeader + "0.1,0.1,0.4,-0.1,0,20,20\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr("'-0.1' is no number of 0 or more")));
  EXPECT_THAT(reading(kHeader + "0.1,0.1,0.4,0.1,,20,20\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr("or neither friction nor rolling")));
  EXPECT_THAT(reading(kHeader + "0.1,0.1,0.4,0.1,0.1,20,20\n0.2,0.2,0.4,0.1,0.1,20,20\n"),
              ThrowsMessage<std::runtime_error>(HasSubstr("2 rows are no grid of 2 x 2 x 1")));
  std::filesystem::remove(file);
  EXPECT_THAT([this] { Equivalence::read(file); },
              ThrowsMessage<std::runtime_error>(HasSubstr("there is no such file")));
}

}  // namespace
}  // namespace scree
