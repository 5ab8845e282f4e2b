#include "cli/ensemble/field_dataset.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "cli/ensemble/dataset_write.h"

namespace scree {
namespace {

/// One observable: its name, and its value in each picture.
struct Column {
  std::string name;
  std::vector<double> values;
  MeanStd moments;
};

/// chi of S2 -> chi_S2, d50_m of S2 -> d50_m_S2: names of outputs carry their unit.
std::vector<Column> columns_of(const FieldAnalysis& field, const FieldDatasetRequest& request) {
  std::vector<Column> columns;
  const std::vector<std::string> wanted =
      request.observables.empty() ? std::vector<std::string>{"chi"} : request.observables;
  for (const std::string& name : wanted) {
    const bool metres = name.ends_with("_m");
    const std::string quantity = metres ? name.substr(0, name.size() - 2) : name;
    const FieldQuantity* known = field_quantity(quantity);
    if (known == nullptr || metres != (std::string_view(known->unit) == "m"))
      throw std::invalid_argument(
          fmt::format("--observables {}: pictures give chi, d10_m ... d95_m, d10_rel ... d95_rel", name));
    for (const FieldSection& section : field.sections) {
      Column column{
          fmt::format("{}_{}{}", name, section.name, request.sections.of), section.values.at(quantity), {}};
      column.moments = mean_std(column.values);
      if (column.moments.n > 1 && column.moments.std > 0) columns.push_back(std::move(column));
    }
  }
  return columns;
}

/// Correlations over the pictures that have every column; none with fewer of them than would make it regular.
std::optional<Eigen::MatrixXd> correlations(const std::vector<Column>& columns, std::size_t pictures) {
  const auto p = static_cast<Eigen::Index>(columns.size());
  std::vector<Eigen::VectorXd> complete;
  for (std::size_t i = 0; i < pictures; ++i) {
    Eigen::VectorXd row(p);
    for (Eigen::Index k = 0; k < p; ++k) row[k] = columns[static_cast<std::size_t>(k)].values[i];
    if (row.allFinite()) complete.push_back(row);
  }
  const auto n = static_cast<Eigen::Index>(complete.size());
  if (n <= p + 1) return std::nullopt;
  Eigen::MatrixXd off(n, p);
  for (Eigen::Index i = 0; i < n; ++i) off.row(i) = complete[static_cast<std::size_t>(i)];
  off.rowwise() -= off.colwise().mean().eval();
  off.array().rowwise() /= off.colwise().norm().array().eval();
  return off.transpose() * off;
}

}  // namespace

std::vector<std::string> write_field_dataset(const FieldAnalysis& field, const FieldDatasetRequest& request,
                                             const std::filesystem::path& folder) {
  const std::vector<Column> columns = columns_of(field, request);
  std::vector<std::string> notes;
  DatasetDraft draft;
  draft.title = fmt::format("Slope in {} pictures", field.pictures.size());
  draft.source = "scree field " + request.source;
  DatasetDraft::Experiment experiment{"slope", request.scenario, request.sections.overrides, {}};
  for (const Column& column : columns) experiment.observables[column.name] = column.moments;
  draft.experiments.push_back(std::move(experiment));
  if (const auto correlation = correlations(columns, field.pictures.size())) {
    DatasetDraft::Covariance covariance;
    Eigen::VectorXd error(correlation->rows());
    for (std::size_t k = 0; k < columns.size(); ++k) {
      covariance.names.push_back("slope/" + columns[k].name);
      error[static_cast<Eigen::Index>(k)] = columns[k].moments.std / std::sqrt(columns[k].moments.n);
    }
    covariance.matrix = error.asDiagonal() * *correlation * error.asDiagonal();
    draft.covariance = std::move(covariance);
  } else {
    notes.push_back(fmt::format(
        "no covariance in the dataset: {} observables need more than {} pictures that have all of them",
        columns.size(), columns.size() + 1));
  }
  for (const std::string& name : write_dataset(draft, folder))
    notes.push_back(fmt::format("not in the dataset, as it does not scatter: {}", name));
  return notes;
}

}  // namespace scree
