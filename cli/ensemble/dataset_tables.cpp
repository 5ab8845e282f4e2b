#include "cli/ensemble/dataset_tables.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "analysis/results/output_units.h"
#include "analysis/results/outputs.h"
#include "cli/ensemble/output_scope.h"
#include "sim/material/input_text.h"
#include "sim/scene/scenario_values.h"
#include "sim/scene/yaml_tree.h"

namespace scree {
namespace {

constexpr std::size_t kMostObservables = 2000;  // the covariance is dense
constexpr double kSameUncertainty = 0.01;       // relative; printed digits differ by this
constexpr double kSymmetric = 1e-6;             // of the geometric mean of the diagonal
constexpr double kLeastEigenvalue = 1e-10;      // of the correlations

class ObservableTable {
 public:
  ObservableTable(const std::filesystem::path& file, Dataset& dataset, std::vector<double>& factors,
                  std::vector<ScenarioError>& errors)
      : file_(file), table_(file), dataset_(dataset), factors_(factors), errors_(errors) {
    const std::vector<std::string> known{"experiment", "observable", "value",       "unit",
                                         "std",        "repeats",    "uncertainty", "source"};
    std::vector<std::string> others, missing;
    for (const char* name : {"experiment", "observable", "value"})
      if (!table_.column(name)) missing.emplace_back(name);
    if (!missing.empty())
      throw FileError(file_, table_.header_line(),
                      fmt::format("the header has no {}; found: {}", fmt::join(missing, ", "),
                                  shown(fmt::format("{}", fmt::join(table_.header(), ", ")))));
    for (const std::string& name : table_.header())
      if (!name.empty() && std::find(known.begin(), known.end(), in_small_letters(name)) == known.end())
        others.push_back(name);
    if (!others.empty())
      dataset_.notes.push_back(fmt::format("{}: columns that are not read: {}", file_.filename().string(),
                                           fmt::join(others, ", ")));
  }

  void read() {
    while (true) {
      try {
        if (!table_.next()) break;
        if (dataset_.observables.size() == kMostObservables)
          table_.fail(fmt::format("more than {} observables", kMostObservables));
        read_row();
      } catch (const FileError& error) {
        errors_.push_back({error.file, error.line, 0, error.message});
        if (errors_.size() > 50) break;
      }
    }
    if (dataset_.observables.empty() && errors_.empty())
      throw FileError(file_, 0, "there is a header and nothing measured below it");
    if (!lone_.empty())
      dataset_.notes.push_back(
          fmt::format("std stands for the uncertainty of {}: one repeat, or their number is not given",
                      fmt::join(lone_, ", ")));
  }

 private:
  std::string text(const char* column) const {
    const auto at = table_.column(column);
    return at ? table_.field(*at) : std::string();
  }
  std::optional<double> number(const char* column) const {
    const auto at = table_.column(column);
    return at ? table_.number(*at) : std::nullopt;
  }

  void read_row() {
    const std::string experiment = text("experiment"), output = text("observable");
    if (experiment.empty()) table_.fail("experiment is empty");
    if (output.empty()) table_.fail("observable is empty");
    const auto& all = dataset_.experiments;
    const auto of = std::find_if(all.begin(), all.end(), [&](const auto& e) { return e.name == experiment; });
    if (of == all.end()) {
      std::vector<std::string> names;
      for (const auto& each : all) names.push_back(each.name);
      table_.fail(fmt::format("no experiment {}{}; there are {}", shown(experiment),
                              suggestion(experiment, names), join(names)));
    }
    const std::string label = experiment + "/" + output;
    if (const std::string why = why_not_measured(of->scenario, output); !why.empty())
      table_.fail(fmt::format("{}: {}", label, why));
    const auto [first, fresh] = lines_.emplace(label, table_.line());
    if (!fresh) table_.fail(fmt::format("{} stands already in line {}", label, first->second));

    const std::string own = unit_of_output(output), unit = text("unit");
    const auto factor = unit_factor(unit, own);
    if (!factor)
      table_.fail(
          fmt::format("{}: unit {} does not fit; allowed: {}", label, shown(unit), join(units_for(own))));
    Dataset::Observable row;
    row.experiment = static_cast<std::size_t>(of - all.begin());
    row.output = output;
    row.line = table_.line();
    const auto value = number("value");
    if (!value) table_.fail(label + ": value is empty");
    row.value = *value * *factor;
    if (const auto repeats = number("repeats")) {
      if (!(*repeats >= 1 && *repeats <= 1e6 && *repeats == std::floor(*repeats)))
        table_.fail(
            fmt::format("{}: repeats must be an integer from 1 on, found {}", label, text("repeats")));
      row.repeats = static_cast<int>(*repeats);
    }
    if (const auto std = number("std")) {
      if (*std < 0) table_.fail(fmt::format("{}: std must not be below 0, found {}", label, text("std")));
      row.std = *std * *factor;
    }
    const auto uncertainty = number("uncertainty");
    if (uncertainty && !(*uncertainty > 0))
      table_.fail(fmt::format("{}: uncertainty must be above 0, found {}", label, text("uncertainty")));
    if (uncertainty) {
      row.uncertainty = *uncertainty * *factor;
    } else if (row.std) {
      if (!(*row.std > 0))
        table_.fail(label + ": std is 0, which makes the value exact: give an uncertainty above 0");
      row.uncertainty = *row.std / std::sqrt(row.repeats.value_or(1));
      if (row.repeats.value_or(1) == 1) lone_.push_back(label);
    }
    dataset_.observables.push_back(std::move(row));
    factors_.push_back(*factor);
  }

