// Pictures of a section: that they are drawn, whatever lies in it.
#include "analysis/report/inside_pictures.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

#include "analysis/report/flow_picture.h"
#include "analysis/report/section_canvas.h"
#include "tests/analysis/fake_run.h"

namespace scree {
namespace {

class InsidePictures : public testing::Test {
 protected:
  InsidePictures() {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    section_.bench = BenchOutline{10, 45};
    Grain ball;
    ball.position = Vec3(-1, 0.5, 10);
    ball.diameter = 1;
    fixed_ = {ball};
  }

  ~InsidePictures() override { std::filesystem::remove_all(folder_); }

  static void expect_png(const Picture& picture) {
    std::ifstream in(picture.file, std::ios::binary);
    std::string start(4, ' ');
    in.read(start.data(), 4);
    EXPECT_EQ(start.substr(1), "PNG");
    EXPECT_GT(std::filesystem::file_size(picture.file), 10000U);
    EXPECT_FALSE(picture.title.empty() || picture.caption.empty());
  }

  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("scree_inside_pictures_" + std::to_string(getpid()));
  std::vector<Grain> pile_ = fake_seed(1).final_state.grains, fixed_;
  VerticalSection section_;
};

TEST_F(InsidePictures, Layers) {
  expect_png(draw_layers(pile_, fixed_, section_, folder_ / "layers.png"));
  for (Grain& grain : pile_) grain.dump = 1;
  expect_png(draw_layers(pile_, {}, section_, folder_ / "one.png"));
  for (std::size_t k = 0; k < pile_.size(); ++k) pile_[k].dump = static_cast<int>(k % 66);
  expect_png(draw_layers(pile_, {}, section_, folder_ / "many.png"));
}

TEST_F(InsidePictures, Maps) {
  expect_png(draw_inside(analyse_inside(pile_, fixed_, pile_, section_), folder_ / "inside.png"));
  InsideOptions none;
  none.fewest_grains = 100000;  // every cell is grey
  expect_png(draw_inside(analyse_inside(pile_, {}, pile_, section_, none), folder_ / "grey.png"));
}

// A few grains lie in the section and fill no cell: a run with them has a report all the same.
TEST_F(InsidePictures, AThinPileHasNoMaps) {
  EXPECT_TRUE(shows_rock(analyse_inside(pile_, {}, pile_, section_)));
  for (Grain& grain : pile_) grain.diameter *= 0.1;
  EXPECT_FALSE(shows_rock(analyse_inside(pile_, {}, pile_, section_)));
}

TEST_F(InsidePictures, VelocitiesOfFlowAndOfRest) {
  expect_png(draw_velocity({3, pile_}, fixed_, section_, folder_ / "rest.png"));
  for (Grain& grain : pile_) grain.velocity = Vec3(grain.position.z(), 0, -grain.position.z());
  expect_png(draw_velocity({3, pile_}, fixed_, section_, folder_ / "flow.png"));
}

TEST_F(InsidePictures, OfNothingAreRefused) {
  section_.y0 = 1000;
  EXPECT_THROW(draw_layers(pile_, {}, section_, folder_ / "x.png"), std::invalid_argument);
  EXPECT_THROW(draw_velocity({0, pile_}, {}, section_, folder_ / "x.png"), std::invalid_argument);
  EXPECT_THROW(draw_inside(analyse_inside(pile_, {}, pile_, section_), folder_ / "x.png"),
               std::invalid_argument);
}

TEST(SectionCanvas, RoundNumbers) {
  EXPECT_EQ(round_number_above(1), 1);
  EXPECT_NEAR(round_number_above(0.11), 0.2, 1e-12);
  EXPECT_NEAR(round_number_above(3), 5, 1e-12);
  EXPECT_NEAR(round_number_above(70), 100, 1e-12);
}

TEST(SectionCanvas, AStoneThatRolledFarDoesNotWidenTheFrame) {
  std::vector<Grain> pile = fake_seed(1).final_state.grains;
  VerticalSection section;
  const SectionFrame before = frame_of(pile, section);
  pile.push_back(pile.front());
  pile.back().position = Vec3(300, 0, 0.1);
  EXPECT_NEAR(frame_of(pile, section).right, before.right, 1);
}

}  // namespace
}  // namespace scree
