#pragma once
// The end of every command that writes a dataset.
#include <filesystem>
#include <string>
#include <vector>

/// Says what was left out (as scree::write_dataset returns it), reads the dataset again, so that a user gets
/// what diagnose would get, and says what it holds. kOk, or kBadInput with its errors on stderr.
int end_with_dataset(const std::filesystem::path& folder, const std::vector<std::string>& left_out = {});
