#include "cli/written_dataset.h"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>

#include "cli/commands.h"
#include "cli/ensemble/dataset_file.h"

namespace fs = std::filesystem;

namespace {

struct TemporaryFolder {
  fs::path path = fs::temp_directory_path() / fmt::format("scree_dataset_{}", getpid());
  TemporaryFolder() { fs::create_directories(path); }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

}  // namespace

WrittenDataset::WrittenDataset(fs::path folder, Write write)
    : folder_(std::move(folder)), write_(std::move(write)) {}

int WrittenDataset::check() const {
  const TemporaryFolder trial;
  try {
    write_(trial.path);
  } catch (const std::invalid_argument& refused) {
    fmt::print(stderr, "{}\n", refused.what());
    return kBadInput;
  }
  const scree::DatasetResult dataset = scree::load_dataset(trial.path / "dataset.yaml", asset_dir());
  for (const scree::ScenarioError& wrong : dataset.errors) {
    std::string text = wrong.text();
    if (const std::string there = trial.path.string(); text.starts_with(there + "/"))
      text = (folder_ / text.substr(there.size() + 1)).string();
    fmt::print(stderr, "{}\n", text);
  }
  return dataset.errors.empty() ? kOk : kBadInput;
}

void WrittenDataset::put_in_place() const {
  fs::create_directories(folder_);
  const fs::path file = folder_ / "dataset.yaml", covariance = folder_ / "covariance.csv";
  fs::remove(covariance);  // of an older one; not every dataset has it
  for (const std::string& note : write_(folder_)) fmt::print("note: {}\n", note);
  const scree::DatasetResult dataset = scree::load_dataset(file, asset_dir());
  fmt::print("dataset: {} ({} observables)\n", file.string(), dataset.dataset.observables.size());
}

std::vector<std::string> note_of_left_out(const std::vector<std::string>& names) {
  if (names.empty()) return {};
  return {
      fmt::format("not in the dataset, as nothing is known of their scatter: {}", fmt::join(names, ", "))};
}
