#include "sim/io/undo_file.h"

#define XXH_INLINE_ALL
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <set>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace scree {
namespace {

constexpr std::uint64_t kBlock = 4096;

/// What stands before the bytes of a block in FILE.undo. The first of all has no bytes, and at `at` the size
/// of the file at the mark.
struct Record {
  std::uint64_t at = 0, size = 0, checksum = 0;
  std::uint64_t expected(const char* bytes) const {
    return XXH3_64bits_withSeed(bytes, size, at * 31 + size);
  }
};

[[noreturn]] void fail(const std::filesystem::path& file) {
  throw std::system_error(errno, std::generic_category(), file.string());
}

std::filesystem::path undo_of(const std::filesystem::path& file) {
  return file.string() + ".undo";
}

void write_all(int file, const std::filesystem::path& path, const void* data, std::size_t size,
               std::int64_t at) {
  const auto* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t done = at < 0 ? ::write(file, bytes, size) : pwrite(file, bytes, size, at);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(path);
    bytes += done;
    size -= static_cast<std::size_t>(done);
    if (at >= 0) at += done;
  }
}

/// Bytes read; fewer than `size` at the end of the file.
std::size_t read_some(int file, const std::filesystem::path& path, void* data, std::size_t size,
                      std::uint64_t at) {
  auto* bytes = static_cast<char*>(data);
  std::size_t all = 0;
  while (all < size) {
    const ssize_t done = pread(file, bytes + all, size - all, static_cast<off_t>(at + all));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(path);
    if (done == 0) break;
    all += static_cast<std::size_t>(done);
  }
  return all;
}

struct OpenFile {
  explicit OpenFile(int opened) : number(opened) {}
  ~OpenFile() {
    if (number >= 0) close(number);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  const int number;
};

}  // namespace

UndoFile::UndoFile(const std::filesystem::path& file, bool create) : path_(file) {
  if (create) forget(file);
  file_ = open(file.c_str(), O_RDWR | O_CLOEXEC | (create ? O_CREAT | O_TRUNC : 0), 0644);
  if (file_ < 0) fail(file);
  try {
    if (!create) open_undo();
  } catch (...) {
    close(file_);
    throw;
  }
}

UndoFile::~UndoFile() {
  close(file_);
  if (undo_ >= 0) close(undo_);
}

// Goes on with a mark that stands: with FILE.undo as take_back() leaves it, which has no blocks.
void UndoFile::open_undo() {
  undo_ = open(undo_of(path_).c_str(), O_RDWR | O_APPEND | O_CLOEXEC);
  if (undo_ < 0) return;
  Record first;
  if (read_some(undo_, path_, &first, sizeof first, 0) == sizeof first) marked_size_ = first.at;
}

std::uint64_t UndoFile::size() const {
  struct stat facts = {};
  if (fstat(file_, &facts) != 0) fail(path_);
  return static_cast<std::uint64_t>(facts.st_size);
}

void UndoFile::read(std::uint64_t at, void* data, std::size_t size) const {
  const std::size_t done = read_some(file_, path_, data, size, at);
  std::memset(static_cast<char*>(data) + done, 0, size - done);
}

void UndoFile::write(std::uint64_t at, const void* data, std::size_t size) {
  keep_old(at, size);
  write_all(file_, path_, data, size, static_cast<std::int64_t>(at));
}

void UndoFile::resize(std::uint64_t size) {
  if (size < marked_size_) keep_old(size, marked_size_ - size);
  if (ftruncate(file_, static_cast<off_t>(size)) != 0) fail(path_);
}

void UndoFile::keep_old(std::uint64_t at, std::uint64_t size) {
  if (undo_ < 0) return;
  std::array<char, sizeof(Record) + kBlock> record;
  const std::uint64_t end = std::min(at + size, marked_size_);
  for (std::uint64_t block = at / kBlock; block * kBlock < end; ++block) {
    if (!saved_.insert(block).second) continue;
    Record head{block * kBlock, std::min(kBlock, marked_size_ - block * kBlock), 0};
    char* const bytes = record.data() + sizeof head;
    read(head.at, bytes, head.size);
    head.checksum = head.expected(bytes);
    std::memcpy(record.data(), &head, sizeof head);
    write_all(undo_, undo_of(path_), record.data(), sizeof head + head.size, -1);
  }
}

void UndoFile::mark() {
  if (fdatasync(file_) != 0) fail(path_);
  // A new FILE.undo in one step: killed before it, the mark before holds.
  const std::filesystem::path undo = undo_of(path_), part = undo.string() + ".part";
  const int fresh = open(part.c_str(), O_RDWR | O_APPEND | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fresh < 0) fail(part);
  Record first{size(), 0, 0};
  first.checksum = first.expected(nullptr);
  try {
    write_all(fresh, part, &first, sizeof first, -1);
    if (fdatasync(fresh) != 0 || rename(part.c_str(), undo.c_str()) != 0) fail(undo);
  } catch (...) {
    close(fresh);
    unlink(part.c_str());
    throw;
  }
  if (undo_ >= 0) close(undo_);
  undo_ = fresh;
  marked_size_ = first.at;
  saved_.clear();
}

void UndoFile::take_back(const std::filesystem::path& file) {
  const std::filesystem::path undo = undo_of(file);
  const OpenFile old(open(undo.c_str(), O_RDWR | O_CLOEXEC));
  if (old.number < 0) return;
  const OpenFile now(open(file.c_str(), O_RDWR | O_CLOEXEC));
  if (now.number < 0) fail(file);
  std::optional<std::uint64_t> size;  // of the file at the mark
  std::array<char, kBlock> bytes;
  const auto each_block = [&](const auto& apply) {
    Record record;
    std::uint64_t at = 0;
    bool first = true;
    // A record that is not whole was being written when the process was killed; its block was not touched
    // yet.
    while (read_some(old.number, undo, &record, sizeof record, at) == sizeof record) {
      at += sizeof record;
      if (record.size > kBlock) break;
      if (read_some(old.number, undo, bytes.data(), record.size, at) != record.size ||
          record.checksum != record.expected(bytes.data()))
        break;
      at += record.size;
      if (std::exchange(first, false))
        size = record.at;
      else
        apply(record);
    }
  };
  std::set<std::uint64_t> kept;
  each_block([&](const Record& record) { kept.insert(record.at / kBlock); });
  if (!size) return;
  // Where the writer itself has made it shorter, what it cut off was kept.
  struct stat facts = {};
  if (fstat(now.number, &facts) != 0) fail(file);
  for (std::uint64_t at = static_cast<std::uint64_t>(facts.st_size); at < *size;
       at = (at / kBlock + 1) * kBlock)
    if (!kept.contains(at / kBlock))
      throw std::runtime_error(
          file.string() +
          ": is shorter than at the checkpoint; copy it again, or start anew with another --out");
  each_block([&](const Record& record) {
    write_all(now.number, file, bytes.data(), record.size, static_cast<std::int64_t>(record.at));
  });
  if (ftruncate(now.number, static_cast<off_t>(*size)) != 0 || fdatasync(now.number) != 0) fail(file);
  if (ftruncate(old.number, sizeof(Record)) != 0) fail(undo);
}

void UndoFile::forget(const std::filesystem::path& file) {
  std::error_code ignored;
  std::filesystem::remove(undo_of(file), ignored);
}

}  // namespace scree
