// The loop over runs, with a program that only pretends to simulate.
#include "cli/ensemble/ensemble.h"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>

namespace fs = std::filesystem;

namespace scree {
namespace {

class Runs : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("scree_ensemble_" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    for (int k = 0; k < 6; ++k)
      requests.push_back({"key" + std::to_string(k), "number: " + std::to_string(k) + "\n", 1});
  }
  void TearDown() override { fs::remove_all(folder); }

  // A program called as `PROGRAM run FOLDER/scenario.yaml --out FOLDER/run ...`; `body` sees its number in
  // $n.
  fs::path program(const std::string& body) {
    const fs::path file = folder / "program.sh";
    std::ofstream(file) << "#!/bin/sh\nn=$(sed 's/number: //' \"$2\")\necho $n >> "
                        << (folder / "begun").string() << "\n"
                        << body << "\n"
                        << R"(mkdir -p "$4"; cat > "$4/summary.json" <<END
{"title": "made up", "comparison": [], "per_seed": [
  {"seed": 1, "outputs": {"particles": 10, "simulated_seconds": 1.5, "at_rest": 1, "angle_deg": $n}}]}
END
)";
    fs::permissions(file, fs::perms::owner_all);
    return file;
  }
  std::vector<std::string> begun() {
    std::ifstream in(folder / "begun");
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
  }
  static bool go_on(const EnsembleProgress&) { return true; }

  fs::path folder;
  std::vector<RunRequest> requests;
};

TEST_F(Runs, AllComeIntoTheStoreOnce) {
  ResultsStore store(folder / "store.sqlite");
  LocalProcesses processes(3, 5, program("sleep 0.1"));
  requests.push_back(requests.front());  // stands in the sweep twice
  const EnsembleProgress end = run_ensemble(requests, store, processes, {"1", false}, go_on);
  EXPECT_EQ(end.runs, 6u);
  EXPECT_EQ(end.done, 6u);
  EXPECT_EQ(end.failed, 0u);
  EXPECT_EQ(begun().size(), 6u);
  for (int k = 0; k < 6; ++k) {
    const auto found = store.find("key" + std::to_string(k));
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->state, RunState::done);
    EXPECT_EQ(found->outputs.at("angle_deg"), k);
    EXPECT_EQ(found->outputs.at("at_rest"), 1);
    EXPECT_GT(found->wall_seconds, 0.09);
  }
  EXPECT_FALSE(fs::exists(folder / "store.sqlite.work"));
  EXPECT_EQ(run_ensemble(requests, store, processes, {"1", false}, go_on).ended_here, 0u);
  EXPECT_EQ(begun().size(), 6u) << "a repeated sweep costs nothing";
}

// A program can be killed between a result's way into the store and the end of its folder.
TEST_F(Runs, FolderOfOneThatIsInTheStoreIsTakenAway) {
  ResultsStore store(folder / "store.sqlite");
  const fs::path left = folder / "store.sqlite.work" / "key3" / "run";
  const auto run = [&] {
    LocalProcesses processes(2, 5, program(""));
    return run_ensemble(requests, store, processes, {"1", false}, go_on).ended_here;
  };
  EXPECT_EQ(run(), 6u);
  fs::create_directories(left);
  EXPECT_EQ(run(), 0u);
  EXPECT_FALSE(fs::exists(folder / "store.sqlite.work"));
}

// What is left of a sweep does not leave cores idle.
TEST_F(Runs, FewerThanPlacesGetMoreThreads) {
  ResultsStore store(folder / "store.sqlite");
  const auto threads = [&](std::size_t count) {
    const fs::path words = folder / "words";
    fs::remove(words);
    LocalProcesses processes(5, 5, program("echo \"$@\" >> " + words.string() + "; sleep 0.2"));
    const std::vector<RunRequest> some(requests.begin(), requests.begin() + static_cast<long>(count));
    EXPECT_EQ(run_ensemble(some, store, processes, {"1", false}, go_on).done, count);
    EXPECT_EQ(processes.free_places(), 5);
    std::ifstream in(words);
    std::string all;
    for (std::string line; std::getline(in, line);) all += line.substr(line.find("--threads ") + 10, 1);
    std::sort(all.begin(), all.end());
    return all;
  };
  EXPECT_EQ(threads(3), "122");
  EXPECT_EQ(threads(4), "5") << "three are in the store";
}

