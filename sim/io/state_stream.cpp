#include "sim/io/state_stream.h"

#include <fmt/format.h>

namespace scree {

void StateWriter::section(const std::string& name, std::uint32_t version) {
  std::string copy = name;
  (*this)(copy, version);
}

void StateReader::section(const std::string& name, std::uint32_t version) {
  std::string found;
  std::uint32_t found_version = 0;
  (*this)(found, found_version);
  if (found != name)
    throw StateError(fmt::format("saved state: section '{}' where '{}' is expected", found, name));
  if (found_version != version)
    throw StateError(fmt::format("saved state: section '{}' has version {}, this program reads version {}",
                                 name, found_version, version));
}

void StateReader::end_too_early() {
  throw StateError("saved state: it ends too early");
}

}  // namespace scree
