#pragma once
// The subcommands; each returns the exit code of the program.
#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

/// Exit codes of scree.
enum ExitCode { kOk = 0, kFailed = 1, kBadInput = 2, kInterrupted = 130 };

struct RunOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides;
  int seeds = 0;              ///< 0: those of the scenario
  int threads = 0;            ///< 0: as many as cores
  std::filesystem::path out;  ///< empty: runs/NAME
  bool force = false;         ///< write into a folder that is not empty
};

int run_run(const RunOptions& options);
int run_compare(const std::filesystem::path& dir, const std::vector<std::string>& cases);
int run_validate(const std::filesystem::path& file, const std::vector<std::string>& overrides);
int run_schema();

/// The project's assets folder.
std::filesystem::path asset_dir();

/// Set by Ctrl-C; a run looks at it and ends cleanly.
extern volatile std::sig_atomic_t interrupted;
