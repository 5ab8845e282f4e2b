// The store as two programs see it.
#include "sim/io/results_store.h"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

namespace fs = std::filesystem;

namespace scree {
namespace {

class Store : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("scree_store_" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    file = folder / "store.sqlite";
  }
  void TearDown() override { fs::remove_all(folder); }
  // Lets a second program claim a run and end in its own way; what it was told.
  Claim claim_elsewhere(bool waits_to_be_killed, pid_t& pid) {
    int pipe_ends[2];
    EXPECT_EQ(pipe(pipe_ends), 0);
    pid = fork();
    if (pid == 0) {
      ResultsStore store(file);
      const char answer = static_cast<char>(store.claim(run, "1", false));
      if (write(pipe_ends[1], &answer, 1) != 1) _exit(1);
      if (waits_to_be_killed) pause();
      _exit(0);
    }
    char answer = -1;
    EXPECT_EQ(read(pipe_ends[0], &answer, 1), 1);
    close(pipe_ends[0]), close(pipe_ends[1]);
    return static_cast<Claim>(answer);
  }
  fs::path folder, file;
  const RunRequest run{"00112233445566778899aabbccddeeff", "title: x\n", 10001};
};

TEST_F(Store, KeepsWhatARunGave) {
  {
    ResultsStore store(file);
    EXPECT_FALSE(store.find(run.key).has_value());
    EXPECT_EQ(store.claim(run, "1.0", false), Claim::ours);
    EXPECT_EQ(store.find(run.key)->state, RunState::running);
    store.finish(run.key, "{}", {{"angle_deg", 25.4}, {"particles", 13579}}, 12.5);
  }
  ResultsStore store(file);
  EXPECT_EQ(store.claim(run, "1.0", true), Claim::done);
  const auto found = store.find(run.key);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->state, RunState::done);
  EXPECT_EQ(found->version, "1.0");
  EXPECT_EQ(found->wall_seconds, 12.5);
  EXPECT_EQ(found->outputs, (std::map<std::string, double>{{"angle_deg", 25.4}, {"particles", 13579}}));
  EXPECT_EQ(store.summary(run.key), "{}");
}

TEST_F(Store, AFailedRunIsTriedAgainWhenAsked) {
  ResultsStore store(file);
  ASSERT_EQ(store.claim(run, "1.0", false), Claim::ours);
  store.fail(run.key, "it blew up", 1.0);
  EXPECT_EQ(store.claim(run, "1.0", false), Claim::failed);
  EXPECT_EQ(store.find(run.key)->message, "it blew up");
  EXPECT_EQ(store.claim(run, "1.0", true), Claim::ours);
}

TEST_F(Store, ReleasedRunIsFree) {
  ResultsStore store(file);
  ASSERT_EQ(store.claim(run, "1.0", false), Claim::ours);
  store.release(run.key);
  EXPECT_FALSE(store.find(run.key).has_value());
}

TEST_F(Store, OneProgramARunAndTheDeadHoldNone) {
  { ResultsStore store(file); }
  pid_t pid = 0;
  ASSERT_EQ(claim_elsewhere(true, pid), Claim::ours);
  {
    ResultsStore store(file);
    EXPECT_EQ(store.claim(run, "1", false), Claim::others);
    // What is not ours is not changed.
    store.finish(run.key, "{}", {{"angle_deg", 1}}, 1);
    store.fail(run.key, "no", 1);
    store.release(run.key);
    EXPECT_EQ(store.find(run.key)->state, RunState::running);
    EXPECT_TRUE(store.find(run.key)->outputs.empty());
  }
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
  ResultsStore store(file);
  EXPECT_EQ(store.claim(run, "1", false), Claim::ours);
}

TEST_F(Store, OtherMachinesClaimIsLostAfterAWhileOnly) {
  ResultsStore store(file);
  ASSERT_EQ(store.claim(run, "1", false), Claim::ours);
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &db), SQLITE_OK);
  const auto set = [&](const char* sql) {
    ASSERT_EQ(sqlite3_exec(db, sql, nullptr, nullptr, nullptr), SQLITE_OK);
  };
  set("UPDATE runs SET owner = 'elsewhere 1 2|17|4711'");
  EXPECT_EQ(store.claim(run, "1", false), Claim::others);
  set("UPDATE runs SET seen = seen - 601");
  EXPECT_EQ(store.claim(run, "1", false), Claim::ours);
  sqlite3_close(db);
}

TEST_F(Store, LookingNeedsNoRightToWrite) {
  EXPECT_THROW(ResultsStore(file, ResultsStore::Access::look), std::runtime_error);
  EXPECT_FALSE(fs::exists(file));
  {
    ResultsStore store(file);
    EXPECT_EQ(store.claim(run, "1", false), Claim::ours);
    EXPECT_TRUE(store.finish(run.key, "{}", {{"angle_deg", 25.5}}, 1));
  }
  ResultsStore store(file, ResultsStore::Access::look);
  EXPECT_EQ(store.find(run.key)->outputs.at("angle_deg"), 25.5);
  EXPECT_THROW(store.claim({"ffff", "title: y\n", 1}, "1", false), std::runtime_error);
}

TEST_F(Store, RefusesWhatIsNone) {
  std::ofstream(file) << "this is a text file that is long enough to be looked at by the library, is it not?";
  EXPECT_THROW(ResultsStore{file}, std::runtime_error);
  EXPECT_THROW(ResultsStore{folder / "missing" / "store.sqlite"}, std::runtime_error);
  const fs::path other = folder / "other.sqlite";
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(other.c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db, "CREATE TABLE runs (a)", nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_THROW(ResultsStore{other}, std::runtime_error);
  ASSERT_EQ(sqlite3_exec(db, "PRAGMA user_version = 99", nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_THROW(ResultsStore{other}, std::runtime_error);
  sqlite3_close(db);
}

}  // namespace
}  // namespace scree
