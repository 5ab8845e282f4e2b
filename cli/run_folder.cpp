#include "cli/run_folder.h"

#define XXH_INLINE_ALL
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#include <xxhash.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "cli/commands.h"
#include "cli/ensemble/run_request.h"
#include "scree_version.h"
#include "sim/io/text_file.h"

namespace fs = std::filesystem;

namespace {

fs::path record_in(const fs::path& folder) {
  return folder / "resume.json";
}

}  // namespace

std::string program_version() {
  return fmt::format("scree {} ({})", scree::results_version(), SCREE_REVISION);
}

std::string scenario_hash(const scree::Scenario& scenario) {
  const std::string key = scree::run_request(scenario, 0, scree::results_version(), asset_dir()).key;
  const std::string text = key + "\n" + scenario.resolved_yaml;
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string pile_hash(const scree::Scenario& scenario) {
  return scree::run_request(scenario, 0, scree::results_version(), asset_dir()).pile;
}

void write_record(const fs::path& folder, const RunRecord& r) {
  const nlohmann::ordered_json json = {{"program", r.program},
                                       {"scenario", r.scenario},
                                       {"name", r.name},
                                       {"seeds", r.seeds},
                                       {"summary_only", r.summary_only},
                                       {"checkpoint_minutes", r.checkpoint_minutes},
                                       {"keep_pile", r.keep_pile}};
  scree::write_text_file(record_in(folder), json.dump(2) + "\n");
}

RunRecord read_record(const fs::path& folder) {
  std::ifstream in(record_in(folder));
  if (!in) {
    if (fs::exists(folder / "summary.json"))
      throw std::runtime_error(
          fmt::format("{}: this run has come to its end; there is nothing to resume", folder.string()));
    throw std::runtime_error(
        fmt::format("{}: no run that can be resumed (it has no resume.json)", folder.string()));
  }
  try {
    const nlohmann::json json = nlohmann::json::parse(in);
    RunRecord record{json.at("program"),
                     json.at("scenario"),
                     json.at("name"),
                     {},
                     json.at("summary_only"),
                     json.at("checkpoint_minutes"),
                     json.value("keep_pile", false)};
    for (const nlohmann::json& seed : json.at("seeds")) {
      if (!seed.is_number_unsigned()) throw std::invalid_argument("no seed");
      record.seeds.push_back(seed);
    }
    const std::set<std::uint64_t> different(record.seeds.begin(), record.seeds.end());
    if (different.empty() || different.size() != record.seeds.size() || !(record.checkpoint_minutes >= 0))
      throw std::invalid_argument("no seeds of a run");
    return record;
  } catch (const std::exception&) {
    throw std::runtime_error(fmt::format("{}: damaged; start anew from scenario.yaml with another --out",
                                         record_in(folder).string()));
  }
}

void remove_record(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(record_in(folder), ignored);
}

FolderLock::FolderLock(const fs::path& folder, double patience)
    : file_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
  while (file_ >= 0 && flock(file_, LOCK_EX | LOCK_NB) != 0) {
    const bool taken = errno == EWOULDBLOCK;
    if (taken && std::chrono::steady_clock::now() < until) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      continue;
    }
    close(file_);
    file_ = -1;  // a file system without locks has none
    if (taken) throw std::runtime_error(fmt::format("{}: another scree works in it", folder.string()));
  }
}

FolderLock::~FolderLock() {
  if (file_ >= 0) close(file_);
}
