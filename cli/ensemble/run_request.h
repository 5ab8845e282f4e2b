#pragma once
// From a scenario to what identifies its simulation with one seed.
#include <filesystem>
#include <string>

#include "sim/io/results_store.h"
#include "sim/scene/scenario.h"

namespace scree {

/// Raised whenever the same scenario and seed give other numbers than before: results of an older program are
/// not taken for those of this one. A regression test says when.
inline constexpr int kResultsRevision = 8;

/// What a key says of the program: its version and kResultsRevision.
std::string results_version();

/// The scenario with this seed alone, without what changes no result (title, reference cases, frames). Its
/// key is a hash of that text, of `version`, and of the grading and the meshes themselves: renaming a file
/// changes nothing, another content does; `pile` is that of the scenario without effects on measurement.
/// Throws std::runtime_error if a file cannot be read.
RunRequest run_request(Scenario scenario, std::uint64_t seed, const std::string& version,
                       const std::filesystem::path& asset_dir);

}  // namespace scree
