#pragma once
#include <filesystem>

namespace scree {

/// An empty folder among the temporary files that goes away with its owner, and all in it.
class ScratchFolder {
 public:
  /// Throws std::runtime_error, as fail_to_write, if there can be none.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace scree
