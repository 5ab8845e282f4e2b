#pragma once
// What is fuzzed: every reader of files that others made, by name.
#include <span>
#include <string_view>

namespace scree::fuzz {

struct Target {
  const char* name;
  const char* file;                     ///< name of the file that the bytes are written to
  void (*read)(const char* file_name);  ///< of that file, in the scratch folder; null: `parse`
  void (*parse)(std::string_view bytes);
};

/// All of them; tests/fuzz/corpus has a folder of this name for each.
std::span<const Target> targets();
const Target* find_target(std::string_view name);

/// Gives the bytes to a target. Input that is wrong must be refused by the exceptions or the errors that the
/// reader's header names; anything else that leaves this function is a find.
void run(const Target& target, std::string_view bytes);

}  // namespace scree::fuzz
