#pragma once
// What commands that run ensembles share on the command line.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/ensemble/ensemble.h"

/// What a store is opened for. To look at one needs no right to write and makes none. What is to come (plan)
/// is that of an empty store where there is none; what is there (list), where none was named.
enum class StoreUse { change, look, list, plan };

/// The file named, or runs/store.sqlite.
std::filesystem::path store_file(const std::filesystem::path& named);

/// The store named, or runs/store.sqlite; none, with a message, if it cannot be opened.
std::unique_ptr<scree::ResultsStore> open_store(const std::filesystem::path& named, StoreUse use);

/// Brings the runs into the store, with progress on stderr; where there is something to do, `what` it is for
/// stands above it. Ctrl-C ends it.
scree::EnsembleProgress run_with_progress(const std::vector<scree::RunRequest>& runs,
                                          scree::ResultsStore& store, const EnsembleOptions& options,
                                          const std::string& what = {});

/// The same, and what came of each: done or failed. Nothing if Ctrl-C ended it.
std::optional<std::vector<scree::StoredResult>> ended_runs(const std::vector<scree::RunRequest>& runs,
                                                           scree::ResultsStore& store,
                                                           EnsembleOptions options, std::string what = {});

/// A decimal number and nothing else.
std::optional<double> number_of(const std::string& text);
