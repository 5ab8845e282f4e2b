#pragma once
// What a YAML file of scree is, by its keys.
#include <filesystem>
#include <string>

namespace scree {

enum class FileKind { scenario, sweep, calibration, study, model, dataset, unknown };

/// unknown: cannot be read, or has no key that tells; so has a scenario that takes its experiment from
/// another.
FileKind kind_of(const std::filesystem::path& file);

/// What is wrong if a file of this kind is wanted and another is given: its name, what it is, and which
/// command takes it. Empty if it is of this kind or unknown.
std::string why_another_kind(const std::filesystem::path& file, FileKind wanted);

}  // namespace scree
