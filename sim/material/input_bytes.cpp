#include "sim/material/input_bytes.h"

#include <fmt/format.h>

#include <fstream>

namespace scree {
namespace {

// What a file is by its first bytes, where that is no text.
const char* kind_of_binary(std::string_view bytes) {
  const auto begins = [&](std::string_view mark) { return bytes.substr(0, mark.size()) == mark; };
  if (begins("\x89PNG") || begins("\xFF\xD8\xFF") || begins("GIF8") || begins("BM") || begins("II*") ||
      begins("MM"))
    if (bytes.substr(0, 4096).find('\0') != std::string_view::npos || begins("\xFF\xD8\xFF"))
      return "a picture, no text";
  if (begins("PK\x03\x04")) return "a spreadsheet or an archive, no text; save it as CSV";
  if (begins("\x1F\x8B")) return "compressed; unpack it first";
  if (begins("%PDF")) return "a PDF, no table";
  if (begins("\x89HDF")) return "HDF5, no text";
  if (begins("\xFF\xFE") || begins("\xFE\xFF")) return "UTF-16; save it as UTF-8";
  if (bytes.find('\0') != std::string_view::npos) return "binary, no text";
  return nullptr;
}

// Bytes of the letter that begins here; 0 if it is none of UTF-8 (RFC 3629: shortest form, no surrogates).
std::size_t letter_at(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t k) {
    return at + k < text.size() ? static_cast<unsigned char>(text[at + k]) : 0u;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xC2 && first < 0xE0   ? 2
                             : first >= 0xE0 && first < 0xF0 ? 3
                             : first >= 0xF0 && first < 0xF5 ? 4
                                                             : 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte(k) & 0xC0) != 0x80) return 0;
  const unsigned second = byte(1);
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second >= 0xA0) ||
      (first == 0xF0 && second < 0x90) || (first == 0xF4 && second >= 0x90))
    return 0;
  return length;
}

}  // namespace

FileError::FileError(const std::filesystem::path& file_, int line_, const std::string& message_)
    : std::runtime_error(one_line(line_ > 0 ? fmt::format("{}:{}: {}", file_.string(), line_, message_)
                                            : fmt::format("{}: {}", file_.string(), message_))),
      file(file_.string()),
      line(line_),
      message(message_) {}

std::string read_input_bytes(const std::filesystem::path& file, std::uintmax_t most) {
  std::error_code none;
  if (!std::filesystem::exists(file, none)) throw FileError(file, 0, "there is no such file");
  if (!std::filesystem::is_regular_file(file, none)) throw FileError(file, 0, "is no file");
  const std::uintmax_t size = std::filesystem::file_size(file, none);
  if (!none && size > most)
    throw FileError(file, 0,
                    fmt::format("is {:g} MB, more than the {:g} MB that are read",
                                static_cast<double>(size) * 1e-6, static_cast<double>(most) * 1e-6));
  std::ifstream in(file, std::ios::binary);
  std::string bytes(none ? 0 : size, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw FileError(file, 0, "cannot be read (no permission?)");
  if (bytes.empty()) throw FileError(file, 0, "the file is empty");
  return bytes;
}

std::string read_input_text(const std::filesystem::path& file, std::uintmax_t most) {
  std::string text = read_input_bytes(file, most);
  require_text(file, text);
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  return text;
}

void require_text(const std::filesystem::path& file, std::string_view bytes) {
  if (const char* kind = kind_of_binary(bytes)) throw FileError(file, 0, fmt::format("is {}", kind));
}

int line_that_is_not_utf8(std::string_view text) {
  int line = 1;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = letter_at(text, at);
    if (length == 0) return line;
    line += text[at] == '\n';
    at += length;
  }
  return 0;
}

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

}  // namespace scree
