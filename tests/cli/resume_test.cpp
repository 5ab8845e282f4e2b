// Runs that are killed, interrupted or short of disk and memory, and what is made of them.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>
#include <vector>

#include "tests/cli/call.h"

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

namespace {

constexpr const char kOften[] = "0.001";  // minutes between checkpoints

nlohmann::json untimed(nlohmann::json node) {
  if (node.is_object()) node.erase("wall_seconds");
  for (auto& part : node)
    if (part.is_structured()) part = untimed(part);
  return node;
}

class ResumeCli : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("scree_resume_cli_" + std::to_string(getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  std::string in_folder(const std::string& name) const { return (folder / name).string(); }
  // A bucket of 3 kg: some tenths of a second.
  static std::vector<std::string> words(const std::string& out, int seeds, const std::string& minutes) {
    return {"run",
            std::string(SCREE_SOURCE_DIR) + "/scenarios/repose_lab.yaml",
            "--set",
            "experiment.mass_kg=3",
            "--set",
            "output.frame_interval_s=0.05",
            "--seeds",
            std::to_string(seeds),
            "--out",
            out,
            "--threads",
            "2",
            "--summary-only",
            "--checkpoint-minutes",
            minutes};
  }
  static std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += word + " ";
    return text;
  }
  // Starts the program in the background; what it says goes to `log`.
  pid_t start(const std::vector<std::string>& given) const {
    const pid_t child = fork();
    if (child != 0) return child;
    std::string program = SCREE_BINARY;
    std::vector<std::string> copy = given;
    std::vector<char*> arguments{program.data()};
    for (std::string& word : copy) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int file = open(in_folder("log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    dup2(file, STDOUT_FILENO), dup2(file, STDERR_FILENO);
    execv(program.c_str(), arguments.data());
    _exit(127);
  }
  // Sends a signal when there are `count` checkpoints; the exit status.
  int stop_at(pid_t child, const fs::path& out, std::size_t count, int signal) const {
    int status = 0;
    for (int k = 0; k < 30000 && checkpoints_below(out).size() < count; ++k) {
      if (waitpid(child, &status, WNOHANG) == child) return status;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    kill(child, signal);
    waitpid(child, &status, 0);
    return status;
  }
  static void flip(const fs::path& file) {
    std::string bytes = slurp(file);
    bytes[bytes.size() / 2] ^= 16;
    std::ofstream(file, std::ios::binary) << bytes;
  }
  void expect_same(const std::string& a, const std::string& b) const {
    const auto summary = [&](const std::string& run) {
      return untimed(nlohmann::json::parse(slurp(folder / run / "summary.json")));
    };
    EXPECT_EQ(summary(a), summary(b));
    for (const auto& entry : fs::directory_iterator(folder / a))
      if (const std::string seed = entry.path().filename().string(); seed.starts_with("seed_")) {
        for (const char* file : {"particles.xyz", "particles.xdmf"})
          EXPECT_TRUE(slurp(folder / a / seed / file) == slurp(folder / b / seed / file))
              << seed << "/" << file;
      }
    for (const auto& entry : fs::recursive_directory_iterator(folder / b)) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(name.starts_with("particles.") || name.starts_with("s")) << name << " is left";
    }
  }
  fs::path folder;
};

TEST_F(ResumeCli, KilledAtAnyMomentItEndsWithTheSameResults) {
  ASSERT_EQ(call(joined(words(in_folder("whole"), 3, "0"))).code, 0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  int kills = 0, status = 0;
  std::vector<std::string> command = words(in_folder("killed"), 3, kOften);
  for (bool ended = false; !ended;) {
    const pid_t child = start(command);
    // Longer as time goes on: on a busy machine a step takes more than the first ones.
    const double patience = (0.05 + 0.4 * share(random)) * (1 + 0.1 * kills);
    const auto begin = std::chrono::steady_clock::now();
    while (!ended && std::chrono::steady_clock::now() - begin < std::chrono::duration<double>(patience)) {
      ended = waitpid(child, &status, WNOHANG) == child;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    if (ended) break;
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    ASSERT_LT(++kills, 200) << slurp(folder / "log");
    if (fs::exists(folder / "killed" / "resume.json"))
      command = {"run", "--resume", in_folder("killed"), "--threads", kills % 2 == 0 ? "1" : "3"};
    else
      fs::remove_all(folder / "killed");  // killed before it had begun
  }
  EXPECT_EQ(WEXITSTATUS(status), 0) << slurp(folder / "log");
  EXPECT_GE(kills, 2);
  EXPECT_THAT(slurp(folder / "log"), HasSubstr("goes on from t = "));
  expect_same("whole", "killed");
}

TEST_F(ResumeCli, InterruptSavesAndSaysHowToGoOn) {
  ASSERT_EQ(call(joined(words(in_folder("whole"), 1, "0"))).code, 0);
  const pid_t child = start(words(in_folder("run"), 1, "1000"));
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  while (!fs::exists(folder / "run" / "resume.json"))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGTERM);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_THAT(slurp(folder / "log"), HasSubstr("to go on: scree run --resume " + in_folder("run")));
  ASSERT_EQ(checkpoints_below(folder / "run").size(), 1u);
  const Called resumed = call("run --resume " + in_folder("run"));
  EXPECT_EQ(resumed.code, 0) << resumed.text;
  EXPECT_THAT(resumed.text, HasSubstr("goes on from t = "));
  expect_same("whole", "run");
  const Called again = call("run --resume " + in_folder("run"));
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.text, HasSubstr("this run has come to its end; there is nothing to resume"));
}

TEST_F(ResumeCli, DamagedCheckpointsArePassedOver) {
  ASSERT_EQ(call(joined(words(in_folder("whole"), 1, "0"))).code, 0);
  for (const std::size_t damaged : {1, 2}) {
    const std::string name = "run" + std::to_string(damaged);
    stop_at(start(words(in_folder(name), 1, kOften)), folder / name, 2, SIGKILL);
    std::vector<fs::path> found = checkpoints_below(folder / name);
    ASSERT_GE(found.size(), 2u);
    for (std::size_t k = 0; k < damaged; ++k) flip(found[found.size() - 1 - k]);
    if (damaged == 2)
      for (std::size_t k = 0; k + 2 < found.size(); ++k) fs::remove(found[k]);
    const Called resumed = call("run --resume " + in_folder(name));
    EXPECT_EQ(resumed.code, 0) << resumed.text;
    EXPECT_THAT(resumed.text, HasSubstr("damaged (its checksum does not match); it is passed over"));
    EXPECT_THAT(resumed.text, HasSubstr(damaged == 1 ? "goes on from t = " : "begins at its beginning"));
    expect_same("whole", name);
  }
}

TEST_F(ResumeCli, WhatCannotBeResumedIsRefusedWithExitCodeTwo) {
  const auto refusal = [&](const std::string& run) {
    const Called called = call("run --resume " + in_folder(run));
    EXPECT_EQ(called.code, 2) << called.text;
    EXPECT_EQ(std::count(called.text.begin(), called.text.end(), '\n'), 1) << called.text;
    return called.text;
  };
  EXPECT_THAT(refusal("missing"), HasSubstr("no run that can be resumed"));
  stop_at(start(words(in_folder("run"), 1, kOften)), folder / "run", 1, SIGKILL);
  const std::string record = slurp(folder / "run" / "resume.json"),
                    scenario = slurp(folder / "run" / "scenario.yaml");

  auto json = nlohmann::json::parse(record);
  json["program"] = "scree 9.9";
  std::ofstream(folder / "run" / "resume.json") << json;
  EXPECT_THAT(refusal("run"), HasSubstr("begun by scree 9.9, this is scree "));
  std::ofstream(folder / "run" / "resume.json") << record.substr(0, 40);
  EXPECT_THAT(refusal("run"), HasSubstr("resume.json: damaged"));
  std::ofstream(folder / "run" / "resume.json") << record;

  std::string other = scenario;
  other.replace(other.find("mass_kg: 3"), 10, "mass_kg: 4");
  std::ofstream(folder / "run" / "scenario.yaml") << other;
  EXPECT_THAT(refusal("run"), HasSubstr("has changed since the run began"));
  std::ofstream(folder / "run" / "scenario.yaml") << scenario;

  EXPECT_EQ(call("run --resume " + in_folder("run") + " --set material.mu=0.3").code, 2);
  EXPECT_THAT(call("run").text, HasSubstr("needs a scenario file, or --resume"));
  EXPECT_EQ(call("run --resume " + in_folder("run")).code, 0);
}

TEST_F(ResumeCli, ImpulseBeginsAnewAndSaysSo) {
  std::vector<std::string> command = words(in_folder("run"), 1, kOften);
  for (const char* value : {"engine=impulse", "experiment.mass_kg=1", "numerics.impulse_friction=0.2",
                            "numerics.impulse_rolling=0.2"})
    command.insert(command.end(), {"--set", value});
  const pid_t child = start(command);
  while (!fs::exists(folder / "run" / "resume.json"))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_TRUE(checkpoints_below(folder / "run").empty());
  const Called resumed = call("run --resume " + in_folder("run"));
  EXPECT_EQ(resumed.code, 0) << resumed.text;
  EXPECT_THAT(resumed.text, HasSubstr("begins at its beginning"));
}

// A file may not grow beyond a limit, as on a full disk.
TEST_F(ResumeCli, FullDiskIsOneMessageAndLeavesWhatWasWritten) {
  const auto limited = [&](const std::string& limit, const std::string& arguments) {
    const std::string command =
        "sh -c '" + limit + "; exec " + std::string(SCREE_BINARY) + " " + arguments + "' 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    Called result{-1, ""};
    char buffer[4096];
    while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) result.text.append(buffer, n);
    result.code = WEXITSTATUS(pclose(pipe));
    return result;
  };
  // Blocks of 512 bytes: enough for some frames, not for a checkpoint nor for all frames.
  const Called full = limited("ulimit -f 400", joined(words(in_folder("run"), 1, kOften)));
  EXPECT_EQ(full.code, 1) << full.text;
  EXPECT_THAT(full.text, HasSubstr("File too large"));
  EXPECT_THAT(full.text, HasSubstr("to go on: scree run --resume"));
  EXPECT_THAT(full.text, Not(HasSubstr("terminate")));
  const Called resumed = call("run --resume " + in_folder("run"));
  EXPECT_EQ(resumed.code, 0) << resumed.text;
  ASSERT_EQ(call(joined(words(in_folder("whole"), 1, "0"))).code, 0);
  expect_same("whole", "run");

  const Called starved = limited("ulimit -v 90000", joined(words(in_folder("starved"), 1, "0")));
  EXPECT_EQ(starved.code, 1) << starved.text;
  EXPECT_THAT(starved.text, HasSubstr("not enough memory"));
}

}  // namespace
