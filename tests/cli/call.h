#pragma once
// The program called as a user calls it.
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "scree_version.h"

struct Called {
  int code;
  std::string text;  // stdout and stderr
};

inline Called called(const std::string& command) {
  FILE* pipe = popen((command + " 2>&1 </dev/null").c_str(), "r");
  Called result{-1, ""};
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) result.text.append(buffer, n);
  const int status = pclose(pipe);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return result;
}

inline Called call(const std::string& arguments) {
  return called(std::string(SCREE_BINARY) + " " + arguments);
}

/// In a folder, ended after some seconds (exit code 124). $SOURCE is the source tree.
inline Called call_in(const std::filesystem::path& folder, const std::string& arguments, int seconds) {
  return called("SOURCE=" SCREE_SOURCE_DIR "; cd " + folder.string() + " && timeout " +
                std::to_string(seconds) + " " SCREE_BINARY " " + arguments);
}

/// The whole checkpoints anywhere below a folder, by name.
inline std::vector<std::filesystem::path> checkpoints_below(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  std::error_code none;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("checkpoint_") && !name.ends_with(".part")) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

inline std::string slurp(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}
