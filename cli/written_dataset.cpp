#include "cli/written_dataset.h"

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/ensemble/dataset_file.h"

int end_with_dataset(const std::filesystem::path& folder, const std::vector<std::string>& left_out) {
  if (!left_out.empty())
    fmt::print("note: not in the dataset, as nothing is known of their scatter: {}\n",
               fmt::join(left_out, ", "));
  const std::filesystem::path file = folder / "dataset.yaml";
  const scree::DatasetResult written = scree::load_dataset(file, asset_dir());
  for (const scree::ScenarioError& error : written.errors) fmt::print(stderr, "{}\n", error.text());
  if (!written.errors.empty()) return kBadInput;
  fmt::print("dataset: {} ({} observables)\n", file.string(), written.dataset.observables.size());
  return kOk;
}