TEST_F(Runs, OneThatFailsDoesNotStopTheRest) {
  ResultsStore store(folder / "store.sqlite");
  LocalProcesses processes(2, 5,
                           program("echo ' 12 %  about 3 s left'; case $n in 2) echo 'seed 1: it blew up'; "
                                   "exit 1;; 3) kill -9 $$;; 4) exit 0;; esac"));
  EnsembleProgress end = run_ensemble(requests, store, processes, {"1", false}, go_on);
  EXPECT_EQ(end.done, 3u);
  EXPECT_EQ(end.failed, 3u);
  EXPECT_EQ(store.find("key2")->message, "seed 1: it blew up");
  EXPECT_EQ(store.find("key3")->message, "killed by signal 9, 3 times");
  EXPECT_NE(store.find("key4")->message.find("not a summary"), std::string::npos);
  end = run_ensemble(requests, store, processes, {"1", false}, go_on);
  EXPECT_EQ(end.ended_here, 0u);
  LocalProcesses mended(2, 5, program(""));
  end = run_ensemble(requests, store, mended, {"1", true}, go_on);
  EXPECT_EQ(end.ended_here, 3u);
  EXPECT_EQ(end.done, 6u);
}

TEST_F(Runs, OneThatIsInterruptedAloneIsDoneAgain) {
  ResultsStore store(folder / "store.sqlite");
  // As by whoever lacks memory: killed, and once is no failure.
  const std::string mark = (folder / "interrupted").string();
  LocalProcesses processes(2, 5,
                           program("if [ $n = 1 ] && [ ! -e " + mark + "1 ]; then touch " + mark +
                                   "1; kill -9 $$; fi; if [ $n = 2 ] && [ ! -e " + mark + " ]; then touch " +
                                   mark + "; exit 130; fi; if [ $n = 4 ]; then exit 130; fi"));
  const EnsembleProgress end = run_ensemble(requests, store, processes, {"1", false}, go_on);
  EXPECT_EQ(end.done, 5u);
  EXPECT_EQ(end.failed, 1u);
  EXPECT_EQ(store.find("key2")->outputs.at("angle_deg"), 2);
  EXPECT_EQ(store.find("key4")->message, "interrupted 3 times");
  EXPECT_EQ(begun().size(), 3u + 2 + 2 + 3);
}

TEST_F(Runs, InterruptedOnesAreGivenBackAndEnd) {
  ResultsStore store(folder / "store.sqlite");
  LocalProcesses processes(2, 5, program("exec sleep 100"));
  const auto start = std::chrono::steady_clock::now();
  const EnsembleProgress end =
      run_ensemble(requests, store, processes, {"1", false}, [&](const EnsembleProgress&) {
        return std::chrono::steady_clock::now() - start < std::chrono::milliseconds(500);
      });
  EXPECT_EQ(end.here, 2u);
  for (const RunRequest& run : requests) EXPECT_FALSE(store.find(run.key).has_value());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  EXPECT_FALSE(fs::exists(folder / "store.sqlite.work"));
}

