#pragma once
// Files that others made, as bytes: bounded in size, and checked to be text where text is meant.
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace scree {

/// Something wrong in a file that was read; what() is `file:line: message`, or `file: message` with line 0,
/// in one line whatever the file's name or content.
struct FileError : std::runtime_error {
  FileError(const std::filesystem::path& file, int line, const std::string& message);
  std::string file;
  int line;  ///< from 1
  std::string message;
};

/// Largest file that is read whole unless a reader says less, bytes.
inline constexpr std::uintmax_t kMostBytes = 1'000'000'000;

/// What some programs begin a text in UTF-8 with.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// The bytes of a file. Throws FileError if there is none, nothing in it, or more than `most` bytes; nothing
/// is read then.
std::string read_input_bytes(const std::filesystem::path& file, std::uintmax_t most = kMostBytes);

/// The same for a text, without its byte order mark. Throws FileError for what is none, as require_text.
std::string read_input_text(const std::filesystem::path& file, std::uintmax_t most = kMostBytes);

/// Throws FileError for what is no text: a picture, an archive, UTF-16.
void require_text(const std::filesystem::path& file, std::string_view bytes);

/// Number of the first line, from 1, that is not UTF-8; 0 if there is none.
int line_that_is_not_utf8(std::string_view text);

/// A message in one line: control characters as '?'.
std::string one_line(std::string text);

}  // namespace scree
