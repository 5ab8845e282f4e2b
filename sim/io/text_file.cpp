#include "sim/io/text_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace scree {

void fail_to_write(const std::filesystem::path& file, const std::string& reason) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", file.string(), reason));
}

std::filesystem::path linked_file(const std::filesystem::path& file) {
  std::filesystem::path place = file;
  std::error_code error;
  for (int links = 0; links < 40 && std::filesystem::is_symlink(place, error); ++links)
    place = place.parent_path() / std::filesystem::read_symlink(place, error);
  if (std::filesystem::is_symlink(place, error)) fail_to_write(file, "its links lead in a circle");
  return place;
}

void write_text_file(const std::filesystem::path& file, const std::string& text) {
  std::error_code error;
  if (std::filesystem::is_symlink(file, error)) return write_text_file(linked_file(file), text);
  if (const auto is = std::filesystem::status(file, error);
      std::filesystem::exists(is) && !std::filesystem::is_regular_file(is))
    fail_to_write(file, "it is there and no file");
  const std::filesystem::path temporary = file.string() + ".part";
  errno = 0;
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) {
    const std::string reason = errno ? std::strerror(errno) : "unknown reason";
    std::filesystem::remove(temporary, error);
    fail_to_write(file, reason);
  }
  std::filesystem::rename(temporary, file, error);
  if (!error) return;
  const std::string reason = error.message();
  std::filesystem::remove(temporary, error);
  fail_to_write(file, reason);
}

}  // namespace scree
