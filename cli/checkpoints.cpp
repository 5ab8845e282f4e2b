#include "cli/checkpoints.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kKept = 2;
constexpr const char kFinished[] = "finished";

// By number, rising.
std::vector<std::pair<int, fs::path>> checkpoints_in(const fs::path& folder) {
  std::vector<std::pair<int, fs::path>> found;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(scree::kCheckpointName) || name.ends_with(".part")) continue;
    const std::string digits = name.substr(scree::kCheckpointName.size());
    if (digits.empty() || digits.size() > 9 || digits.find_first_not_of("0123456789") != std::string::npos)
      continue;
    found.emplace_back(std::stoi(digits), entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

// Throws StateError with what to do where a file is not of the program, scenario and seed that are wanted.
void check(const fs::path& file, const scree::CheckpointHeader& found, const scree::CheckpointHeader& wanted,
           std::string_view if_program, std::string_view if_scenario) {
  if (found.program != wanted.program)
    throw scree::StateError(fmt::format("{}: made by {}, this is {}: the numbers may differ{}", file.string(),
                                        found.program, wanted.program, if_program));
  if (found.scenario != wanted.scenario || found.seed != wanted.seed)
    throw scree::StateError(fmt::format("{}: {}", file.string(), if_scenario));
}

}  // namespace

Checkpoints::Checkpoints(fs::path folder, scree::CheckpointHeader header, double minutes)
    : folder_(std::move(folder)), header_(std::move(header)), minutes_(minutes) {}

std::unique_ptr<scree::CheckpointReader> Checkpoints::open(
    const fs::path& file, const std::function<void(const std::string&)>& warn) const {
  std::unique_ptr<scree::CheckpointReader> reader;
  try {
    reader = std::make_unique<scree::CheckpointReader>(file);
  } catch (const scree::DamagedCheckpoint& damage) {
    warn(damage.what());
    return nullptr;
  }
  check(file, reader->header(), header_,
        ". Resume with that program, or start anew from scenario.yaml with another --out",
        "made of another scenario or seed. Start anew with another --out");
  return reader;
}

std::unique_ptr<scree::CheckpointReader> Checkpoints::newest(
    const std::function<void(const std::string&)>& warn) const {
  const auto found = checkpoints_in(folder_);
  std::string unreadable;
  for (auto one = found.rbegin(); one != found.rend(); ++one) {
    try {
      if (auto reader = open(one->second, warn)) return reader;
    } catch (const scree::UnreadableCheckpoint& error) {  // may be good: it stays
      if (unreadable.empty()) unreadable = error.what();
      warn(error.what());
      continue;
    }
    std::error_code ignored;
    fs::remove(one->second, ignored);  // it must not be one of the two that are kept
  }
  if (!unreadable.empty())
    throw scree::UnreadableCheckpoint(unreadable + "; mend that, or delete it to begin at the beginning");
  return nullptr;
}

std::unique_ptr<scree::CheckpointReader> Checkpoints::finished(
    const std::function<void(const std::string&)>& warn) const {
  const fs::path file = folder_ / kFinished;
  std::error_code none;
  return fs::exists(file, none) ? open(file, warn) : nullptr;
}

bool Checkpoints::due() const {
  return on() && std::chrono::steady_clock::now() - last_ >= std::chrono::duration<double>(60 * minutes_);
}

void Checkpoints::save(double time, const std::function<void(scree::StateWriter&)>& state) {
  last_ = std::chrono::steady_clock::now();  // also of one that fails: the next try is not at once
  fs::create_directories(folder_);
  auto found = checkpoints_in(folder_);
  const int number = found.empty() ? 1 : found.back().first + 1;
  header_.time = time;
  const fs::path file = folder_ / fmt::format("{}{:06}", scree::kCheckpointName, number);
  scree::write_checkpoint(file, header_, state);
  found.emplace_back(number, file);
  std::error_code ignored;
  for (std::size_t k = 0; k + kKept < found.size(); ++k) fs::remove(found[k].second, ignored);
  last_ = std::chrono::steady_clock::now();
}

void Checkpoints::finish(double time, const std::function<void(scree::StateWriter&)>& outcome) {
  fs::create_directories(folder_);
  header_.time = time;
  scree::write_checkpoint(folder_ / kFinished, header_, outcome);
  std::error_code ignored;
  for (const auto& [number, file] : checkpoints_in(folder_)) fs::remove(file, ignored);
}

void Checkpoints::keep_pile(const std::string& pile, double time,
                            const std::function<void(scree::StateWriter&)>& outcome) const {
  fs::create_directories(folder_);
  scree::write_checkpoint(folder_ / scree::kPileName, {header_.program, pile, header_.seed, time}, outcome);
}

std::unique_ptr<scree::CheckpointReader> Checkpoints::pile(const std::string& pile) const {
  const fs::path file = folder_ / scree::kPileName;
  std::error_code none;
  if (!fs::exists(file, none))
    throw scree::StateError(
        fmt::format("{}: no such pile; scree run --keep-pile leaves one of each seed", file.string()));
  try {
    auto reader = std::make_unique<scree::CheckpointReader>(file);
    check(file, reader->header(), {header_.program, pile, header_.seed, 0}, "",
          "a pile of another scenario or seed; only effects on measurement may differ");
    return reader;
  } catch (const scree::DamagedCheckpoint& damage) {
    throw scree::StateError(damage.what());
  }
}

void Checkpoints::remove_pile_from(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / scree::kPileName, ignored);
}

void Checkpoints::remove_from(const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / kFinished, ignored);
  for (const auto& [number, file] : checkpoints_in(folder)) fs::remove(file, ignored);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))  // of one that was killed
    if (const std::string name = entry.path().filename().string();
        (name.starts_with(scree::kCheckpointName) || name.starts_with(kFinished) ||
         name.starts_with(scree::kPileName)) &&
        name.ends_with(".part"))
      fs::remove(entry.path(), ignored);
  fs::remove(folder, ignored);  // if that was all
}
