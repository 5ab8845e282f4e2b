#pragma once
// Simulations through a store, for commands that decide as they go.
#include "cli/commands.h"
#include "cli/ensemble/diagnosis_session.h"
#include "sim/io/results_store.h"

/// Does what the store does not have, with progress on stderr under words that say what it is for; throws
/// scree::Stopped on Ctrl-C.
scree::RunThrough run_through(scree::ResultsStore& store, const EnsembleOptions& options);
