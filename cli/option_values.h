#pragma once
// Values of options: what they may be, and what is said when they are something else.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/ensemble/file_kind.h"

namespace scree {
struct ScenarioError;
}

/// A number from low to high. CLI::Range lets nan pass.
CLI::Validator within(double low, double high);

/// A whole number from low to high, in decimal digits. CLI::Range reads 010 as 8 and 0x2 as 2.
CLI::Validator whole(std::int64_t low, std::int64_t high);

/// Something, and no option: CLI11 takes `--out= --force` for a folder named --force.
CLI::Validator given();

/// Threads or jobs: as many as are asked for, or as the machine has cores where 0 are.
int cores_or(int asked);

/// Metres of "0.5m", "50cm"; none, with a message that begins with the option's name, if it is no length.
std::optional<double> length_in(const std::string& option, const std::string& text);
/// Metres a pixel of "1.2cm/px".
std::optional<double> scale_in(const std::string& option, const std::string& text);
/// Two numbers, "135,45" or "1600x1200".
std::optional<std::pair<double, double>> pair_in(const std::string& option, const std::string& text,
                                                 char separator);

/// False, with a message, if the file is one of another kind.
bool is_of_kind(const std::filesystem::path& file, scree::FileKind wanted);

/// False, with a line each, if a file that was read has errors; its warnings get a line each before.
bool nothing_wrong(const std::vector<scree::ScenarioError>& errors,
                   const std::vector<std::string>& warnings = {});

/// True, with a message, if two of these names are one file that is there.
bool given_twice(const std::vector<std::filesystem::path>& files);
