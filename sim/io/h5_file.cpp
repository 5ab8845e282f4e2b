#include "sim/io/h5_file.h"

#include <algorithm>
#include <memory>
#include <system_error>

#include "sim/io/h5_undo_driver.h"
#include "sim/io/text_file.h"

namespace scree {
namespace {

// After a write that failed (disk full), HDF5 1.10 crashes when it tidies up at the end of the program. Each
// file is closed by its owner, so that handler is not needed; it must be refused before the first call.
[[maybe_unused]] const bool kNoExitHandler = H5dont_atexit() >= 0;

constexpr hsize_t kRowsAChunk = 1 << 17;  // 1.5 MB of positions

/// The operating system's reason when HDF5 knows it, else HDF5's innermost words.
std::string reason_of_failure() {
  std::string reason;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_DOWNWARD,
      [](unsigned, const H5E_error2_t* error, void* text) -> herr_t {
        std::string& out = *static_cast<std::string*>(text);
        const std::string words = error->desc ? error->desc : "";
        if (out.find("errno") == std::string::npos && !words.empty()) out = words;
        return 0;
      },
      &reason);
  const std::string mark = "error message = '";
  if (const auto at = reason.find(mark); at != std::string::npos) {
    const auto begin = at + mark.size();
    return reason.substr(begin, reason.find('\'', begin) - begin);
  }
  return reason.empty() ? "unknown reason" : reason;
}

H5File::Shape after(hsize_t first, const H5File::Shape& row) {
  H5File::Shape shape{first};
  shape.insert(shape.end(), row.begin(), row.end());
  return shape;
}

}  // namespace

void ask_for_memory() {
  constexpr std::size_t kNeeded = 16 << 20;
  const auto some = std::make_unique_for_overwrite<char[]>(kNeeded);
  *static_cast<volatile char*>(some.get()) = 0;
}

QuietHdf5::QuietHdf5() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietHdf5::~QuietHdf5() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

H5File::H5File(const std::filesystem::path& path, bool create) : path_(path) {
  const H5Handle access = undo_access();
  check(access);
  file_ = checked(create ? H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access)
                         : H5Fopen(path.c_str(), H5F_ACC_RDWR, access),
                  H5Fclose);
}

H5Handle H5File::dataset(const char* path) const {
  return checked(H5Dopen2(file_, path, H5P_DEFAULT), H5Dclose);
}

H5Handle H5File::group(hid_t parent, const char* name) const {
  return checked(H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
}

void H5File::attribute(hid_t object, const char* name, const std::string& text) const {
  write_attribute(object, name, string_type(text.size()), {}, text.c_str());
}

void H5File::attribute(hid_t object, const char* name, const std::vector<int>& values) const {
  write_attribute(object, name, H5T_NATIVE_INT, values.size() == 1 ? Shape{} : Shape{values.size()},
                  values.data());
}

void H5File::repeated_attribute(hid_t object, const char* name, const std::string& word,
                                std::size_t count) const {
  std::string words;
  for (std::size_t i = 0; i < count; ++i) words += word + '\0';
  write_attribute(object, name, string_type(word.size()), {count}, words.data());
}

H5Handle H5File::fixed(hid_t parent, const char* name, hid_t type, const Shape& shape,
                       const void* data) const {
  H5Handle set =
      checked(H5Dcreate2(parent, name, type, space(shape), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data));
  return set;
}

void H5File::text(hid_t parent, const char* name, const std::string& words) const {
  fixed(parent, name, string_type(words.size()), {}, words.c_str());
}

H5Handle H5File::growing(hid_t parent, const char* name, hid_t type, const Shape& row, bool compress) const {
  const Shape size = after(0, row), most = after(H5S_UNLIMITED, row);
  Shape chunk = after(compress ? 1 : 256, row);
  for (std::size_t i = 1; i < chunk.size(); ++i) chunk[i] = std::min(chunk[i], kRowsAChunk);
  const H5Handle extent =
      checked(H5Screate_simple(static_cast<int>(size.size()), size.data(), most.data()), H5Sclose);
  const H5Handle options = checked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  check(H5Pset_chunk(options, static_cast<int>(chunk.size()), chunk.data()));
  if (compress) {
    check(H5Pset_shuffle(options));
    check(H5Pset_deflate(options, 4));
  }
  return checked(H5Dcreate2(parent, name, type, extent, H5P_DEFAULT, options, H5P_DEFAULT), H5Dclose);
}

void H5File::append(hid_t set, hid_t type, hsize_t frame, const Shape& row, const void* data) const {
  const Shape size = after(frame + 1, row), start = after(frame, Shape(row.size(), 0)), count = after(1, row);
  check(H5Dset_extent(set, size.data()));
  const H5Handle file_space = checked(H5Dget_space(set), H5Sclose);
  check(H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
  check(H5Dwrite(set, type, space(count), file_space, H5P_DEFAULT, data));
}

void H5File::link(hid_t from, hid_t to, const char* name) const {
  check(H5Lcreate_hard(from, name, to, name, H5P_DEFAULT, H5P_DEFAULT));
}

void H5File::cut(hid_t set, hsize_t frames, const Shape& row) const {
  check(H5Dset_extent(set, after(frames, row).data()));
}

void H5File::flush() const {
  check(H5Fflush(file_, H5F_SCOPE_GLOBAL));
}

void H5File::mark() const {
  flush();
  try {
    undo_file_of(file_)->mark();
  } catch (const std::system_error& error) {
    fail_to_write(path_, error.code().message());
  }
}

void H5File::close() {
  check(file_.reset());
}

void H5File::check(hid_t result) const {
  if (result < 0) fail_to_write(path_, reason_of_failure());
}

H5Handle H5File::checked(hid_t id, herr_t (*release)(hid_t)) const {
  check(id);
  return {id, release};
}

H5Handle H5File::space(const Shape& shape) const {
  return checked(shape.empty() ? H5Screate(H5S_SCALAR)
                               : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                 H5Sclose);
}

H5Handle H5File::string_type(std::size_t length) const {
  H5Handle type = checked(H5Tcopy(H5T_C_S1), H5Tclose);
  check(H5Tset_size(type, length + 1));
  check(H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

void H5File::write_attribute(hid_t object, const char* name, hid_t type, const Shape& shape,
                             const void* data) const {
  const H5Handle made =
      checked(H5Acreate2(object, name, type, space(shape), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(H5Awrite(made, type, data));
}

}  // namespace scree
