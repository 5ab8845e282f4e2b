#include "cli/output_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "cli/ensemble/exit_code.h"
#include "sim/material/input_bytes.h"

namespace fs = std::filesystem;

fs::path free_run_folder(const std::string& name) {
  fs::path folder = fs::path("runs") / name;
  for (int k = 2; fs::exists(folder); ++k) folder = fs::path("runs") / fmt::format("{}-{}", name, k);
  return folder;
}

bool may_fill(const fs::path& folder, bool force) {
  if (!force && fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder))) {
    fmt::print(stderr, "{}: is there already; choose another --out, or --force to write into it\n",
               folder.string());
    return false;
  }
  std::error_code none;
  fs::path there = fs::weakly_canonical(fs::absolute(folder), none);
  if (none) there = fs::absolute(folder);
  while (!fs::exists(there, none) && there.has_relative_path()) there = there.parent_path();
  if (fs::is_directory(there, none) && access(there.c_str(), W_OK | X_OK) == 0) return true;
  fmt::print(stderr, "{}: cannot be written: {} {}; choose another --out\n", folder.string(), there.string(),
             fs::is_directory(there, none) ? "gives no permission" : "is no folder");
  return false;
}

bool may_write(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code none;
  const bool there = fs::is_directory(folder, none), is_there = fs::exists(file, none);
  const bool is_folder = fs::is_directory(file, none), other = is_there && !fs::is_regular_file(file, none);
  const bool may = access((is_there ? file : folder).c_str(), W_OK) == 0;
  const std::string name = file.string();
  const bool odd = std::any_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20; });
  // /dev/stdout and its like name what a shell has opened, by the process.
  const bool opened = fs::absolute(fs::is_symlink(file, none) ? fs::read_symlink(file, none) : file)
                          .string()
                          .starts_with("/proc/");
  if (there && !other && may && !odd && !opened) return true;
  fmt::print(stderr, "{}: cannot be written: {}\n", scree::one_line(name),
             odd               ? "its name has a control character"
             : is_folder       ? "it is a folder"
             : other || opened ? "it is there and no file"
             : !there          ? "its folder is not there"
                               : "no permission");
  return false;
}

bool may_replace(const fs::path& file, const std::vector<fs::path>& in_use) {
  if (!may_write(file)) return false;
  std::error_code none;
  const auto same = [&](const fs::path& other) {
    return !other.empty() && (fs::equivalent(file, other, none) ||
                              fs::weakly_canonical(file, none) == fs::weakly_canonical(other, none));
  };
  if (std::none_of(in_use.begin(), in_use.end(), same)) return true;
  fmt::print(stderr, "{}: is used by this very command; write to another file\n", file.string());
  return false;
}

bool prepare_folder(const fs::path& folder, bool force) {
  if (!may_fill(folder, force)) return false;
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && access(folder.c_str(), W_OK) == 0) return true;
  fmt::print(stderr, "{}: cannot be written: {}; choose another --out\n", folder.string(),
             error ? error.message() : "no permission");
  return false;
}

int tell_report(const fs::path& folder, const std::vector<std::string>& missing) {
  for (const std::string& why : missing) fmt::print(stderr, "the report lacks a picture: {}\n", why);
  fmt::print("report: {}\n", (folder / "report.html").string());
  return missing.empty() ? kOk : kFailed;
}
