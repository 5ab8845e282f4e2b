#pragma once
// Whether a PLY file holds what its header announces.
#include <filesystem>
#include <optional>
#include <string>

namespace scree {

/// What is wrong with a PLY file before any reader makes room for it: a header that does not end or names
/// unknown numbers, fewer lines (ASCII) or bytes (binary) than announced, a list longer than what is left.
/// Nothing if the whole file holds together. Greg Turk, The PLY Polygon File Format (1994).
std::optional<std::string> ply_complaint(const std::filesystem::path& file);

}  // namespace scree
