#pragma once
// The subcommand scree field.
#include <filesystem>
#include <string>
#include <vector>

struct FieldCliOptions {
  std::filesystem::path gradings;  ///< table by image and section
  std::filesystem::path original;  ///< grading of the rock as dumped; empty: each picture's whole slope
  std::filesystem::path sieved;    ///< grading of the fines, with
  std::string limit;               ///< below which it counts, "0.1m"
  double void_ratio = 0.3;
  std::filesystem::path printed;         ///< values to hold ours against
  std::filesystem::path scenario;        ///< of the dataset; empty: none is written
  std::vector<std::string> observables;  ///< of the dataset; empty: chi
  bool thesis = false;                   ///< take the files of the thesis where none is given
  std::filesystem::path out;             ///< empty: runs/NAME
  bool force = false;                    ///< write into a folder that is not empty
};

/// Returns the exit code of the program, see cli/commands.h.
int run_field(const FieldCliOptions& options);
