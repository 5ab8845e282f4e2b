#include "cli/written_dataset.h"

#include <fmt/format.h>

#include <stdexcept>

#include "cli/commands.h"
#include "cli/ensemble/dataset_file.h"
#include "sim/io/scratch_folder.h"

namespace fs = std::filesystem;

WrittenDataset::WrittenDataset(fs::path folder, Write write)
    : folder_(std::move(folder)), write_(std::move(write)) {}

int WrittenDataset::check() {
  const scree::ScratchFolder trial;
  try {
    write_(trial.path());
  } catch (const std::invalid_argument& refused) {
    fmt::print(stderr, "{}\n", refused.what());
    return kBadInput;
  }
  const scree::DatasetResult dataset = scree::load_dataset(trial.path() / "dataset.yaml", asset_dir());
  for (const scree::ScenarioError& wrong : dataset.errors) {
    std::string text = wrong.text();
    if (const std::string there = trial.path().string(); text.starts_with(there + "/"))
      text = (folder_ / text.substr(there.size() + 1)).string();
    fmt::print(stderr, "{}\n", text);
  }
  observables_ = dataset.dataset.observables.size();
  return dataset.errors.empty() ? kOk : kBadInput;
}

void WrittenDataset::put_in_place() const {
  fs::create_directories(folder_);
  fs::remove(folder_ / "covariance.csv");  // of an older one; not every dataset has it
  for (const std::string& note : write_(folder_)) fmt::print("note: {}\n", note);
  fmt::print("dataset: {} ({} observables)\n", (folder_ / "dataset.yaml").string(), observables_);
}

std::vector<std::string> note_of_left_out(const std::vector<std::string>& names) {
  if (names.empty()) return {};
  return {
      fmt::format("not in the dataset, as nothing is known of their scatter: {}", fmt::join(names, ", "))};
}
