#include "sim/io/checkpoint_file.h"

#define XXH_INLINE_ALL
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "sim/io/text_file.h"

namespace scree {
namespace {

constexpr char kMagic[] = "SCREECKP";
constexpr std::size_t kMagicSize = 8, kDigestSize = 16;
constexpr std::uint32_t kFormat = 1, kByteOrder = 0x01020304;
constexpr std::size_t kBuffer = 1 << 20;

/// The checksum of a stream of bytes.
class Checksum {
 public:
  Checksum() { XXH3_128bits_reset(&state_); }
  void add(const void* data, std::size_t size) { XXH3_128bits_update(&state_, data, size); }
  std::array<unsigned char, kDigestSize> digest() const {
    XXH128_canonical_t canonical;
    XXH128_canonicalFromHash(&canonical, XXH3_128bits_digest(&state_));
    std::array<unsigned char, kDigestSize> bytes;
    std::memcpy(bytes.data(), canonical.digest, kDigestSize);
    return bytes;
  }

 private:
  XXH3_state_t state_;
};

/// A new file that is there under its name when it is whole; taken away when it does not come to that.
class NewFile {
 public:
  explicit NewFile(const std::filesystem::path& path) : path_(path), part_(path.string() + ".part") {
    file_ = open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (file_ < 0) fail();
    buffer_.reserve(kBuffer);
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile() {
    if (file_ < 0) return;
    close(file_);
    unlink(part_.c_str());
  }
  void add(const void* data, std::size_t size) {
    checksum_.add(data, size);
    add_unchecked(data, size);
  }
  void finish() {
    const auto digest = checksum_.digest();
    add_unchecked(digest.data(), digest.size());
    flush();
    if (fsync(file_) != 0) fail();
    if (rename(part_.c_str(), path_.c_str()) != 0) fail();
    close(file_);
    file_ = -1;
    // The new name is on the disk when the folder is.
    const std::filesystem::path folder = path_.has_parent_path() ? path_.parent_path() : ".";
    const int parent = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (parent < 0) return;
    fsync(parent);
    close(parent);
  }

 private:
  void add_unchecked(const void* data, std::size_t size) {
    if (buffer_.size() + size > kBuffer) flush();
    if (size > kBuffer) return put(static_cast<const char*>(data), size);
    const auto* bytes = static_cast<const char*>(data);
    buffer_.insert(buffer_.end(), bytes, bytes + size);
  }
  void flush() {
    put(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  void put(const char* data, std::size_t size) {
    while (size > 0) {
      const ssize_t done = write(file_, data, size);
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) fail();
      data += done;
      size -= static_cast<std::size_t>(done);
    }
  }
  [[noreturn]] void fail() const { fail_to_write(path_, std::strerror(errno)); }

  std::filesystem::path path_, part_;
  int file_ = -1;
  std::vector<char> buffer_;
  Checksum checksum_;
};

template <class Stream>
void head(Stream& stream, CheckpointHeader& header) {
  stream(header.program, header.scenario, header.seed, header.time);
}

}  // namespace

std::filesystem::path seed_folder(const std::filesystem::path& run, std::uint64_t seed) {
  return run / fmt::format("seed_{}", seed);
}

std::vector<std::filesystem::path> seed_folders(const std::filesystem::path& run) {
  std::vector<std::filesystem::path> found;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(run, none)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("seed_") && name.size() > 5 &&
        name.find_first_not_of("0123456789", 5) == std::string::npos)
      found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

void write_checkpoint(const std::filesystem::path& file, const CheckpointHeader& header,
                      const std::function<void(StateWriter&)>& state) {
  NewFile out(file);
  out.add(kMagic, kMagicSize);
  StateWriter writer([&](const void* data, std::size_t size) { out.add(data, size); });
  writer(kFormat, kByteOrder);
  CheckpointHeader copy = header;
  head(writer, copy);
  state(writer);
  out.finish();
}

CheckpointReader::CheckpointReader(const std::filesystem::path& path) : path_(path) {
  const auto damaged = [&](const std::string& why) {
    throw DamagedCheckpoint(fmt::format("{}: {}", path.string(), why));
  };
  file_.reset(std::fopen(path.c_str(), "rb"));
  // What cannot be read may be good for all that is known: it is not said to be damaged.
  const auto unreadable = [this](int why) {
    throw UnreadableCheckpoint(fmt::format("{}: cannot be read: {}", path_.string(), std::strerror(why)));
  };
  if (!file_) unreadable(errno);
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(path, error);
  if (error) unreadable(error.value());
  constexpr std::uint64_t kLeast = kMagicSize + 2 * sizeof(std::uint32_t) + kDigestSize;
  if (size < kLeast) damaged("too short for a checkpoint");

  const auto read = [this, unreadable](void* data, std::size_t count) {
    if (std::fread(data, 1, count, file_.get()) == count) return;
    if (std::ferror(file_.get()) != 0) unreadable(errno);
    throw DamagedCheckpoint(fmt::format("{}: cannot be read to its end", path_.string()));
  };
  Checksum checksum;
  std::vector<char> buffer(kBuffer);
  for (std::uint64_t left = size - kDigestSize; left > 0;) {
    const auto part = static_cast<std::size_t>(std::min<std::uint64_t>(left, kBuffer));
    read(buffer.data(), part);
    checksum.add(buffer.data(), part);
    left -= part;
  }
  std::array<unsigned char, kDigestSize> digest;
  read(digest.data(), digest.size());
  std::rewind(file_.get());
  char magic[kMagicSize];
  read(magic, kMagicSize);
  if (std::memcmp(magic, kMagic, kMagicSize) != 0) damaged("no checkpoint");
  if (digest != checksum.digest()) damaged("damaged (its checksum does not match)");

  state_ = std::make_unique<StateReader>(read, size - kMagicSize - kDigestSize);
  std::uint32_t format = 0, order = 0;
  (*state_)(format, order);
  if (order != kByteOrder) damaged("written on a machine of another byte order");
  if (format != kFormat) damaged(fmt::format("of format {}, this program reads {}", format, kFormat));
  head(*state_, header_);
}

}  // namespace scree
