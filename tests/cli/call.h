#pragma once
// The program called as a user calls it.
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

struct Called {
  int code;
  std::string text;  // stdout and stderr
};

inline Called call(const std::string& arguments) {
  const std::string command = std::string(SCREE_BINARY) + " " + arguments + " 2>&1 </dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  Called result{-1, ""};
  char buffer[4096];
  while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) result.text.append(buffer, n);
  result.code = WEXITSTATUS(pclose(pipe));
  return result;
}

inline std::string slurp(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}
