#pragma once
// The folder a command writes into.
#include <filesystem>
#include <string>
#include <vector>

/// runs/NAME, or the first of runs/NAME-2, ... that is not there.
std::filesystem::path free_run_folder(const std::string& name);

/// Whether the folder is not there or empty, or may be written into all the same, and could be made; a
/// message if not. What is refused here is not refused after hours of work.
bool may_fill(const std::filesystem::path& folder, bool force);

/// Whether the name is one that messages and other programs can repeat; a message if not.
bool well_named(const std::filesystem::path& file);

/// Whether the folder of a file is there, the file is no folder, and it may be written; a message if not.
bool may_write(const std::filesystem::path& file);

/// The same, and that it is none of those that the command itself works with.
bool may_replace(const std::filesystem::path& file, const std::vector<std::filesystem::path>& in_use);

/// Makes the folder. False, with a message, if it holds something (unless forced) or cannot be written.
bool prepare_folder(const std::filesystem::path& folder, bool force);

/// Says which pictures the folder's report lacks, in gnuplot's words, and where it lies: kOk, or kFailed if
/// it lacks one.
int tell_report(const std::filesystem::path& folder, const std::vector<std::string>& missing);
