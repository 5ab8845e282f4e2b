// Runs that are killed, interrupted or short of disk and memory, and what is made of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "tests/cli/background.h"
#include "tests/cli/call.h"

namespace fs = std::filesystem;
using testing::AnyOf;
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
  Background start(const std::vector<std::string>& words) const { return {words, folder / "log"}; }
  // Begins a run in the folder of this name and kills it when there are `count` checkpoints.
  void kill_at(const std::string& name, std::size_t count) const {
    Background run = start(words(in_folder(name), 1, kOften));
    run.ended_before([&] { return checkpoints_below(folder / name).size() >= count; });
    run.send(SIGKILL);
    run.code();
  }
  static void flip(const fs::path& file) {
    std::string bytes = slurp(file);
    bytes[bytes.size() / 2] ^= 16;
    std::ofstream(file, std::ios::binary) << bytes;
  }
  // What the first gave the second gave, too.
  void expect_same_results(const std::string& a, const std::string& b) const {
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
  }
  // And nothing else is left of it.
  void expect_same(const std::string& a, const std::string& b) const {
    expect_same_results(a, b);
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
  int kills = 0, code = 0;
  const std::vector<std::string> anew = words(in_folder("killed"), 3, kOften);
  std::vector<std::string> command = anew;
  while (true) {
    Background run = start(command);
    // Longer as time goes on: on a busy machine a step takes more than the first ones.
    run.ended_within((0.05 + 0.4 * share(random)) * (1 + 0.1 * kills));
    run.send(SIGKILL);
    if ((code = run.code()) != -SIGKILL) break;
    ASSERT_LT(++kills, 200) << slurp(folder / "log");
    if (fs::exists(folder / "killed" / "resume.json")) {
      command = {"run", "--resume", in_folder("killed"), "--threads", kills % 2 == 0 ? "1" : "3"};
      continue;
    }
    // Killed after its results were there, or before it had begun. One that ends by itself is wanted.
    if (fs::exists(folder / "killed" / "summary.json"))
      expect_same_results("whole", "killed");
    else
      ASSERT_EQ(command, anew) << "a run that was resumed has lost its record";
    fs::remove_all(folder / "killed");
    command = anew;
  }
  EXPECT_EQ(code, 0) << slurp(folder / "log");
  EXPECT_GE(kills, 2);
  EXPECT_THAT(slurp(folder / "log"), HasSubstr("goes on from t = "));
  expect_same("whole", "killed");
}

