#pragma once
// A file that can be taken back to how it was at a mark, whenever its writer is killed.
//
// A format that is written to in place (HDF5) is neither here nor there while it is written; a process killed
// in that moment leaves a file that cannot be opened. So before a block that was there at the mark is written
// over for the first time, its bytes are put into a file beside it, FILE.undo, as data bases do (rollback
// journal). take_back() puts them back and cuts off what came behind.
//
// It holds for a process that is killed. After a loss of power the mark itself is on the disk, but not
// necessarily the last blocks of FILE.undo.
#include <cstdint>
#include <filesystem>
#include <unordered_set>

namespace scree {

class UndoFile {
 public:
  /// Opens a file for reading and writing; `create`: new or emptied, without a mark. Otherwise the mark of
  /// FILE.undo holds on, if there is one. Throws std::system_error, as all of its functions do.
  UndoFile(const std::filesystem::path& file, bool create);
  ~UndoFile();
  UndoFile(const UndoFile&) = delete;
  UndoFile& operator=(const UndoFile&) = delete;

  std::uint64_t size() const;
  /// Reads `size` bytes at a place; zeros behind the end.
  void read(std::uint64_t at, void* data, std::size_t size) const;
  void write(std::uint64_t at, const void* data, std::size_t size);
  void resize(std::uint64_t size);
  /// Syncs the file to the disk; from now on it can be taken back to this moment.
  void mark();

  /// Brings a file back to its last mark; does nothing without one. Nobody may have it open. It may be called
  /// again if it was killed itself. Throws std::runtime_error if a part of the file is gone that its writer
  /// has not cut off.
  static void take_back(const std::filesystem::path& file);
  /// From now on the file cannot be taken back.
  static void forget(const std::filesystem::path& file);

 private:
  void keep_old(std::uint64_t at, std::uint64_t size);
  void open_undo();

  std::filesystem::path path_;
  int file_ = -1, undo_ = -1;
  std::uint64_t marked_size_ = 0;            // bytes of the file at the mark
  std::unordered_set<std::uint64_t> saved_;  // blocks that are in FILE.undo
};

}  // namespace scree