  const std::filesystem::path& file_;
  DelimitedTable table_;
  Dataset& dataset_;
  std::vector<double>& factors_;
  std::vector<ScenarioError>& errors_;
  std::map<std::string, int> lines_;  // label -> where it stands
  std::vector<std::string> lone_;     // labels of those with std and one repeat
};

// The named square matrix of a file, with the row of each observable in it.
struct NamedMatrix {
  std::vector<std::size_t> observable;  // of each row
  Eigen::MatrixXd values;
};

NamedMatrix read_matrix(const std::filesystem::path& file, const Dataset& dataset) {
  DelimitedTable table(file);
  std::map<std::string, std::size_t> known;
  for (std::size_t k = 0; k < dataset.observables.size(); ++k)
    known[dataset.label(dataset.observables[k])] = k;
  const std::vector<std::string> names(table.header().begin() + 1, table.header().end());
  const auto n = static_cast<Eigen::Index>(names.size());
  if (n == 0) throw FileError(file, table.header_line(), "no columns: name, experiment/observable, ...");
  NamedMatrix matrix{std::vector<std::size_t>(names.size()), Eigen::MatrixXd::Zero(n, n)};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto at = known.find(names[k]);
    if (at == known.end())
      throw FileError(file, table.header_line(),
                      fmt::format("no observable {} is measured", shown(names[k])));
    matrix.observable[k] = at->second;
  }
  std::vector<bool> seen(names.size(), false);
  while (table.next()) {
    const auto at = std::find(names.begin(), names.end(), table.field(0)) - names.begin();
    if (at == n) table.fail(fmt::format("row {} is not among the columns", shown(table.field(0))));
    if (seen[static_cast<std::size_t>(at)])
      table.fail(fmt::format("row {} stands twice", shown(table.field(0))));
    seen[static_cast<std::size_t>(at)] = true;
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto value = table.number(static_cast<std::size_t>(j) + 1);
      if (!value)
        table.fail(fmt::format("{} x {} is empty", table.field(0), names[static_cast<std::size_t>(j)]));
      matrix.values(at, j) = *value;
    }
  }
  for (std::size_t k = 0; k < names.size(); ++k)
    if (!seen[k]) throw FileError(file, 0, fmt::format("is not square: row {} is missing", shown(names[k])));
  return matrix;
}

// Throws unless a covariance is one.
void check_covariance(const std::filesystem::path& file, const Eigen::MatrixXd& c,
                      const std::function<std::string(Eigen::Index)>& name) {
  for (Eigen::Index i = 0; i < c.rows(); ++i)
    if (!(c(i, i) > 0))
      throw FileError(file, 0, fmt::format("the variance of {} is {}; it must be above 0", name(i), c(i, i)));
  Eigen::MatrixXd correlation = c;
  for (Eigen::Index i = 0; i < c.rows(); ++i)
    for (Eigen::Index j = 0; j < c.rows(); ++j) {
      const double scale = std::sqrt(c(i, i)) * std::sqrt(c(j, j));
      if (std::abs(c(i, j) - c(j, i)) > kSymmetric * scale)
        throw FileError(file, 0,
                        fmt::format("is not symmetric: {} x {} is {}, the other way round {}", name(i),
                                    name(j), c(i, j), c(j, i)));
      correlation(i, j) = 0.5 * (c(i, j) + c(j, i)) / scale;
    }
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(correlation, Eigen::EigenvaluesOnly)
                           .eigenvalues()
                           .minCoeff();
  if (!(least > kLeastEigenvalue))
    throw FileError(
        file, 0,
        fmt::format("is not positive definite: the least eigenvalue of its correlations is {:.3g}; no "
                    "set of measurements has this covariance",
                    least));
}

}  // namespace

