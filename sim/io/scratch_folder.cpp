#include "sim/io/scratch_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <system_error>

#include "sim/io/text_file.h"

namespace scree {

ScratchFolder::ScratchFolder() {
  std::error_code error;
  const std::filesystem::path place = std::filesystem::temp_directory_path(error);
  if (error)
    throw std::runtime_error("there is no folder for temporary files; set TMPDIR to one that can be written");
  std::string name = (place / "scree-XXXXXX").string();
  if (!mkdtemp(name.data())) fail_to_write(name, std::strerror(errno));
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace scree