TEST_F(ResumeCli, InterruptSavesAndSaysHowToGoOn) {
  ASSERT_EQ(call(joined(words(in_folder("whole"), 1, "0"))).code, 0);
  Background run = start(words(in_folder("run"), 1, "1000"));
  run.ended_within(0.15);
  run.ended_before([&] { return fs::exists(folder / "run" / "resume.json"); });
  run.send(SIGTERM);
  EXPECT_EQ(run.code(), 130);
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

// The one that waits for the other must not take its results for an unfinished run.
TEST_F(ResumeCli, ResumedWhileItStillRunsItIsLeftAlone) {
  Background run = start(words(in_folder("run"), 1, kOften));
  run.ended_before([&] { return fs::exists(folder / "run" / "resume.json"); });
  const Called resumed = call("run --resume " + in_folder("run"));
  EXPECT_EQ(run.code(), 0) << slurp(folder / "log");
  EXPECT_EQ(resumed.code, 2) << resumed.text;
  EXPECT_THAT(resumed.text, AnyOf(HasSubstr("there is nothing to resume"),
                                  HasSubstr("another scree works in it")));  // on a slow machine
  EXPECT_TRUE(fs::exists(folder / "run" / "summary.json"));
}

TEST_F(ResumeCli, ALostTerminalEndsARunLikeCtrlC) {
  Background run = start(words(in_folder("run"), 1, "1000"));
  run.ended_before([&] { return fs::exists(folder / "run" / "resume.json"); });
  run.ended_within(0.15);
  run.send(SIGHUP);  // from the shell
  run.send(SIGHUP);  // from the system
  EXPECT_EQ(run.code(), 130);
  EXPECT_EQ(checkpoints_below(folder / "run").size(), 1u);
}

// With --force nothing of an older run stands beside what the new one has come to.
TEST_F(ResumeCli, WhatAnOlderRunLeftIsGone) {
  const std::string run = joined(words(in_folder("run"), 1, "0"));
  ASSERT_EQ(call(run).code, 0);
  fs::create_directories(folder / "run" / "seed_77");
  fs::create_directories(folder / "run" / "pictures");
  for (const char* file :
       {"report.html", "pictures/pile.png", "pictures/mine.jpg", "seed_77/particles.h5", "mine.txt"})
    std::ofstream(folder / "run" / file) << "old";
  EXPECT_EQ(call(run + " --force").code, 0);
  EXPECT_FALSE(fs::exists(folder / "run" / "report.html"));
  EXPECT_FALSE(fs::exists(folder / "run" / "seed_77"));
  EXPECT_FALSE(fs::exists(folder / "run" / "pictures/pile.png"));
  for (const char* mine : {"mine.txt", "pictures/mine.jpg"})
    EXPECT_TRUE(fs::exists(folder / "run" / mine)) << mine << " is not a run's";
}

TEST_F(ResumeCli, DamagedCheckpointsArePassedOver) {
  ASSERT_EQ(call(joined(words(in_folder("whole"), 1, "0"))).code, 0);
  for (const std::size_t damaged : {1, 2}) {
    const std::string name = "run" + std::to_string(damaged);
    kill_at(name, 2);
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
  kill_at("run", 1);
  const std::string record = slurp(folder / "run" / "resume.json"),
                    scenario = slurp(folder / "run" / "scenario.yaml");

  auto json = nlohmann::json::parse(record);
  json["program"] = "scree 9.9";
  std::ofstream(folder / "run" / "resume.json") << json;
  EXPECT_THAT(refusal("run"), HasSubstr("begun by scree 9.9, this is scree "));
  std::ofstream(folder / "run" / "resume.json") << record.substr(0, 40);
  EXPECT_THAT(refusal("run"), HasSubstr("resume.json: damaged"));
  for (const char* seeds : {"[]", "[1.7]", "[-1]", "[1, 1]", "[null]"}) {
    json = nlohmann::json::parse(record);
    json["seeds"] = nlohmann::json::parse(seeds);
    std::ofstream(folder / "run" / "resume.json") << json;
    EXPECT_THAT(refusal("run"), HasSubstr("resume.json: damaged")) << seeds;
  }
  std::ofstream(folder / "run" / "resume.json") << record;

  std::string other = scenario;
  other.replace(other.find("mass_kg: 3"), 10, "mass_kg: 4");
  std::ofstream(folder / "run" / "scenario.yaml") << other;
  EXPECT_THAT(refusal("run"), HasSubstr("has changed since the run began"));
  std::ofstream(folder / "run" / "scenario.yaml") << scenario;

  EXPECT_EQ(call("run --resume " + in_folder("run") + " --set material.mu=0.3").code, 2);
  EXPECT_THAT(call("run").text, HasSubstr("needs a scenario file, or --resume"));

  // A checkpoint of another run, newer than its own.
  std::vector<std::string> of_another = words(in_folder("another"), 1, "1000");
  of_another.insert(of_another.end(), {"--set", "material.mu=0.3"});
  Background another = start(of_another);
  another.ended_before([&] { return fs::exists(folder / "another" / "resume.json"); });
  another.ended_within(0.15);
  another.send(SIGINT);
  ASSERT_EQ(another.code(), 130);
  const std::vector<fs::path> own = checkpoints_below(folder / "run");
  const fs::path strange = own.front().parent_path() / "checkpoint_999999";
  fs::copy_file(checkpoints_below(folder / "another").back(), strange);
  const Called refused = call("run --resume " + in_folder("run"));
  EXPECT_EQ(refused.code, 2) << refused.text;
  EXPECT_THAT(refused.text, HasSubstr("made of another scenario or seed"));
  EXPECT_THAT(refused.text, Not(HasSubstr("to go on")));
  fs::remove(strange);

  EXPECT_EQ(checkpoints_below(folder / "run"), own) << "what was refused is still there";
  const Called resumed = call("run --resume " + in_folder("run"));
  EXPECT_EQ(resumed.code, 0);
  EXPECT_THAT(resumed.text, HasSubstr("goes on from t = "));
}

// A pile that is read again with an effect on measurement gives what its own simulation would.
TEST_F(ResumeCli, KeptPilesAreReadWithTheSameResults) {
  const std::string blur = " --set effects.image_blur.width=0.4";
  const auto kept = joined(words(in_folder("kept"), 2, "0")) + "--keep-pile";
  ASSERT_EQ(call(kept).code, 0);
  ASSERT_EQ(call(joined(words(in_folder("whole"), 2, "0")) + blur).code, 0);
  const std::string read = joined(words(in_folder("read"), 2, "0")) + "--pile " + in_folder("kept");
  const Called done = call(read + blur);
  ASSERT_EQ(done.code, 0) << done.text;
  const auto summary = [&](const std::string& run) {
    return untimed(nlohmann::json::parse(slurp(folder / run / "summary.json")));
  };
  EXPECT_EQ(summary("read"), summary("whole"));
  EXPECT_NE(summary("read"), summary("kept"));

  const auto refused = [&](const std::string& command, const std::string& why) {
    const Called bad = call(command);
    EXPECT_EQ(bad.code, 2);
    EXPECT_THAT(bad.text, HasSubstr(why));
    EXPECT_EQ(std::count(bad.text.begin(), bad.text.end(), '\n'), 1) << bad.text;
  };
  fs::remove_all(folder / "read");
  refused(read + " --set material.mu=0.3", "a pile of another scenario or seed");
  refused(joined(words(in_folder("read"), 3, "0")) + "--pile " + in_folder("kept"), "no such pile");
  refused(joined(words(in_folder("kept"), 2, "0")) + "--force --pile " + in_folder("kept"), "another --out");
  for (const auto& entry : fs::recursive_directory_iterator(folder / "kept"))
    if (entry.path().filename() == "pile") flip(entry.path());
  refused(read + blur, "pile: damaged");
  EXPECT_FALSE(fs::exists(folder / "read")) << "nothing that looks like a run";

  // A run that is killed and resumed keeps its pile all the same, and a new run takes the old one away.
  Background run = start([&] {
    auto all = words(in_folder("killed"), 1, kOften);
    all.emplace_back("--keep-pile");
    return all;
  }());
  run.ended_before([&] { return checkpoints_below(folder / "killed").size() >= 2; });
  run.send(SIGKILL);
  run.code();
  ASSERT_EQ(call("run --resume " + in_folder("killed")).code, 0);
  const Called again =
      call(joined(words(in_folder("read"), 1, "0")) + "--pile " + in_folder("killed") + blur);
  EXPECT_EQ(again.code, 0) << again.text;
  EXPECT_EQ(call(joined(words(in_folder("killed"), 1, "0")) + "--force").code, 0);
  fs::remove_all(folder / "read");
  refused(joined(words(in_folder("read"), 1, "0")) + "--pile " + in_folder("killed"), "no such pile");
}

TEST_F(ResumeCli, ImpulseBeginsAnewAndSaysSo) {
  std::vector<std::string> command = words(in_folder("run"), 1, kOften);
  for (const char* value : {"engine=impulse", "experiment.mass_kg=1", "numerics.impulse_friction=0.2",
                            "numerics.impulse_rolling=0.2"})
    command.insert(command.end(), {"--set", value});
  Background run = start(command);
  run.ended_before([&] { return fs::exists(folder / "run" / "resume.json"); });
  run.send(SIGINT);
  EXPECT_EQ(run.code(), 130);
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

  // kB of address space; wherever the program is when there is no more.
  for (const char* limit : {"62000", "64000", "66000", "70000", "72000", "76000", "80000", "82000", "84000"}) {
    const Called starved =
        limited(std::string("ulimit -v ") + limit, joined(words(in_folder(limit), 1, "0")));
    EXPECT_EQ(starved.code, 1) << limit << ": " << starved.text;
    EXPECT_THAT(starved.text, HasSubstr("not enough memory")) << limit;
  }
}

}  // namespace
