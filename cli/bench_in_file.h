#pragma once
// The bench of a pile that a run of scree wrote.
#include <filesystem>
#include <optional>

/// What the scenario in a trajectory (particles.h5) says of its bench and sections.
struct BenchInFile {
  double height = 0;  ///< m
  int sections = 0;   ///< of the slope
};

/// None of a file of another kind, and of a run without a bench.
std::optional<BenchInFile> bench_in_file(const std::filesystem::path& file);
