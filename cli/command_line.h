#pragma once
// The words of the command line: every subcommand with its options, their help and examples.
#include <CLI/CLI.hpp>
#include <functional>
#include <vector>

struct Command {
  CLI::App* app;
  std::function<int()> run;  ///< with the options that were parsed; returns the exit code
  bool reads_assets = true;
};

/// Adds all subcommands; help lists them in this order.
std::vector<Command> add_commands(CLI::App& all);
