#pragma once
// Writing a text file whole.
#include <filesystem>
#include <string>

namespace scree {

/// What a link, or one after another, names at last, there or not; any other file is itself. Throws
/// std::runtime_error where links lead in a circle.
std::filesystem::path linked_file(const std::filesystem::path& file);

/// Writes a text file in one step: a reader sees the old file or the new one, never half of it.
/// Of a link its target is written. Throws std::runtime_error that names the file and the reason.
void write_text_file(const std::filesystem::path& file, const std::string& text);

/// Throws std::runtime_error "cannot write FILE: REASON".
[[noreturn]] void fail_to_write(const std::filesystem::path& file, const std::string& reason);

}  // namespace scree
