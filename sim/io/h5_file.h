#pragma once
// The few acts on an HDF5 file that our outputs need, each checked.
#include <hdf5.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace scree {

/// Owner of one HDF5 identifier.
class H5Handle {
 public:
  H5Handle() = default;
  H5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  H5Handle(H5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  H5Handle& operator=(H5Handle&& other) noexcept {
    reset();
    id_ = std::exchange(other.id_, -1);
    close_ = other.close_;
    return *this;
  }
  H5Handle(const H5Handle&) = delete;
  H5Handle& operator=(const H5Handle&) = delete;
  ~H5Handle() { reset(); }
  operator hid_t() const { return id_; }
  herr_t reset() { return id_ >= 0 ? close_(std::exchange(id_, -1)) : 0; }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

/// HDF5 crashes or ends the program where it finds no memory in the middle of its work: what it may need is
/// asked for before. Throws std::bad_alloc.
void ask_for_memory();

/// Keeps HDF5 from printing its error stack while it lives; what it says is thrown instead.
class QuietHdf5 {
 public:
  QuietHdf5();
  ~QuietHdf5();
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// An HDF5 file, new or to be gone on with, that can be taken back to a mark (undo_file.h). Every act throws
/// std::runtime_error with the file's name and the reason when it fails.
class H5File {
 public:
  /// Shape of a data set, or of one row of it.
  using Shape = std::vector<hsize_t>;

  explicit H5File(const std::filesystem::path& path, bool create = true);

  H5Handle dataset(const char* path) const;

  H5Handle group(hid_t parent, const char* name) const;
  H5Handle group(const char* name) const { return group(file_, name); }
  void attribute(hid_t object, const char* name, const std::string& text) const;
  /// A scalar for one value, else a list.
  void attribute(hid_t object, const char* name, const std::vector<int>& values) const;
  /// `count` times the same word.
  void repeated_attribute(hid_t object, const char* name, const std::string& word, std::size_t count) const;

  /// A data set written once; an empty shape is a scalar.
  H5Handle fixed(hid_t parent, const char* name, hid_t type, const Shape& shape, const void* data) const;
  void text(hid_t parent, const char* name, const std::string& words) const;
  /// A data set that grows by one row a frame; `compress`: shuffle and gzip 4, a frame a chunk.
  H5Handle growing(hid_t parent, const char* name, hid_t type, const Shape& row, bool compress) const;
  /// Writes row number `frame`, after growing the set to hold it.
  void append(hid_t set, hid_t type, hsize_t frame, const Shape& row, const void* data) const;
  /// Leaves the first `frames` rows of a set that grows.
  void cut(hid_t set, hsize_t frames, const Shape& row) const;
  /// A hard link: `name` of group `from` stands in group `to` too.
  void link(hid_t from, hid_t to, const char* name) const;
  void flush() const;
  /// Flushes, syncs to the disk, and sets the mark.
  void mark() const;
  void close();

 private:
  void check(hid_t result) const;
  H5Handle checked(hid_t id, herr_t (*release)(hid_t)) const;
  H5Handle space(const Shape& shape) const;
  H5Handle string_type(std::size_t length) const;
  void write_attribute(hid_t object, const char* name, hid_t type, const Shape& shape,
                       const void* data) const;

  std::filesystem::path path_;
  H5Handle file_;
};

}  // namespace scree
