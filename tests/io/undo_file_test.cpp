// A file that is written to in place can be taken back to its mark, whenever its writer ends.
#include "sim/io/undo_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <random>
#include <sstream>
#include <string>

namespace scree {
namespace {

class Undo : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) / ("scree_undo_" + std::to_string(getpid()));
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    path = folder / "data";
  }
  void TearDown() override { std::filesystem::remove_all(folder); }
  static std::string bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }
  std::filesystem::path folder, path;
};

void scribble(UndoFile& file, std::mt19937& random, int times) {
  std::uniform_int_distribution<int> place(0, 60000), length(1, 9000), letter('a', 'z');
  for (int k = 0; k < times; ++k) {
    const std::string text(static_cast<std::size_t>(length(random)), static_cast<char>(letter(random)));
    file.write(static_cast<std::uint64_t>(place(random)), text.data(), text.size());
    if (k % 7 == 6) file.resize(static_cast<std::uint64_t>(place(random)));
  }
}

TEST_F(Undo, TakesBackWhatWasWrittenSinceTheMark) {
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    std::string marked;
    {
      UndoFile file(path, round == 0);
      scribble(file, random, 5);
      file.mark();
      marked = bytes(path);
      scribble(file, random, round);
    }
    UndoFile::take_back(path);
    ASSERT_EQ(bytes(path), marked) << round;
    UndoFile::take_back(path);  // again: nothing more to take back
    ASSERT_EQ(bytes(path), marked) << round;
  }
}

TEST_F(Undo, HoldsTheMarkWhenTheFileIsOpenedAgain) {
  std::mt19937 random(2);
  {
    UndoFile file(path, true);
    scribble(file, random, 5);
    file.mark();
  }
  const std::string marked = bytes(path);
  for (int round = 0; round < 3; ++round) {
    {
      UndoFile file(path, false);
      scribble(file, random, 4);
    }
    EXPECT_NE(bytes(path), marked);
    UndoFile::take_back(path);
    EXPECT_EQ(bytes(path), marked);
  }
}

// A file that was copied in part is no file that its writer has made shorter.
TEST_F(Undo, RefusesAFileOfWhichAPartIsGone) {
  const std::string text(20000, 'a');
  {
    UndoFile file(path, true);
    file.write(0, text.data(), text.size());
    file.mark();
    file.write(18000, "rock", 4);
  }
  const std::string written = bytes(path);
  std::filesystem::resize_file(path, 9000);
  for (int k = 0; k < 2; ++k) EXPECT_THROW(UndoFile::take_back(path), std::runtime_error) << k;
  EXPECT_EQ(std::filesystem::file_size(path), 9000u) << "is left as it is";
  std::ofstream(path, std::ios::binary) << written;
  UndoFile::take_back(path);
  EXPECT_EQ(bytes(path), text);
  {
    UndoFile file(path, false);
    file.resize(9000);
  }
  UndoFile::take_back(path);
  EXPECT_EQ(bytes(path), text);
}

// A process that is killed while it saves a block leaves a record that is not whole; the block itself is
// untouched then.
TEST_F(Undo, PassesOverARecordThatIsNotWhole) {
  UndoFile file(path, true);
  const std::string first(20000, 'a'), second(5000, 'b');
  file.write(0, first.data(), first.size());
  file.mark();
  file.write(0, second.data(), second.size());
  const std::string undo = bytes(path.string() + ".undo"), now = bytes(path);
  for (std::size_t cut = 0; cut < undo.size(); cut += 37) {
    std::ofstream(path.string() + ".undo", std::ios::binary) << undo.substr(0, cut);
    // What the killed process had written: only blocks whose records are whole.
    const std::size_t whole = cut < 24 ? 0 : (cut - 24) / (24 + 4096);
    std::string state = first;
    state.replace(0, std::min<std::size_t>(whole * 4096, second.size()), second, 0,
                  std::min<std::size_t>(whole * 4096, second.size()));
    std::ofstream(path, std::ios::binary) << state;
    UndoFile::take_back(path);
    ASSERT_EQ(bytes(path), first) << cut;
  }
}

TEST_F(Undo, WithoutAMarkNothingIsTakenBack) {
  UndoFile file(path, true);
  file.write(0, "rock", 4);
  UndoFile::take_back(path);
  EXPECT_EQ(bytes(path), "rock");
  file.mark();
  file.write(0, "sand", 4);
  UndoFile::forget(path);
  UndoFile::take_back(path);
  EXPECT_EQ(bytes(path), "sand");
}

}  // namespace
}  // namespace scree
