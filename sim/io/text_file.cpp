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

void write_text_file(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path temporary = file.string() + ".part";
  errno = 0;
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  std::error_code error;
  if (!out) {
    const std::string reason = errno ? std::strerror(errno) : "unknown reason";
    std::filesystem::remove(temporary, error);
    fail_to_write(file, reason);
  }
  std::filesystem::rename(temporary, file, error);
  if (error) fail_to_write(file, error.message());
}

}  // namespace scree
