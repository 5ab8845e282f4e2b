#pragma once
// What sweep, calibrate and predict share on the command line.
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/ensemble/ensemble.h"

/// The store named, or runs/store.sqlite; none, with a message, if it cannot be opened. `only_look`: it is
/// not made, and needs no right to write.
std::unique_ptr<scree::ResultsStore> open_store(const std::filesystem::path& named, bool only_look);

/// Brings the runs into the store, with progress on stderr. Ctrl-C ends it.
scree::EnsembleProgress run_with_progress(const std::vector<scree::RunRequest>& runs,
                                          scree::ResultsStore& store, const EnsembleOptions& options);

/// A decimal number and nothing else.
std::optional<double> number_of(const std::string& text);