void read_observables(const std::filesystem::path& file, Dataset& dataset, std::vector<double>& factors,
                      std::vector<ScenarioError>& errors) {
  try {
    ObservableTable(file, dataset, factors, errors).read();
  } catch (const FileError& error) {
    errors.push_back({error.file, error.line, 0, error.message});
  }
}

void read_covariance(const std::filesystem::path& file, const std::vector<double>& factors, Dataset& dataset,
                     std::vector<ScenarioError>& errors) {
  const auto n = static_cast<Eigen::Index>(dataset.observables.size());
  dataset.covariance = Eigen::MatrixXd::Zero(n, n);
  try {
    const NamedMatrix matrix = read_matrix(file, dataset);
    check_covariance(file, matrix.values, [&](Eigen::Index k) {
      return dataset.label(dataset.observables[matrix.observable[static_cast<std::size_t>(k)]]);
    });
    for (std::size_t i = 0; i < matrix.observable.size(); ++i) {
      const std::size_t a = matrix.observable[i];
      for (std::size_t j = 0; j < matrix.observable.size(); ++j) {
        const std::size_t b = matrix.observable[j];
        const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
        dataset.covariance(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
            0.5 * (matrix.values(row, column) + matrix.values(column, row)) * factors[a] * factors[b];
      }
      const double own =
          std::sqrt(dataset.covariance(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(a)));
      Dataset::Observable& observable = dataset.observables[a];
      if (observable.uncertainty > 0 && std::abs(own / observable.uncertainty - 1) > kSameUncertainty)
        throw FileError(
            file, 0,
            fmt::format("the variance of {} makes its uncertainty {:.4g}, its row says {:.4g} (in {})",
                        dataset.label(observable), own, observable.uncertainty,
                        unit_of_output(observable.output).empty() ? "its own unit"
                                                                  : unit_of_output(observable.output)));
      observable.uncertainty = own;
    }
  } catch (const FileError& error) {
    errors.push_back({error.file, error.line, 0, error.message});
  }
}

void complete_uncertainties(const std::filesystem::path& file, const std::optional<double>& relative,
                            Dataset& dataset, std::vector<ScenarioError>& errors) {
  std::vector<const Dataset::Observable*> without;
  int assumed = 0;
  for (Dataset::Observable& observable : dataset.observables) {
    if (observable.uncertainty > 0) continue;
    if (relative && observable.value == 0)
      errors.push_back(
          {file.string(), observable.line, 0,
           dataset.label(observable) +
               ": the value is 0, so that a relative uncertainty says nothing: give `uncertainty`"});
    if (relative)
      observable.uncertainty = *relative * std::abs(observable.value), ++assumed;
    else
      without.push_back(&observable);
  }
  if (!without.empty())
    errors.push_back(
        {file.string(), without.front()->line, 0,
         fmt::format("{}{}: no uncertainty. Give `uncertainty`, or `std` and `repeats`, or state "
                     "default_relative_uncertainty in the dataset",
                     dataset.label(*without.front()),
                     without.size() > 1 ? fmt::format(" and {} other rows", without.size() - 1) : "")});
  if (assumed > 0)
    dataset.notes.push_back(
        fmt::format("{} of {} uncertainties are assumed: {:g} % of the value (default_relative_uncertainty)",
                    assumed, dataset.observables.size(), 100 * *relative));
  const auto n = static_cast<Eigen::Index>(dataset.observables.size());
  if (dataset.covariance.rows() != n) dataset.covariance = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index k = 0; k < n; ++k)
    dataset.covariance(k, k) = std::pow(dataset.observables[static_cast<std::size_t>(k)].uncertainty, 2);
}

}  // namespace scree
