#include "sim/io/h5_undo_driver.h"

#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>

namespace scree {
namespace {

// HDF5 knows a driver by functions over a struct that begins with H5FD_t.
struct Driver {
  H5FD_t shared;  // filled in by HDF5
  UndoFile file;
  haddr_t end_of_addresses = 0;

  Driver(const char* name, bool create) : shared(), file(name, create) {}
};

Driver& of(H5FD_t* file) {
  return *reinterpret_cast<Driver*>(file);
}
const Driver& of(const H5FD_t* file) {
  return *reinterpret_cast<const Driver*>(file);
}

// Runs `act`; what it throws goes on HDF5's error stack, in the words of HDF5's own drivers.
template <class Act>
herr_t guarded(const char* what, hid_t minor, const Act& act) {
  try {
    act();
    return 0;
  } catch (const std::system_error& error) {
    H5Epush2(H5E_DEFAULT, __FILE__, what, 0, H5E_ERR_CLS, H5E_IO, minor,
             "file %s failed: errno = %d, error message = '%s'", what, error.code().value(),
             std::strerror(error.code().value()));
  } catch (const std::bad_alloc&) {
    H5Epush2(H5E_DEFAULT, __FILE__, what, 0, H5E_ERR_CLS, H5E_IO, minor,
             "file %s failed: errno = %d, error message = '%s'", what, ENOMEM, std::strerror(ENOMEM));
  }
  return -1;
}

H5FD_t* open_driver(const char* name, unsigned flags, hid_t, haddr_t) {
  Driver* driver = nullptr;
  guarded("open", H5E_CANTOPENFILE, [&] {
    driver = std::make_unique<Driver>(name, (flags & H5F_ACC_CREAT) != 0).release();  // HDF5 owns it
  });
  return driver == nullptr ? nullptr : &driver->shared;
}

herr_t close_driver(H5FD_t* file) {
  const std::unique_ptr<Driver> driver(&of(file));
  return 0;
}

herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t end_of_addresses(const H5FD_t* file, H5FD_mem_t) {
  return of(file).end_of_addresses;
}
herr_t set_end_of_addresses(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  of(file).end_of_addresses = end;
  return 0;
}
haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t) {
  haddr_t size = HADDR_UNDEF;
  guarded("stat", H5E_READERROR, [&] { size = of(file).file.size(); });
  return size;
}
herr_t handle(H5FD_t* file, hid_t, void** out) {
  *out = &of(file).file;
  return 0;
}
herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* data) {
  return guarded("read", H5E_READERROR, [&] { of(file).file.read(at, data, size); });
}
herr_t write(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* data) {
  return guarded("write", H5E_WRITEERROR, [&] { of(file).file.write(at, data, size); });
}
herr_t truncate(H5FD_t* file, hid_t, hbool_t) {
  return guarded("truncate", H5E_CANTUPDATE, [&] {
    Driver& driver = of(file);
    if (driver.file.size() != driver.end_of_addresses) driver.file.resize(driver.end_of_addresses);
  });
}

hid_t driver_number() {
  static const hid_t number = [] {
    static H5FD_class_t driver = {};
    driver.name = "scree undo";
    driver.maxaddr = haddr_t{1} << 62;
    driver.fc_degree = H5F_CLOSE_WEAK;
    driver.open = open_driver;
    driver.close = close_driver;
    driver.query = query;
    driver.get_eoa = end_of_addresses;
    driver.set_eoa = set_end_of_addresses;
    driver.get_eof = end_of_file;
    driver.get_handle = handle;
    driver.read = read;
    driver.write = write;
    driver.truncate = truncate;
    const H5FD_mem_t kinds[] = H5FD_FLMAP_DICHOTOMY;
    for (int k = 0; k < H5FD_MEM_NTYPES; ++k) driver.fl_map[k] = kinds[k];
    return H5FDregister(&driver);
  }();
  return number;
}

}  // namespace

H5Handle undo_access() {
  H5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  if (access < 0 || driver_number() < 0 || H5Pset_driver(access, driver_number(), nullptr) < 0) return {};
  return access;
}

UndoFile* undo_file_of(hid_t file) {
  void* found = nullptr;
  if (H5Fget_vfd_handle(file, H5P_DEFAULT, &found) < 0) return nullptr;
  return static_cast<UndoFile*>(found);
}

}  // namespace scree
