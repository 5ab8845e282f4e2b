#include "cli/written_dataset.h"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>

#include "cli/commands.h"
#include "cli/ensemble/dataset_file.h"

namespace fs = std::filesystem;

namespace {
constexpr const char* kFiles[] = {"dataset.yaml", "observables.csv", "covariance.csv"};
}

WrittenDataset::WrittenDataset(fs::path out, fs::path folder) : folder_(std::move(folder)) {
  if (!out.has_filename()) out = out.parent_path();
  // As deep as `out`: paths in the dataset are relative to it.
  beside_ = fmt::format("{}.{}.part", out.string(), getpid());
  written_ = (beside_ / folder_.lexically_relative(out)).lexically_normal();
}

WrittenDataset::~WrittenDataset() {
  std::error_code ignored;
  fs::remove_all(beside_, ignored);
}

int WrittenDataset::write(const std::function<std::vector<std::string>(const fs::path&)>& write) {
  std::error_code error;
  if (fs::create_directories(written_, error); error) {
    fmt::print(stderr, "{}: cannot be written: {}; choose another --out\n", folder_.string(),
               error.message());
    return kBadInput;
  }
  try {
    notes_ = write(written_);
  } catch (const std::invalid_argument& refused) {
    fmt::print(stderr, "{}\n", refused.what());
    return kBadInput;
  }
  const scree::DatasetResult dataset = scree::load_dataset(written_ / "dataset.yaml", asset_dir());
  for (const scree::ScenarioError& wrong : dataset.errors) {
    std::string text = wrong.text();
    if (text.starts_with(written_.string())) text.replace(0, written_.string().size(), folder_.string());
    fmt::print(stderr, "{}\n", text);
  }
  observables_ = dataset.dataset.observables.size();
  return dataset.errors.empty() ? kOk : kBadInput;
}

void WrittenDataset::put_in_place() {
  fs::create_directories(folder_);
  for (const char* file : kFiles) {
    fs::remove(folder_ / file);
    if (fs::exists(written_ / file)) fs::rename(written_ / file, folder_ / file);
  }
  for (const std::string& note : notes_) fmt::print("note: {}\n", note);
  fmt::print("dataset: {} ({} observables)\n", (folder_ / "dataset.yaml").string(), observables_);
}

std::vector<std::string> note_of_left_out(const std::vector<std::string>& names) {
  if (names.empty()) return {};
  return {
      fmt::format("not in the dataset, as nothing is known of their scatter: {}", fmt::join(names, ", "))};
}
