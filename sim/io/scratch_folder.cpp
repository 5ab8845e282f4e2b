#include "sim/io/scratch_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "sim/io/text_file.h"

namespace scree {

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "scree-XXXXXX").string();
  if (!mkdtemp(name.data())) fail_to_write(name, std::strerror(errno));
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace scree
