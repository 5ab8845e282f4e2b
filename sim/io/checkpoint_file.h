#pragma once
// A checkpoint on disk: what it is of, the state, and a checksum over all of it.
//
//   8 bytes   "SCREECKP"
//   u32       version of this format
//   u32       0x01020304 in the byte order of the machine that wrote it
//   program, scenario (strings: u64 length, bytes), seed (u64), time (double)
//   the state, in sections (state_stream.h)
//   16 bytes  XXH3-128 of everything before
//
// It is written beside its place, synced to the disk and renamed: under its name there is a whole checkpoint
// or none.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "sim/io/state_stream.h"

namespace scree {

/// How names of checkpoint files begin; a number follows.
inline constexpr std::string_view kCheckpointName = "checkpoint_";
/// The file of a seed's pile, which other runs may read.
inline constexpr std::string_view kPileName = "pile";
/// Where a run keeps both, and all else that it has of a seed.
std::filesystem::path seed_folder(const std::filesystem::path& run, std::uint64_t seed);
/// Those that are there.
std::vector<std::filesystem::path> seed_folders(const std::filesystem::path& run);

/// What a checkpoint is of.
struct CheckpointHeader {
  std::string program;   ///< version of the program that wrote it; no other goes on from it
  std::string scenario;  ///< hash of the scenario and of the files that it names
  std::uint64_t seed = 0;
  double time = 0;  ///< s, simulated
};

/// A checkpoint that is truncated, damaged, or no checkpoint at all.
struct DamagedCheckpoint : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// One that may be good, and is out of reach: permission, a broken disk.
struct UnreadableCheckpoint : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Writes a checkpoint; `state` gives its bytes. Throws std::runtime_error with the file and the reason (disk
/// full, no permission); what stood under that name before is untouched then.
void write_checkpoint(const std::filesystem::path& file, const CheckpointHeader& header,
                      const std::function<void(StateWriter&)>& state);

/// A checkpoint that was found whole.
class CheckpointReader {
 public:
  /// Reads all of it once to check it. Throws DamagedCheckpoint, UnreadableCheckpoint.
  explicit CheckpointReader(const std::filesystem::path& file);
  const CheckpointHeader& header() const { return header_; }
  /// The state, from its beginning on, once.
  StateReader& state() { return *state_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  CheckpointHeader header_;
  std::unique_ptr<StateReader> state_;
};

}  // namespace scree
