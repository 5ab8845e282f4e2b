// Bad input as a user gives it: files and commands with the lines the program must answer. The cases are
// data, tests/cli/bad_input/*.cases. Whatever is wrong, the program says so in the lines named and in no
// other, with the exit code of bad input, in bounded memory and time, and leaves nothing behind.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "scree_version.h"
#include "sim/io/scratch_folder.h"
#include "tests/cli/call.h"

namespace fs = std::filesystem;

namespace {

constexpr int kBadInput = 2;
constexpr int kSeconds = 60;                    // after which a call counts as hanging; most take 0.02
constexpr std::size_t kLongestLine = 1500;      // a list of all reference cases is some 1400
constexpr std::size_t kMostMemoryKb = 2 << 20;  // address space of a call

/// One line of a case: what to do, and the rest of the line.
struct Step {
  std::string word, rest;
};

struct Case {
  std::string name;
  std::vector<Step> steps;
};

/// Cases of a file; steps before the first case come before those of every one.
///
///     case NAME
///     file NAME            the lines that follow, each after "| ", are its text
///     bytes NAME 89 48     a file of these bytes (hexadecimal), or more of them
///     copy NAME FROM       a file of the source tree, FROM its path there
///     replace NAME OLD => NEW
///     cut NAME BYTES       leaves only so many; negative: so many less
///     size NAME BYTES      grows it to that size, without using the disk
///     repeat NAME COUNT    its text COUNT times
///     folder NAME          link NAME TO          locked NAME (not readable)
///     shell COMMAND        makes what the words above cannot
///     call ARGUMENTS       of scree, in the case's folder
///     code NUMBER          default 2
///     says TEXT            the next line that is printed has this in it, and there is a `says` for every
///     line prints TEXT          of input that is good: some line has this in it
std::vector<Case> read_cases(const fs::path& file) {
  std::ifstream in(file);
  std::vector<Case> cases;
  std::vector<Step> common;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#') continue;
    const auto blank = line.find(' ');
    Step step{line.substr(0, blank), blank == std::string::npos ? "" : line.substr(blank + 1)};
    if (step.word == "case")
      cases.push_back({step.rest, common});
    else
      (cases.empty() ? common : cases.back().steps).push_back(std::move(step));
  }
  return cases;
}

/// Everything below a folder with its size.
std::map<std::string, std::uintmax_t> content_of(const fs::path& folder) {
  std::map<std::string, std::uintmax_t> content;
  std::error_code none;  // of links that lead in a circle
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    content[entry.path().lexically_relative(folder)] = entry.is_regular_file(none) ? entry.file_size() : 0;
  return content;
}

class BadInput : public testing::TestWithParam<std::string> {
 protected:
  void append(const std::string& name, const std::string& text) const {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary | std::ios::app) << text;
  }

  /// False if a word is not known.
  bool prepare(const Step& step) {
    std::istringstream words(step.rest);
    std::string name;
    words >> name;
    const fs::path file = folder / name;
    if (step.word == "file") {
      fs::remove(file);
      append(name, "");
      open = name;
    } else if (step.word == "|") {
      append(open, step.rest + "\n");
    } else if (step.word == "bytes") {
      std::string bytes;
      for (std::string hex; words >> hex;) bytes += static_cast<char>(std::stoi(hex, nullptr, 16));
      append(name, bytes);
    } else if (step.word == "copy") {
      std::string from;
      words >> from;
      fs::create_directories(file.parent_path());
      fs::copy_file(fs::path(SCREE_SOURCE_DIR) / from, file, fs::copy_options::overwrite_existing);
    } else if (step.word == "replace") {
      const std::string change = step.rest.substr(name.size() + 1);
      const auto arrow = change.find(" => ");
      const std::string from = change.substr(0, arrow), to = change.substr(arrow + 4);
      std::string text = slurp(file);
      const auto at = text.find(from);
      EXPECT_NE(at, std::string::npos) << name << " has no " << from;
      if (at != std::string::npos) text.replace(at, from.size(), to);
      fs::remove(file);
      append(name, text);
    } else if (step.word == "cut") {
      long bytes = 0;
      words >> bytes;
      const auto size = static_cast<long>(fs::file_size(file));
      fs::resize_file(file, static_cast<std::uintmax_t>(bytes < 0 ? size + bytes : bytes));
    } else if (step.word == "size") {
      double bytes = 0;
      words >> bytes;
      fs::resize_file(file, static_cast<std::uintmax_t>(bytes));
    } else if (step.word == "repeat") {
      int count = 0;
      words >> count;
      const std::string text = slurp(file);
      for (int k = 1; k < count; ++k) append(name, text);
    } else if (step.word == "folder") {
      fs::create_directories(file);
    } else if (step.word == "link") {
      std::string to;
      words >> to;
      fs::create_symlink(to, file);
    } else if (step.word == "locked") {
      fs::permissions(file, fs::perms::none);
      locked = true;
    } else if (step.word == "shell") {
      EXPECT_EQ(called("cd " + folder.string() + " && (" + step.rest + ")").code, 0);
    } else {
      return false;
    }
    return true;
  }

  void run(const Case& test);

  scree::ScratchFolder scratch;
  const fs::path& folder = scratch.path();
  std::string open;     // the file that "| " lines go to
  bool locked = false;  // a file must not be readable
};