// A run of a program that was stopped for long (a laptop that slept) is taken by another, here of another
// machine: it is waited for like any other that others do.
TEST_F(Runs, OneWhoseClaimWasLostIsLeftToItsNewOwner) {
  ResultsStore store(folder / "store.sqlite");
  const auto change = [&](const std::string& sql) {
    sqlite3* db = nullptr;
    ASSERT_EQ(sqlite3_open(store.file().c_str(), &db), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
    sqlite3_close(db);
  };
  requests.resize(1);
  LocalProcesses processes(1, 5, program("sleep 0.5"));
  bool taken = false, left = false;
  const EnsembleProgress end =
      run_ensemble(requests, store, processes, {"1", false}, [&](const EnsembleProgress& p) {
        if (p.here == 1 && !taken) change("UPDATE runs SET owner = 'elsewhere|1|1'"), taken = true;
        if (p.others == 1 && !left) change("UPDATE runs SET state = 'done', owner = NULL"), left = true;
        return true;
      });
  EXPECT_TRUE(taken && left);
  EXPECT_EQ(end.done, 1u);
  EXPECT_EQ(end.failed, 0u);
  EXPECT_EQ(end.ended_here, 0u);
  EXPECT_TRUE(store.find("key0")->outputs.empty()) << "the result of the other is kept";
  EXPECT_EQ(begun().size(), 1u);
}

// What a resumed run had done before is not counted as done in the time that this program has worked.
TEST_F(Runs, TheTimeLeftCountsWhatIsDoneHere) {
  ResultsStore store(folder / "store.sqlite");
  requests.resize(1);
  const fs::path kept = folder / "store.sqlite.work" / "key0" / "run" / "seed_1";
  fs::create_directories(kept);
  std::ofstream(kept / "checkpoint_1") << "state";
  const fs::path file = folder / "resumed.sh";
  std::ofstream(file)
      << "#!/bin/sh\necho ' 80 %  about 9 s left'; sleep 0.5; echo ' 90 %  about 3 s left'; sleep "
         "0.5\ncat > $3/summary.json <<END\n"
         R"({"title": "made up", "comparison": [], "per_seed": [
  {"seed": 1, "wall_seconds": 500, "outputs": {"particles": 10, "at_rest": 1}}]}
END
)";
  fs::permissions(file, fs::perms::owner_all);
  LocalProcesses processes(1, 5, file);
  double most = 0, share = 0;
  const EnsembleProgress end =
      run_ensemble(requests, store, processes, {"1", false}, [&](const EnsembleProgress& p) {
        if (p.here == 1) most = std::max(most, p.work_here);
        share = std::max(share, p.share_under_way);
        return true;
      });
  EXPECT_NEAR(share, 0.9, 1e-9);
  EXPECT_NEAR(most, 0.1, 1e-9);
  EXPECT_NEAR(end.work_here, 0.2, 1e-9);
}

// Readings of one pile: one of them simulates and keeps its pile, the others read it, and it is gone at last.
// Those of a pile that no other run shares keep none.
TEST_F(Runs, ReadingsOfOnePileAreOneSimulation) {
  const auto say = [&](const std::string& body) {
    return program(
        "echo \"$n $(echo $* | grep -o -- '--keep-pile') $(echo $* | grep -o 'piles/[a-z]*')\" >> " +
        (folder / "how").string() + "\n" + body);
  };
  const auto how = [&] {
    std::ifstream in(folder / "how");
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    std::sort(lines.begin(), lines.end());
    fs::remove(folder / "how");
    return lines;
  };
  const std::string keep =
      "case \"$*\" in *--keep-pile*) mkdir -p $4/seed_1; echo heap > $4/seed_1/pile;; esac; sleep 0.05";
  for (const int k : {0, 2, 5}) requests[static_cast<std::size_t>(k)].pile = "one";
  requests[1].pile = "other";
  {
    ResultsStore store(folder / "store.sqlite");
    LocalProcesses processes(2, 5, say(keep));
    const EnsembleProgress end = run_ensemble(requests, store, processes, {"1", false}, go_on);
    EXPECT_EQ(end.done, 6u);
    EXPECT_EQ(how(), (std::vector<std::string>{"0 --keep-pile ", "1  ", "2  piles/one", "3  ", "4  ",
                                               "5  piles/one"}));
    EXPECT_FALSE(fs::exists(folder / "store.sqlite.work"));
  }
  {  // A pile that is refused is made anew.
    ResultsStore store(folder / "damaged.sqlite");
    LocalProcesses processes(1, 5, say("case \"$*\" in *--pile*) echo damaged; exit 2;; esac; " + keep));
    const EnsembleProgress end = run_ensemble(requests, store, processes, {"1", false}, go_on);
    EXPECT_EQ(end.done, 6u);
    EXPECT_EQ(end.failed, 0u);
    EXPECT_EQ(how(), (std::vector<std::string>{"0 --keep-pile ", "1  ", "2  piles/one", "2 --keep-pile ",
                                               "3  ", "4  ", "5  ", "5  piles/one"}));
    EXPECT_FALSE(fs::exists(folder / "damaged.sqlite.work"));
  }
}

