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

namespace {

// Why a file cannot be written; empty: it can.
std::string why_not_written(const fs::path& file) {
  std::error_code none;
  fs::path place = fs::absolute(file, none);
  for (int links = 0;; ++links) {
    // /dev/stdout and its like name what a shell has opened, by the process.
    if (fs::weakly_canonical(place.parent_path(), none).string().starts_with("/proc/"))
      return "it is there and no file";
    if (!fs::is_symlink(place, none)) break;
    if (links == 40) return "its links lead in a circle";
    place = place.parent_path() / fs::read_symlink(place, none);
  }
  const fs::path folder = place.parent_path();
  const bool is_there = fs::exists(place, none);
  if (fs::is_directory(place, none)) return "it is a folder";
  if (is_there && !fs::is_regular_file(place, none)) return "it is there and no file";
  if (!fs::is_directory(folder, none)) return "its folder is not there";
  if (access((is_there ? place : folder).c_str(), W_OK) != 0) return "no permission";
  return {};
}

}  // namespace

bool well_named(const fs::path& file) {
  const std::string name = file.string();
  if (std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < 0x20; })) return true;
  fmt::print(stderr, "{}: cannot be written: its name has a control character\n", scree::one_line(name));
  return false;
}

bool may_write(const fs::path& file) {
  if (!well_named(file)) return false;
  const std::string why = why_not_written(file);
  if (why.empty()) return true;
  fmt::print(stderr, "{}: cannot be written: {}\n", file.string(), why);
  return false;
}

bool may_replace(const fs::path& file, const std::vector<fs::path>& in_use) {
  if (!may_write(file)) return false;
  std::error_code none;
  const auto place = [&](const fs::path& of) { return fs::weakly_canonical(fs::absolute(of), none); };
  const auto same = [&](const fs::path& other) {
    return !other.empty() &&
           (fs::equivalent(file, other, none) || (!place(other).empty() && place(file) == place(other)));
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
