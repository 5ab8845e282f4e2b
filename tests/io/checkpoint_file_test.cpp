// Checkpoints are read as they were written, and known when they are damaged, wherever that is.
#include "sim/io/checkpoint_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <sstream>

namespace scree {
namespace {

using testing::HasSubstr;

class CheckpointFile : public testing::Test {
 protected:
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) / ("scree_checkpoint_" + std::to_string(getpid()));
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    file = folder / "checkpoint";
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  void write_one() const {
    write_checkpoint(file, {"scree 1", "abc", 42, 1.5}, [](StateWriter& state) {
      state.section("numbers", 3);
      std::vector<double> values(3000, 0.1);
      std::optional<double> none, some = -0.0;
      std::vector<std::vector<int>> rows{{1, 2}, {}, {3}};
      std::string text = "rock";
      state(values, none, some, rows, text);
    });
  }
  std::string bytes() const {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
  }
  void put(const std::string& text) const { std::ofstream(file, std::ios::binary) << text; }
  std::string why_refused() const {
    try {
      CheckpointReader reader(file);
    } catch (const DamagedCheckpoint& damage) {
      return damage.what();
    }
    return "";
  }
  std::filesystem::path folder, file;
};

TEST_F(CheckpointFile, IsReadAsWritten) {
  write_one();
  CheckpointReader reader(file);
  EXPECT_EQ(reader.header().program, "scree 1");
  EXPECT_EQ(reader.header().scenario, "abc");
  EXPECT_EQ(reader.header().seed, 42u);
  EXPECT_EQ(reader.header().time, 1.5);
  reader.state().section("numbers", 3);
  std::vector<double> values;
  std::optional<double> none = 1, some;
  std::vector<std::vector<int>> rows;
  std::string text;
  reader.state()(values, none, some, rows, text);
  EXPECT_EQ(values, std::vector<double>(3000, 0.1));
  EXPECT_FALSE(none);
  EXPECT_TRUE(some && *some == 0 && std::signbit(*some));
  EXPECT_EQ(rows, (std::vector<std::vector<int>>{{1, 2}, {}, {3}}));
  EXPECT_EQ(text, "rock");
  double more = 0;
  EXPECT_THROW(reader.state()(more), StateError);
}

TEST_F(CheckpointFile, SaysWhichSectionIsNotWhatItShouldBe) {
  write_one();
  const auto refusal = [&](const std::string& name, std::uint32_t version) {
    CheckpointReader reader(file);
    try {
      reader.state().section(name, version);
    } catch (const StateError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal("numbers", 3), "");
  EXPECT_THAT(refusal("numbers", 4),
              HasSubstr("section 'numbers' has version 3, this program reads version 4"));
  EXPECT_THAT(refusal("words", 3), HasSubstr("section 'numbers' where 'words' is expected"));
}

TEST_F(CheckpointFile, AnyBitThatIsTurnedIsNoticed) {
  write_one();
  const std::string whole = bytes();
  for (std::size_t at = 0; at < whole.size(); at += at < 200 || at + 40 > whole.size() ? 1 : 97) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (at % 8)));
    put(damaged);
    EXPECT_NE(why_refused(), "") << "byte " << at;
  }
  put(whole);
  EXPECT_EQ(why_refused(), "");
}

TEST_F(CheckpointFile, CutAnywhereOrGrownIsNoticed) {
  write_one();
  const std::string whole = bytes();
  for (std::size_t size = 0; size < whole.size(); size += size < 100 ? 1 : 311) {
    put(whole.substr(0, size));
    EXPECT_NE(why_refused(), "") << size << " bytes";
  }
  put(whole + "x");
  EXPECT_NE(why_refused(), "");
}

// Of what may be good and is only out of reach (permission, a broken disk) nobody says that it is damaged,
// and takes it away.
TEST_F(CheckpointFile, OneThatCannotBeReadIsNotDamaged) {
  std::filesystem::create_directories(file);
  for (const std::filesystem::path& path : {file, folder / "none"}) {
    try {
      CheckpointReader reader(path);
      FAIL();
    } catch (const UnreadableCheckpoint& error) {
      EXPECT_THAT(error.what(), HasSubstr("cannot be read: "));
    }
  }
}

TEST_F(CheckpointFile, OneThatCannotBeWrittenLeavesTheOneBefore) {
  write_one();
  const std::string before = bytes();
  EXPECT_THROW(write_checkpoint(file, {"scree 1", "abc", 42, 2},
                                [](StateWriter& state) {
                                  std::vector<double> values(1 << 20, 1.0);
                                  state(values);
                                  throw std::bad_alloc();
                                }),
               std::bad_alloc);
  EXPECT_EQ(bytes(), before);
  EXPECT_FALSE(std::filesystem::exists(file.string() + ".part"));
  try {
    write_checkpoint("/dev/full/no", {}, [](StateWriter&) {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("cannot write /dev/full/no: "));
  }
}

}  // namespace
}  // namespace scree
