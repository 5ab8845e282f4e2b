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
  std::error_code error;
  if (std::filesystem::is_symlink(file, error))  // what it names is written, and the link stays
    if (const auto target = std::filesystem::canonical(file, error); !error)
      return write_text_file(target, text);
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