void BadInput::run(const Case& test) {
  SCOPED_TRACE(test.name);
  for (const auto& entry : fs::directory_iterator(folder)) fs::remove_all(entry);
  locked = false;
  std::string arguments;
  std::vector<std::string> lines, somewhere;
  int code = kBadInput;
  for (const Step& step : test.steps) {
    if (step.word == "call")
      arguments = step.rest;
    else if (step.word == "code")
      code = std::stoi(step.rest);
    else if (step.word == "says")
      lines.push_back(step.rest);
    else if (step.word == "prints")
      somewhere.push_back(step.rest);
    else
      ASSERT_TRUE(prepare(step)) << step.word;
  }
  if (locked && geteuid() == 0) return;  // nothing is locked for root

  const auto before = content_of(folder);
  const Called called = call_in(folder, arguments, kSeconds);
  EXPECT_EQ(called.code, code) << arguments << "\n" << called.text;
  for (const std::string& text : somewhere)
    EXPECT_NE(called.text.find(text), std::string::npos) << called.text;
  if (somewhere.empty()) {
    std::istringstream printed(called.text);
    std::size_t count = 0;
    for (std::string line; std::getline(printed, line); ++count) {
      EXPECT_LT(line.size(), kLongestLine) << line;
      for (const char c : line) EXPECT_FALSE(static_cast<unsigned char>(c) < 0x20 || c == 0x7f) << line;
      if (count < lines.size()) {
        EXPECT_NE(line.find(lines[count]), std::string::npos) << "\n  " << line << "\n  " << lines[count];
      }
    }
    EXPECT_EQ(count, lines.size()) << called.text;
  }
  EXPECT_EQ(content_of(folder), before) << "left behind, or changed";
}

TEST_P(BadInput, IsToldInALineEachAndLeavesNothing) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  const rlimit limit{kMostMemoryKb << 10, kMostMemoryKb << 10};
  setrlimit(RLIMIT_AS, &limit);  // of the calls too; each ctest is a process of its own
#endif
  const std::vector<Case> cases =
      read_cases(fs::path(SCREE_SOURCE_DIR) / "tests/cli/bad_input" / (GetParam() + ".cases"));
  EXPECT_GE(cases.size(), 5u);
  const char* only = std::getenv("SCREE_CASE");
  for (const Case& test : cases)
    if (only == nullptr || test.name == only) run(test);
}

// Every table that is there: none is forgotten.
std::vector<std::string> tables() {
  std::vector<std::string> names;
  for (const auto& item : fs::directory_iterator(fs::path(SCREE_SOURCE_DIR) / "tests/cli/bad_input"))
    if (item.path().extension() == ".cases") names.push_back(item.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Files, BadInput, testing::ValuesIn(tables()),
                         [](const auto& file) { return file.param; });

}  // namespace
