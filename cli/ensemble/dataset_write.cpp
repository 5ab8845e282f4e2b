#include "cli/ensemble/dataset_write.h"

#include <fmt/format.h>

#include <stdexcept>

#include "analysis/results/output_units.h"
#include "cli/ensemble/file_reader.h"
#include "cli/ensemble/scenario_patch.h"
#include "sim/io/text_file.h"
#include "sim/scene/yaml_tree.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

std::string covariance_table(const DatasetDraft::Covariance& covariance) {
  std::string table = fmt::format("name,{}\n", fmt::join(covariance.names, ","));
  for (std::size_t i = 0; i < covariance.names.size(); ++i) {
    table += covariance.names[i];
    for (std::size_t k = 0; k < covariance.names.size(); ++k)
      table += fmt::format(",{:.12g}",
                           covariance.matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
    table += '\n';
  }
  return table;
}

}  // namespace

std::vector<std::string> write_dataset(const DatasetDraft& draft, const fs::path& folder) {
  std::string table = "experiment,observable,value,unit,std,repeats\n";
  std::vector<std::string> left_out;
  int rows = 0;
  for (const DatasetDraft::Experiment& experiment : draft.experiments)
    for (const auto& [name, measured] : experiment.observables) {
      const bool scatters = measured.n > 1 && measured.std > 0;
      if (!scatters && !(draft.relative_uncertainty && measured.n == 1 && measured.mean != 0)) {
        left_out.push_back(experiment.name + "/" + name);
        continue;
      }
      const std::string unit = unit_of_output(name);
      table += fmt::format("{},{},{:.9g},{},{},{}\n", experiment.name, name, measured.mean,
                           unit.empty() ? "-" : unit, scatters ? fmt::format("{:.6g}", measured.std) : "",
                           measured.n);
      ++rows;
    }
  if (rows == 0)
    throw std::invalid_argument(
        "no observable scatters between the repeats: there is nothing to write a dataset of");
  std::string yaml =
      fmt::format("title: {}\nsource: {}\nexperiments:\n", yaml_text(draft.title), yaml_text(draft.source));
  for (const DatasetDraft::Experiment& experiment : draft.experiments) {
    yaml += fmt::format("  {}:\n    scenario: {}\n", yaml_text(experiment.name),
                        relative_yaml_text(experiment.scenario, folder));
    if (!experiment.overrides.empty()) yaml += "    set:\n";
    for (const std::string& text : experiment.overrides) {
      const auto at = text.find('=');
      yaml += fmt::format("      {}: {}\n", text.substr(0, at),
                          value_text(text.substr(at + 1), false, fs::current_path()));
    }
  }
  yaml += "observables: observables.csv\n";
  if (draft.covariance) {
    yaml += "covariance: covariance.csv\n";
    write_text_file(folder / "covariance.csv", covariance_table(*draft.covariance));
  }
  if (draft.relative_uncertainty)
    yaml += fmt::format("default_relative_uncertainty: {:g}\n", *draft.relative_uncertainty);
  write_text_file(folder / "observables.csv", table);
  write_text_file(folder / "dataset.yaml", yaml);
  return left_out;
}

}  // namespace scree
