#pragma once
// A field analysis as a page.
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/field/field_analysis.h"
#include "analysis/field/printed_values.h"

namespace scree {

/// Writes tables, pictures and report.html into a folder that is there. `title` in plain text. Gives
/// gnuplot's words on the pictures that it refused. Throws std::runtime_error when gnuplot is missing or a
/// file cannot be written.
std::vector<std::string> write_field_report(const std::string& title, const FieldAnalysis& field,
                                            const std::vector<HeldValue>& printed,
                                            const std::filesystem::path& folder);

/// What the analysis found, a line each, for the terminal.
std::vector<std::string> field_in_words(const FieldAnalysis& field, const std::vector<HeldValue>& printed);

}  // namespace scree
