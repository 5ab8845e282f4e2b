// Small runs of every experiment beside the stored ones: a change of physics shows, a change of roundings
// does not. The runs have other seeds than the stored ones, so that they already lie as far off as a change
// of roundings would put them.
#include "tests/regression/small_runs/small_runs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

namespace scree {
namespace {

using testing::IsEmpty;

SceneShift tested(const std::string& scene, const std::vector<std::string>& overrides = {}) {
  return shift_of(read_numbers(stored_numbers_file()).at(scene),
                  run_scene(scene, kStoredSeeds + 1, kTestedSeeds, overrides));
}

// Half of kByChance is for the scenes, each with its share, half for all together.
double bound() {
  return kByChance / 2 / static_cast<double>(scene_names().size());
}

std::string in_words(const SceneShift& shift) {
  std::string text;
  for (std::size_t k = 0; k < shift.numbers.size() && k < 8; ++k) {
    const SceneShift::Number& each = shift.numbers[k];
    text += each.name + " " + std::to_string(each.now.mean) + ", stored " + std::to_string(each.stored.mean) +
            " +- " + std::to_string(each.stored.std) + ", z " + std::to_string(each.z) + "\n";
  }
  return text;
}

TEST(SmallRuns, AreWhatTheyWere) {
  std::vector<double> p;
  for (const std::string& scene : scene_names()) {
    const SceneShift shift = tested(scene);
    EXPECT_THAT(shift.broken, IsEmpty()) << scene;
    EXPECT_GT(shift.p, bound()) << scene << "\n" << in_words(shift);
    p.push_back(shift.p);
    std::printf("%-20s %3zu numbers, p %.4f\n", scene.c_str(), shift.numbers.size(), shift.p);
  }
  EXPECT_GT(together(p), kByChance / 2);
}

TEST(SmallRuns, HasEveryScene) {
  std::vector<std::string> stored;
  for (const auto& [scene, numbers] : read_numbers(stored_numbers_file())) stored.push_back(scene);
  EXPECT_EQ(stored, scene_names());
}

// That the bound is not too wide to notice anything.
TEST(SmallRuns, NoticesLocalDampingAQuarterLower) {
  EXPECT_LT(tested("end_dump", {"material.local_damping=0.3"}).p, bound());
}

TEST(SmallRuns, NoticesRebound) {
  EXPECT_THAT(tested("drop", {"material.local_damping=0.401"}).broken, testing::SizeIs(testing::Ge(1)));
}

}  // namespace
}  // namespace scree
