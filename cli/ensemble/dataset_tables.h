#pragma once
// The tables of a dataset: what was measured, and its covariance.
#include "cli/ensemble/dataset_file.h"

namespace scree {

/// Reads the observables of the experiments that `dataset` has; those without an uncertainty get 0.
/// `factors`: of the units of each row to the output's own.
void read_observables(const std::filesystem::path& file, Dataset& dataset, std::vector<double>& factors,
                      std::vector<ScenarioError>& errors);

/// Reads a covariance of all observables or of some; the others are independent. Sets the uncertainty of
/// those that have none. Errors: names that are not there, no square, asymmetric, not positive definite, a
/// diagonal that contradicts the uncertainty of a row.
void read_covariance(const std::filesystem::path& file, const std::vector<double>& factors, Dataset& dataset,
                     std::vector<ScenarioError>& errors);

/// Gives the default (relative to the value) to those still without an uncertainty, and fills the diagonal of
/// the covariance; an error that names them if there is no default. `file`: the observables', for messages.
void complete_uncertainties(const std::filesystem::path& file, const std::optional<double>& relative,
                            Dataset& dataset, std::vector<ScenarioError>& errors);

}  // namespace scree