// A program that makes a checkpoint, is interrupted there, and goes on from it when it is asked to.
TEST_F(Runs, ThoseWithACheckpointGoOnFromIt) {
  const fs::path file = folder / "long.sh";
  const std::string begun = (folder / "begun").string();
  const auto write = [&](const std::string& resumed) {
    std::ofstream(file) << "#!/bin/sh\nif [ $2 = --resume ]; then out=$3; echo resumed >> " << begun << "\n"
                        << resumed << "\nelse out=$4; echo anew >> " << begun << R"(
  if [ ! -e )" << (folder / "refusing").string()
                        << R"( ]; then
    mkdir -p $out/seed_1; touch $out/resume.json $out/seed_1/checkpoint_1
    if [ -e )" << (folder / "killing").string()
                        << R"( ]; then echo "not enough memory"; exit 1; fi
    exec sleep 100
  fi
  mkdir -p $out
fi
cat > $out/summary.json <<END
{"title": "made up", "comparison": [], "per_seed": [
  {"seed": 1, "wall_seconds": 500, "outputs": {"particles": 10, "simulated_seconds": 1.5, "at_rest": 1, "angle_deg": 3}}]}
END
)";
    fs::permissions(file, fs::perms::owner_all);
  };
  const auto interrupted_at_checkpoints = [&](ResultsStore& store) {
    LocalProcesses processes(2, 5, file);
    run_ensemble(requests, store, processes, {"1", false}, [&](const EnsembleProgress&) {
      for (const char* key : {"key0", "key1"})
        if (!fs::exists(store.file().string() + ".work/" + key + "/run/seed_1/checkpoint_1")) return true;
      return false;
    });
  };
  requests.resize(2);
  write("");
  {
    ResultsStore store(folder / "store.sqlite");
    interrupted_at_checkpoints(store);
    LocalProcesses processes(2, 5, file);
    const EnsembleProgress end = run_ensemble(requests, store, processes, {"1", false}, go_on);
    EXPECT_EQ(end.done, 2u);
    EXPECT_EQ(this->begun(), (std::vector<std::string>{"anew", "anew", "resumed", "resumed"}));
    EXPECT_EQ(store.find("key0")->wall_seconds, 500) << "of all its parts";
    EXPECT_FALSE(fs::exists(folder / "store.sqlite.work"));
  }
  {  // One that failed for want of memory is resumed when it is tried again.
    ResultsStore store(folder / "killed.sqlite");
    LocalProcesses processes(2, 5, file);
    fs::remove(folder / "begun");
    std::ofstream(folder / "killing") << "yes";
    EnsembleProgress end = run_ensemble(requests, store, processes, {"1", false}, go_on);
    EXPECT_EQ(end.failed, 2u);
    EXPECT_EQ(store.find("key0")->message, "not enough memory");
    end = run_ensemble(requests, store, processes, {"1", true}, go_on);
    EXPECT_EQ(end.done, 2u);
    EXPECT_EQ(this->begun(), (std::vector<std::string>{"anew", "anew", "resumed", "resumed"}));
    fs::remove(folder / "begun");
    fs::remove(folder / "killing");
  }
  {  // Checkpoints of another version of the program are refused: the run begins anew.
    ResultsStore store(folder / "other.sqlite");
    interrupted_at_checkpoints(store);
    write("echo of another version; exit 2");
    std::ofstream(folder / "refusing") << "yes";
    fs::remove(folder / "begun");
    LocalProcesses processes(1, 5, file);
    const EnsembleProgress end = run_ensemble(requests, store, processes, {"1", false}, go_on);
    EXPECT_EQ(end.done, 2u);
    EXPECT_EQ(end.failed, 0u);
    EXPECT_EQ(end.begun_anew, 2u);
    EXPECT_NE(end.why_anew.find("of another version"), std::string::npos) << end.why_anew;
    EXPECT_EQ(this->begun(), (std::vector<std::string>{"resumed", "anew", "resumed", "anew"}));
    EXPECT_LT(store.find("key0")->wall_seconds, 100);
  }
}

}  // namespace
}  // namespace scree
